#include "craze/core/errors.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/pipeline/settings_file.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <cmath>
#include <set>

namespace craze::pipeline {

namespace {

constexpr std::string_view override_source = "--set";

std::string range_text(Range range, Dimension dimension)
{
    const bool low = std::isfinite(range.least), high = std::isfinite(range.most);
    const auto shown = [&](double v) { return format_quantity(v, dimension); };
    if (low && high) return fmt::format("from {} to {}", shown(range.least), shown(range.most));
    if (low) return fmt::format("at least {}", shown(range.least));
    if (high) return fmt::format("at most {}", shown(range.most));
    return "any finite number";
}

const char* kind_of(const toml::node& node)
{
    if (node.is_string()) return "a text";
    if (node.is_integer()) return "an integer";
    if (node.is_floating_point()) return "a number";
    if (node.is_boolean()) return "true or false";
    if (node.is_array()) return "a list";
    if (node.is_table()) return "a section";
    return "a date";
}

std::string shown(const toml::node& node)
{
    std::ostringstream text;
    if (const auto* s = node.as_string())
        text << '"' << s->get() << '"';
    else if (const auto* i = node.as_integer())
        text << i->get();
    else if (const auto* f = node.as_floating_point())
        text << f->get();
    else if (const auto* b = node.as_boolean())
        text << (b->get() ? "true" : "false");
    else
        return kind_of(node);
    return text.str();
}

class Reader : public Schema {
public:
    Reader(const toml::table& root, std::filesystem::path base) : base_(std::move(base))
    {
        open_.push_back({&root, "", {}});
    }

    void quantity(std::string_view key, double& value, Dimension dimension, Range range, std::string_view) override
    {
        if (const toml::node* node = find(key)) guarded(*node, key, [&] { value = one(*node, dimension, range); });
    }

    void quantity(std::string_view key, std::optional<double>& value, Dimension dimension, Range range,
                  std::string_view) override
    {
        const toml::node* node = find(key);
        if (node == nullptr) return;
        if (const auto* text = node->as_string(); text && text->get() == "auto") {
            value.reset();
            return;
        }
        guarded(*node, key, [&] { value = one(*node, dimension, range); });
    }

    void quantities(std::string_view key, std::vector<double>& values, Dimension dimension, Range range,
                    std::string_view) override
    {
        each(key, values, [&](const toml::node& node) { return one(node, dimension, range); });
    }

    void integer(std::string_view key, std::int64_t& value, Range range, std::string_view) override
    {
        if (const toml::node* node = find(key)) guarded(*node, key, [&] { value = whole(*node, range); });
    }

    void integers(std::string_view key, std::vector<std::int64_t>& values, Range range, std::string_view) override
    {
        each(key, values, [&](const toml::node& node) { return whole(node, range); });
    }

    void flag(std::string_view key, bool& value, std::string_view) override
    {
        const toml::node* node = find(key);
        if (node == nullptr) return;
        guarded(*node, key, [&] {
            if (!node->is_boolean()) throw InvalidInput(fmt::format("needs true or false, got {}", shown(*node)));
            value = node->as_boolean()->get();
        });
    }

    void text(std::string_view key, std::string& value, std::string_view) override
    {
        if (const toml::node* node = find(key)) guarded(*node, key, [&] { value = words(*node); });
    }

    void texts(std::string_view key, std::vector<std::string>& values, std::string_view) override
    {
        each(key, values, [](const toml::node& node) { return words(node); });
    }

    void path(std::string_view key, std::string& value, std::string_view) override
    {
        const toml::node* node = find(key);
        if (node == nullptr) return;
        guarded(*node, key, [&] {
            const std::string given = words(*node);
            const bool from_override = node->source().path && *node->source().path == override_source;
            value = given.empty() || from_override ? given : (base_ / given).lexically_normal().string();
        });
    }

