#include "craze/images/work_volume.hpp"

#include "craze/core/json.hpp"
#include "craze/io/atomic_file.hpp"

namespace craze::images {

Journal::Journal(std::filesystem::path file, std::string key) : file_(std::move(file)), key_(std::move(key))
{
    if (!std::filesystem::exists(file_)) return;
    const Json said = Json::parse(io::read_text(file_), nullptr, false);
    if (!said.is_object() || said.value("key", "") != key_ || !said.contains("entries")) return;
    for (const auto& [name, value] : said["entries"].items())
        if (value.is_number()) entries_[name] = value.get<double>();
}

double Journal::get(const std::string& entry) const
{
    const auto found = entries_.find(entry);
    return found == entries_.end() ? 0.0 : found->second;
}

void Journal::set(const std::string& entry, double value)
{
    entries_[entry] = value;
    Json said{{"key", key_}, {"entries", Json::object()}};
    for (const auto& [name, number] : entries_) said["entries"][name] = number;
    io::write_text(file_, said.dump(1));
}

}  // namespace craze::images
