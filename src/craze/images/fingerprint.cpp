#include "craze/images/fingerprint.hpp"

#include "craze/core/hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace craze::images {

namespace fs = std::filesystem;

namespace {

// Every key and value as text; memory does not change the result.
class Listing final : public Schema {
public:
    Hash hash;

    void quantity(std::string_view key, double& v, Dimension, Range, std::string_view) override
    {
        add(key, fmt::format("{}", v));
    }
    void quantity(std::string_view key, std::optional<double>& v, Dimension, Range, std::string_view) override
    {
        add(key, v ? fmt::format("{}", *v) : "auto");
    }
    void quantities(std::string_view key, std::vector<double>& v, Dimension, Range, std::string_view) override
    {
        add(key, fmt::format("{}", fmt::join(v, ",")));
    }
    void integer(std::string_view key, std::int64_t& v, Range, std::string_view) override
    {
        add(key, fmt::format("{}", v));
    }
    void integers(std::string_view key, std::vector<std::int64_t>& v, Range, std::string_view) override
    {
        add(key, fmt::format("{}", fmt::join(v, ",")));
    }
    void flag(std::string_view key, bool& v, std::string_view) override { add(key, v ? "true" : "false"); }
    void text(std::string_view key, std::string& v, std::string_view) override { add(key, v); }
    void texts(std::string_view key, std::vector<std::string>& v, std::string_view) override
    {
        add(key, fmt::format("{}", fmt::join(v, ",")));
    }
    void path(std::string_view key, std::string& v, std::string_view) override { add(key, v); }
    void choice(std::string_view key, int& v, const std::vector<std::string>&, std::string_view) override
    {
        add(key, fmt::format("{}", v));
    }
    void group(std::string_view key, std::string_view, const std::function<void()>& inside) override
    {
        hash.add(key);
        inside();
    }
    void list(std::string_view key, std::size_t size, std::string_view, const std::function<void(std::size_t)>&,
              const std::function<void(std::size_t)>& item) override
    {
        hash.add(key);
        for (std::size_t i = 0; i < size; ++i) item(i);
    }

private:
    void add(std::string_view key, std::string_view value)
    {
        if (key != "memory" && key != "keep_steps") hash.add(key).add(value);
    }
};

void add_stamp(Hash& hash, const fs::path& file)
{
    std::error_code error;
    const auto size = fs::file_size(file, error);
    const auto time = fs::last_write_time(file, error).time_since_epoch().count();
    hash.add(file.filename().string()).add(fmt::format("{} {}", size, time));
}

}  // namespace

std::string fingerprint(const Settings& settings)
{
    Listing listing;
    Settings copy = settings;
    describe(listing, copy);
    if (fs::is_directory(settings.source)) {
        std::vector<fs::path> files;
        for (const auto& entry : fs::directory_iterator(settings.source))
            if (entry.is_regular_file()) files.push_back(entry.path());
        std::sort(files.begin(), files.end());
        for (const auto& file : files) add_stamp(listing.hash, file);
    } else {
        for (const fs::path& file : {fs::path(settings.source), fs::path(settings.source).replace_extension(".raw")})
            if (fs::exists(file)) add_stamp(listing.hash, file);
    }
    if (!settings.alignment.transforms.empty()) listing.hash.add_file(settings.alignment.transforms);
    return listing.hash.digest();
}

}  // namespace craze::images