    void choice(std::string_view key, int& value, const std::vector<std::string>& names, std::string_view) override
    {
        const toml::node* node = find(key);
        if (node == nullptr) return;
        guarded(*node, key, [&] {
            const std::string given = words(*node);
            for (std::size_t n = 0; n < names.size(); ++n)
                if (given == names[n]) {
                    value = static_cast<int>(n);
                    return;
                }
            const std::string near = nearest_name(given, names.data(), names.data() + names.size());
            throw InvalidInput(fmt::format("needs one of {}; got \"{}\"{}", fmt::join(names, ", "), given,
                                           near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
        });
    }

    void group(std::string_view key, std::string_view, const std::function<void()>& describe) override
    {
        static const toml::table nothing;
        const toml::node* node = find(key);
        if (node != nullptr && !node->is_table())
            wrong(*node, full(key), fmt::format("needs a section, got {}", kind_of(*node)));
        const toml::table* table = node != nullptr ? node->as_table() : nullptr;
        open_.push_back({table != nullptr ? table : &nothing, full(key), {}});
        describe();
        close();
    }

    void list(std::string_view key, std::size_t, std::string_view, const std::function<void(std::size_t)>& resize,
              const std::function<void(std::size_t)>& item) override
    {
        const toml::node* node = find(key);
        if (node == nullptr) return;
        const toml::array* array = node->as_array();
        if (array == nullptr) {
            wrong(*node, full(key),
                  fmt::format("needs a list of sections ([[{}]]), got {}", full(key), kind_of(*node)));
            return;
        }
        for (const toml::node& entry : *array)
            if (!entry.is_table()) {
                wrong(entry, full(key),
                      fmt::format("needs a list of sections ([[{}]]), got {}", full(key), kind_of(entry)));
                return;
            }
        resize(0);  // entries start from defaults, not from the default list's values
        resize(array->size());
        for (std::size_t i = 0; i < array->size(); ++i) {
            open_.push_back({array->get(i)->as_table(), fmt::format("{}[{}]", full(key), i + 1), {}});
            item(i);
            close();
        }
    }

    /// Unknown keys of the section that is open last.
    void close()
    {
        const Section section = std::move(open_.back());
        open_.pop_back();
        for (const auto& [key, node] : *section.table) {
            const std::string name(key.str());
            if (section.known.contains(name)) continue;
            const std::vector<std::string> names(section.known.begin(), section.known.end());
            const std::string near = nearest_name(name, names.data(), names.data() + names.size());
            const std::string path = section.path.empty() ? name : section.path + "." + name;
            wrong(node, path,
                  near.empty() ? fmt::format("unknown key; known here: {}", fmt::join(names, ", "))
                               : fmt::format("unknown key; did you mean \"{}\"?", near));
        }
    }

    std::vector<std::string> errors;

private:
    struct Section {
        const toml::table* table;
        std::string path;
        std::set<std::string> known;
    };

    const toml::node* find(std::string_view key)
    {
        open_.back().known.emplace(key);
        return open_.back().table->get(key);
    }

    std::string full(std::string_view key) const
    {
        return open_.back().path.empty() ? std::string(key) : fmt::format("{}.{}", open_.back().path, key);
    }

    void wrong(const toml::node& node, const std::string& key, const std::string& what)
    {
        const auto& source = node.source();
        const std::string file = source.path ? *source.path : std::string("settings");
        errors.push_back(file == override_source ? fmt::format("--set {}: {}", key, what)
                                                 : fmt::format("{}:{}: {}: {}", file, source.begin.line, key, what));
    }

    template <class Read>
    void guarded(const toml::node& node, std::string_view key, Read&& read)
    {
        try {
            read();
        } catch (const InvalidInput& error) {
            wrong(node, full(key), error.what());
        }
    }

    template <class Value, class Read>
    void each(std::string_view key, std::vector<Value>& values, Read&& read)
    {
        const toml::node* node = find(key);
        if (node == nullptr) return;
        guarded(*node, key, [&] {
            const toml::array* array = node->as_array();
            if (array == nullptr) {  // one value is a list of one
                values = {read(*node)};
                return;
            }
            std::vector<Value> got;
            for (const toml::node& entry : *array) got.push_back(read(entry));
            values = std::move(got);
        });
    }

    static double one(const toml::node& node, Dimension dimension, Range range)
    {
        double value = 0.0;
        const bool plain = dimension == Dimension::pure || dimension == Dimension::fraction;
        if (const auto* text = node.as_string())
            value = parse_quantity(text->get(), dimension);
        else if (plain && node.is_number())
            value = *node.value<double>();
        else if (plain)
            throw InvalidInput(fmt::format("needs a number, got {}", shown(node)));
        else
            throw InvalidInput(fmt::format("needs a number with its unit as text, such as \"{}\" (units: {}); got {}",
                                           example(dimension), units_of(dimension), shown(node)));
        if (!(value >= range.least && value <= range.most && std::isfinite(value)))
            throw InvalidInput(fmt::format("needs a value {}, got {}", range_text(range, dimension), shown(node)));
        return value;
    }

    static const char* example(Dimension dimension)
    {
        switch (dimension) {
            case Dimension::pixel: return "8.5 px";
            case Dimension::length: return "23.6 nm";
            case Dimension::pressure: return "223 GPa";
            case Dimension::density: return "6060 kg/m3";
            case Dimension::time: return "10 ns";
            case Dimension::angle: return "30 deg";
            case Dimension::velocity: return "1 m/s";
            case Dimension::size: return "2 GB";
            default: return "0.5";
        }
    }

    static std::int64_t whole(const toml::node& node, Range range)
    {
        const auto* number = node.as_integer();
        if (number == nullptr) throw InvalidInput(fmt::format("needs a whole number, got {}", shown(node)));
        const auto value = static_cast<double>(number->get());
        if (!(value >= range.least && value <= range.most))
            throw InvalidInput(
                fmt::format("needs a whole number {}, got {}", range_text(range, Dimension::pure), number->get()));
        return number->get();
    }

    static std::string words(const toml::node& node)
    {
        const auto* text = node.as_string();
        if (text == nullptr) throw InvalidInput(fmt::format("needs a text in quotes, got {}", shown(node)));
        return text->get();
    }

    std::filesystem::path base_;
    std::vector<Section> open_;
};

/// "a.b.c=value" laid into the tree.
void lay_over(toml::table& root, const std::string& assignment)
{
    const auto equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0)
        throw InvalidInput(fmt::format("--set {}: needs KEY=VALUE, such as images.denoise.search=15", assignment));
    const std::string path = assignment.substr(0, equals), value = assignment.substr(equals + 1);
    toml::table parsed;
    try {
        parsed = toml::parse("value = " + value, override_source);
    } catch (const toml::parse_error&) {
        // Bare words are texts: --set images.voxel_size=20nm needs no quotes.
        std::string quoted;
        for (const char c : value) quoted += c == '\\' || c == '"' ? std::string{'\\', c} : std::string{c};
        try {
            parsed = toml::parse(fmt::format("value = \"{}\"", quoted), override_source);
        } catch (const toml::parse_error&) {
            throw InvalidInput(fmt::format("--set {}: the value cannot be read", assignment));
        }
    }
    toml::table* table = &root;
    std::size_t from = 0;
    for (std::size_t dot = path.find('.'); dot != std::string::npos; from = dot + 1, dot = path.find('.', from)) {
        const std::string name = path.substr(from, dot - from);
        toml::node* next = table->get(name);
        if (next == nullptr)
            next = &table->insert(name, toml::parse(std::string_view{}, override_source)).first->second;
        table = next->as_table();
        if (table == nullptr)
            throw InvalidInput(fmt::format("--set {}: {} is not a section", assignment, path.substr(0, dot)));
    }
    table->insert_or_assign(path.substr(from), std::move(*parsed.get("value")));
}

}  // namespace

void read_settings_text(std::string_view toml, std::string_view name, const std::vector<std::string>& overrides,
                        const Describe& describe)
{
    toml::table root;
    try {
        root = toml::parse(toml, name);
    } catch (const toml::parse_error& error) {
        throw InvalidInput(
            fmt::format("{}:{}: not valid TOML: {}", name, error.source().begin.line, error.description()));
    }
    for (const std::string& assignment : overrides) lay_over(root, assignment);
    Reader reader(root, std::filesystem::path(name).parent_path());
    describe(reader);
    reader.close();
    if (!reader.errors.empty()) throw InvalidInput(fmt::format("{}", fmt::join(reader.errors, "\n")));
}

void read_settings(const SettingsSource& source, const Describe& describe)
{
    if (!source.file.empty() && !std::filesystem::exists(source.file))
        throw InvalidInput(fmt::format("{}: no such settings file; 'craze init' writes one", source.file.string()));
    read_settings_text(source.file.empty() ? "" : io::read_text(source.file), source.file.string(), source.overrides,
                       describe);
}

}  // namespace craze::pipeline
