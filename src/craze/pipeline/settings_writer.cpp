#include "craze/core/json.hpp"
#include "craze/pipeline/settings_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace craze::pipeline {

namespace {

std::string in_quotes(std::string_view text) { return Json(text).dump(); }

bool plain(Dimension dimension) { return dimension == Dimension::pure; }

std::string toml_value(double value, Dimension dimension)
{
    if (!plain(dimension)) return in_quotes(format_quantity(value, dimension));
    const std::string text = fmt::format("{}", value);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string range_note(Range range, Dimension dimension)
{
    const bool low = std::isfinite(range.least), high = std::isfinite(range.most);
    const auto shown = [&](double v) { return format_quantity(v, dimension); };
    if (low && high) return fmt::format("{} ... {}", shown(range.least), shown(range.most));
    if (low) return fmt::format(">= {}", shown(range.least));
    if (high) return fmt::format("<= {}", shown(range.most));
    return "";
}

// What the two texts for people, the commented file and the manual, have in common: each key with its value as
// TOML, its meaning and what it may be.
class Listing : public Schema {
public:
    void quantity(std::string_view key, double& value, Dimension d, Range range, std::string_view meaning) override
    {
        entry(key, toml_value(value, d), meaning, range_note(range, d));
    }
    void quantity(std::string_view key, std::optional<double>& value, Dimension d, Range range,
                  std::string_view meaning) override
    {
        const std::string note = range_note(range, d);
        entry(key, value ? toml_value(*value, d) : "\"auto\"", meaning,
              note.empty() ? "or \"auto\"" : note + ", or \"auto\"");
    }
    void quantities(std::string_view key, std::vector<double>& values, Dimension d, Range range,
                    std::string_view meaning) override
    {
        std::vector<std::string> texts;
        for (const double v : values) texts.push_back(toml_value(v, d));
        const std::string note = range_note(range, d);
        entry(key, fmt::format("[{}]", fmt::join(texts, ", ")), meaning, note.empty() ? "" : "each " + note);
    }
    void integer(std::string_view key, std::int64_t& value, Range range, std::string_view meaning) override
    {
        entry(key, fmt::format("{}", value), meaning, range_note(range, Dimension::pure));
    }
    void integers(std::string_view key, std::vector<std::int64_t>& values, Range range,
                  std::string_view meaning) override
    {
        const std::string note = range_note(range, Dimension::pure);
        entry(key, fmt::format("[{}]", fmt::join(values, ", ")), meaning, note.empty() ? "" : "each " + note);
    }
    void flag(std::string_view key, bool& value, std::string_view meaning) override
    {
        entry(key, value ? "true" : "false", meaning, "true, false");
    }
    void text(std::string_view key, std::string& value, std::string_view meaning) override
    {
        entry(key, in_quotes(value), meaning, "text");
    }
    void texts(std::string_view key, std::vector<std::string>& values, std::string_view meaning) override
    {
        std::vector<std::string> all;
        for (const auto& v : values) all.push_back(in_quotes(v));
        entry(key, fmt::format("[{}]", fmt::join(all, ", ")), meaning, "texts");
    }
    void path(std::string_view key, std::string& value, std::string_view meaning) override
    {
        entry(key, in_quotes(value), meaning, "path");
    }
    void choice(std::string_view key, int& value, const std::vector<std::string>& names,
                std::string_view meaning) override
    {
        entry(key, in_quotes(names[static_cast<std::size_t>(value)]), meaning,
              fmt::format("{}", fmt::join(names, ", ")));
    }
    void group(std::string_view key, std::string_view meaning, const std::function<void()>& describe) override
    {
        sections_.emplace_back(key);
        apart([&] {
            section(meaning, false);
            describe();
        });
        sections_.pop_back();
    }

    std::string text() { return std::exchange(out, {}) + std::exchange(after_, {}); }

protected:
    virtual void entry(std::string_view key, const std::string& value, std::string_view meaning,
                       const std::string& may_be) = 0;
    virtual void section(std::string_view meaning, bool of_list) = 0;
    std::string section_path() const { return fmt::format("{}", fmt::join(sections_, ".")); }
    // A section's own keys must stand before its subsections, in whatever order a room describes them.
    template <class Write>
    void apart(Write&& write)
    {
        std::string own = std::exchange(out, {}), after = std::exchange(after_, {});
        write();
        after += out + after_;
        out = std::move(own);
        after_ = std::move(after);
    }

    std::string out, after_;
    std::vector<std::string> sections_;
};

class FileText : public Listing {
public:
    void list(std::string_view key, std::size_t size, std::string_view meaning, const std::function<void(std::size_t)>&,
              const std::function<void(std::size_t)>& item) override
    {
        sections_.emplace_back(key);
        for (std::size_t i = 0; i < size; ++i)
            apart([&] {
                section(meaning, true);
                item(i);
            });
        sections_.pop_back();
    }

private:
    void entry(std::string_view key, const std::string& value, std::string_view meaning,
               const std::string& may_be) override
    {
        out +=
            fmt::format("# {}{}\n{} = {}\n", meaning, may_be.empty() ? "" : fmt::format(" ({})", may_be), key, value);
    }
    void section(std::string_view meaning, bool of_list) override
    {
        out += fmt::format("\n# {}\n{}{}{}\n", meaning, of_list ? "[[" : "[", section_path(), of_list ? "]]" : "]");
    }
};

class ManualText : public Listing {
public:
    void list(std::string_view key, std::size_t size, std::string_view meaning,
              const std::function<void(std::size_t)>& resize, const std::function<void(std::size_t)>& item) override
    {
        sections_.emplace_back(key);
        if (size == 0) resize(1);
        apart([&] {
            section(meaning, true);
            item(0);
        });
        if (size == 0) resize(0);
        sections_.pop_back();
    }

private:
    void entry(std::string_view key, const std::string& value, std::string_view meaning,
               const std::string& may_be) override
    {
        out += fmt::format("| `{}` | `{}` | {} | {} |\n", key, value, meaning, may_be);
    }
    void section(std::string_view meaning, bool of_list) override
    {
        const std::string path = section_path();
        out +=
            fmt::format("\n{} `{}`\n\n{}\n\n| key | default | meaning | range or choices |\n|---|---|---|---|\n",
                        sections_.size() == 1 ? "##" : "###", of_list ? "[[" + path + "]]" : "[" + path + "]", meaning);
    }
};

class Values : public Schema {
public:
    explicit Values(bool with_paths) : with_paths_(with_paths) { open_.push_back(&root); }

    void quantity(std::string_view key, double& value, Dimension, Range, std::string_view) override { at(key) = value; }
    void quantity(std::string_view key, std::optional<double>& value, Dimension, Range, std::string_view) override
    {
        at(key) = value ? Json(*value) : Json("auto");
    }
    void quantities(std::string_view key, std::vector<double>& values, Dimension, Range, std::string_view) override
    {
        at(key) = values;
    }
    void integer(std::string_view key, std::int64_t& value, Range, std::string_view) override { at(key) = value; }
    void integers(std::string_view key, std::vector<std::int64_t>& values, Range, std::string_view) override
    {
        at(key) = values;
    }
    void flag(std::string_view key, bool& value, std::string_view) override { at(key) = value; }
    void text(std::string_view key, std::string& value, std::string_view) override { at(key) = value; }
    void texts(std::string_view key, std::vector<std::string>& values, std::string_view) override { at(key) = values; }
    void path(std::string_view key, std::string& value, std::string_view) override
    {
        if (with_paths_) at(key) = value;
    }
    void choice(std::string_view key, int& value, const std::vector<std::string>& names, std::string_view) override
    {
        at(key) = names[static_cast<std::size_t>(value)];
    }
    void group(std::string_view key, std::string_view, const std::function<void()>& describe) override
    {
        Json inside = Json::object();
        open_.push_back(&inside);
        describe();
        open_.pop_back();
        at(key) = std::move(inside);
    }
    void list(std::string_view key, std::size_t size, std::string_view, const std::function<void(std::size_t)>&,
              const std::function<void(std::size_t)>& item) override
    {
        Json all = Json::array();
        for (std::size_t i = 0; i < size; ++i) {
            Json inside = Json::object();
            open_.push_back(&inside);
            item(i);
            open_.pop_back();
            all.push_back(std::move(inside));
        }
        at(key) = std::move(all);
    }

    Json root = Json::object();

private:
    Json& at(std::string_view key) { return (*open_.back())[std::string(key)]; }
    bool with_paths_;
    std::vector<Json*> open_;
};

}  // namespace

std::string write_settings(const Describe& describe)
{
    FileText text;
    describe(text);
    return text.text();
}

std::string settings_manual(const Describe& describe)
{
    ManualText text;
    describe(text);
    return text.text();
}

Json settings_json(const Describe& describe, bool with_paths)
{
    Values values(with_paths);
    describe(values);
    return std::move(values.root);
}

}  // namespace craze::pipeline
