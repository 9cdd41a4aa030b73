#include "craze/core/errors.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/loading/loading.hpp"
#include "craze/loading/response_files.hpp"
#include "craze/loading/response_json.hpp"

#include <fmt/format.h>

#include <cctype>

namespace craze::loading {
namespace {

/// One row of a CSV: vectors become three columns.
struct CsvRow {
    bool header = false;
    std::string prefix, text;

    template <class T>
    void operator()(const char* key, T& value)
    {
        if constexpr (std::is_same_v<T, Vec3>) {
            const std::string outer = prefix;
            prefix += std::string(key) + "_";
            fields(*this, value);
            prefix = outer;
        } else {
            if (!text.empty()) text += ',';
            text += header ? prefix + key : fmt::format("{}", value);
        }
    }
};

template <class T>
std::string csv(const std::vector<T>& rows)
{
    std::string text;
    T blank;
    CsvRow head{.header = true, .prefix = {}, .text = {}};
    fields(head, blank);
    text = head.text + "\n";
    for (T row : rows) {
        CsvRow line;
        fields(line, row);
        text += line.text + "\n";
    }
    return text;
}

}  // namespace

std::string file_name(const std::string& loading)
{
    std::string name;
    for (const char c : loading)
        name += std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '+' ? c : '_';
    return name;
}

void write_curve(const Curve& curve, const std::filesystem::path& file)
{
    std::filesystem::create_directories(file.parent_path());
    io::write_text(file, as_json(curve).dump() + "\n");
}

Curve read_curve(const std::filesystem::path& file)
{
    Curve curve;
    try {
        read_json(Json::parse(io::read_text(file)), curve);
    } catch (const Json::exception& error) {
        throw InvalidInput(fmt::format("{}: not a finished loading ({}); delete it", file.string(), error.what()));
    }
    return curve;
}

void save(const Response& response, const std::filesystem::path& folder)
{
    std::filesystem::create_directories(folder / "curves");
    for (const auto& curve : response.curves) {
        io::write_text(folder / "curves" / (file_name(curve.loading.name) + ".csv"), csv(curve.points));
        if (!curve.broken.empty())
            io::write_text(folder / "curves" / (file_name(curve.loading.name) + "_broken_bonds.csv"),
                           csv(curve.broken));
    }
    io::write_text(folder / "response.json", as_json(response).dump(1) + "\n");
}

Response load_response(const std::filesystem::path& folder)
{
    const auto file = folder / "response.json";
    Response response;
    try {
        read_json(Json::parse(io::read_text(file)), response);
    } catch (const Json::exception& error) {
        throw InvalidInput(
            fmt::format("{}: not the results of loadings: {}; run `craze loading` again", file.string(), error.what()));
    }
    return response;
}

}  // namespace craze::loading
