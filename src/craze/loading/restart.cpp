#include "craze/loading/restart.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/hash.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/loading/response_json.hpp"

#include <fmt/core.h>

#include <bit>
#include <cstring>
#include <fstream>

namespace craze::loading {

template <class V>
void fields(V& v, DriveProgress& p)
{
    v("waypoint", p.waypoint), v("s", p.s), v("share", p.share), v("peak", p.peak), v("calm_energy", p.calm_energy);
    v("steps_before", p.steps_before), v("energy_before", p.energy_before);
}

namespace {

constexpr char magic[] = "craze restart 2\n";
static_assert(std::endian::native == std::endian::little, "restart files are written as they lie in memory");

/// Numbers come first as JSON, which keeps every bit of a finite double; arrays follow as they lie in memory.
struct ArrayWriter {
    std::string& bytes;
    template <class T>
    void operator()(std::vector<T>& values)
    {
        const auto size = static_cast<std::uint64_t>(values.size());
        bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    }
};
struct ArrayReader {
    const std::string& bytes;
    std::size_t at;
    void take(void* to, std::size_t size)
    {
        if (size > bytes.size() - at) throw InvalidInput("cut short");
        std::memcpy(to, bytes.data() + at, size);
        at += size;
    }
    template <class T>
    void operator()(std::vector<T>& values)
    {
        std::uint64_t size = 0;
        take(&size, sizeof size);
        if (size > (bytes.size() - at) / sizeof(T)) throw InvalidInput("cut short");
        values.resize(static_cast<std::size_t>(size));
        if (size > 0) take(values.data(), values.size() * sizeof(T));
    }
};
template <class V>
void arrays(V& v, mechanics::MotionState& m, std::vector<std::int32_t>& bonds, std::vector<std::int64_t>& steps)
{
    static_assert(std::is_trivially_copyable_v<mechanics::PressedPair> && sizeof(mechanics::PressedPair) == 16);
    v(m.pose), v(m.velocity), v(m.kind), v(m.pressed), v(bonds), v(steps);
}

}  // namespace

std::string restart_key(const Rig& rig, const Loading& loading)
{
    const auto& l = rig.lattice();
    const auto all = [](const auto& v) { return std::span(v.data(), v.size()); };
    const std::vector<double> numbers{l.box.x,  l.box.y, l.box.z, l.material.E_B, l.material.nu_B, l.material.r_tilde,
                                      l.density};
    Hash hash;
    hash.add(as_json(loading).dump()).add(all(numbers)).add(all(l.x)).add(all(l.y)).add(all(l.z)).add(all(l.r));
    hash.add(all(l.i)).add(all(l.j)).add(all(l.thickness)).add(all(l.kind)).add(all(l.free.gap));
    return hash.digest();
}

void write_restart(const std::filesystem::path& file, const Rig& rig, const Loading& loading, const Restart& restart)
{
    Restart copy = restart;
    std::vector<std::int32_t> bonds;
    std::vector<std::int64_t> steps;
    for (const auto& b : copy.motion.broken) bonds.push_back(b.bond), steps.push_back(b.step);
    auto& m = copy.motion;
    const Json head{{"key", restart_key(rig, loading)},
                    {"progress", as_json(copy.progress)},
                    {"curve", as_json(copy.curve)},
                    {"step", m.step},
                    {"time", m.time},
                    {"damping_energy", m.damping_energy},
                    {"fracture_energy", m.fracture_energy},
                    {"work", m.work}};
    std::string bytes = magic + head.dump() + '\n';
    ArrayWriter writer{bytes};
    arrays(writer, m, bonds, steps);
    std::filesystem::create_directories(file.parent_path());
    io::write_text(file, bytes);
}

Restart read_restart(const std::filesystem::path& file, const Rig& rig, const Loading& loading)
{
    const std::string bytes = io::read_text(file);
    try {
        const std::size_t start = sizeof magic - 1, end = bytes.find('\n', start);
        if (bytes.compare(0, start, magic) != 0 || end == std::string::npos) throw InvalidInput("not a restart file");
        const Json head = Json::parse(bytes.substr(start, end - start));
        if (head.at("key").get<std::string>() != restart_key(rig, loading))
            throw InvalidInput("it belongs to another specimen or loading");
        Restart r;
        read_json(head.at("progress"), r.progress);
        read_json(head.at("curve"), r.curve);
        r.motion.step = head.at("step").get<std::int64_t>();
        for (const auto& [key, value] : {std::pair{"time", &r.motion.time},
                                         {"damping_energy", &r.motion.damping_energy},
                                         {"fracture_energy", &r.motion.fracture_energy},
                                         {"work", &r.motion.work}})
            *value = head.at(key).get<double>();
        std::vector<std::int32_t> bonds;
        std::vector<std::int64_t> steps;
        ArrayReader reader{bytes, end + 1};
        arrays(reader, r.motion, bonds, steps);
        if (bonds.size() != steps.size()) throw InvalidInput("its broken bonds do not fit");
        for (std::size_t k = 0; k < bonds.size(); ++k) r.motion.broken.push_back({bonds[k], steps[k]});
        return r;
    } catch (const InvalidInput& error) {
        throw InvalidInput(fmt::format("{}: {}; delete it to start the loading \"{}\" anew", file.string(),
                                       error.what(), loading.name));
    } catch (const Json::exception& error) {
        throw InvalidInput(fmt::format("{}: damaged ({}); delete it to start the loading \"{}\" anew", file.string(),
                                       error.what(), loading.name));
    }
}

}  // namespace craze::loading
