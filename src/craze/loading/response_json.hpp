// Values of this room as JSON and back: every field named once. For sources only.

#pragma once

#include "craze/core/json.hpp"
#include "craze/loading/response.hpp"

#include <cmath>
#include <type_traits>

namespace craze::loading {

template <class V>
void fields(V& v, Vec3& a)
{
    v("x", a.x), v("y", a.y), v("z", a.z);
}
template <class V>
void fields(V& v, Drive& d)
{
    v("free", d.free), v("factor", d.factor);
}
template <class V>
void fields(V& v, domain::Defects& d)
{
    v("pores", d.pores), v("cracks", d.cracks), v("thickness", d.thickness), v("constant", d.constant);
}
template <class V>
void fields(V& v, Loading& t)
{
    v("kind", t.kind), v("name", t.name), v("specimen", t.specimen), v("drive", t.drive), v("axis", t.axis);
    v("path", t.path), v("solver", t.solver), v("strength", t.strength), v("crossings", t.crossings);
    v("bending_share", t.bending_share);
    v("local_damping", t.local_damping), v("damping", t.damping), v("stop_drop", t.stop_drop),
        v("stop_damage", t.stop_damage);
}
template <class V>
void fields(V& v, Point& p)
{
    v("program", p.program), v("strain", p.strain), v("face_strain", p.face_strain);
    v("interior_strain", p.interior_strain), v("stress", p.stress), v("eta", p.eta), v("pressure", p.pressure);
    v("bulk_modulus", p.bulk), v("closure", p.closure), v("cracked", p.cracked), v("broken", p.broken);
    v("work", p.work), v("elastic", p.elastic), v("kinetic", p.kinetic), v("damped", p.damped);
    v("fracture", p.fracture), v("imbalance", p.imbalance), v("residual", p.residual), v("time", p.time);
    v("iterations", p.iterations);
}
template <class V>
void fields(V& v, BrokenBond& b)
{
    v("i", b.i), v("j", b.j), v("where", b.where), v("strain", b.strain), v("stress", b.stress), v("point", b.point);
}
template <class V>
void fields(V& v, Curve& c)
{
    v("loading", c.loading), v("points", c.points), v("broken", c.broken), v("stopped", c.stopped),
        v("seconds", c.seconds);
}
template <class V>
void fields(V& v, Modulus& m)
{
    v("specimen", m.specimen), v("axis", m.axis), v("tension", m.tension), v("compression", m.compression);
    v("face", m.face), v("interior", m.interior), v("nu", m.nu);
}
template <class V>
void fields(V& v, Strength& s)
{
    v("loading", s.loading), v("specimen", s.specimen), v("axis", s.axis), v("tension", s.tension);
    v("sigma_failure", s.sigma_failure), v("strength", s.strength), v("strain", s.strain);
    v("new_cracks", s.new_cracks), v("change", s.change);
}
template <class V>
void fields(V& v, mechanics::DenseMaterial& d)
{
    v("E_D", d.E_D), v("nu_D", d.nu_D), v("rho_D", d.rho_D);
}
template <class V>
void fields(V& v, mechanics::BeamMaterial& b)
{
    v("E_B", b.E_B), v("nu_B", b.nu_B), v("r_tilde", b.r_tilde);
}
template <class V>
void fields(V& v, Calibration::Trial& t)
{
    v("r_tilde", t.r_tilde), v("E", t.E), v("nu", t.nu);
}
template <class V>
void fields(V& v, Calibration& c)
{
    v("target", c.target), v("beam", c.beam), v("done", c.done), v("from_library", c.from_library);
    v("recipe", c.recipe), v("path", c.path), v("E", c.E), v("nu", c.nu), v("anisotropy", c.anisotropy),
        v("error", c.error);
}
template <class V>
void fields(V& v, Response& r)
{
    v("calibration", r.calibration), v("moduli", r.moduli), v("strengths", r.strengths), v("curves", r.curves);
    v("porosity", r.porosity), v("seconds", r.seconds);
}

template <class T>
Json as_json(const T& value);
template <class T>
void read_json(const Json& json, T& value);

struct JsonWriter {
    Json object = Json::object();
    template <class T>
    void operator()(const char* key, const T& value)
    {
        object[key] = as_json(value);
    }
};
struct JsonReader {
    const Json& object;
    template <class T>
    void operator()(const char* key, T& value)
    {
        read_json(object.at(key), value);
    }
};

template <class T>
struct is_list : std::false_type {
};
template <class T>
struct is_list<std::vector<T>> : std::true_type {
};
template <class T, std::size_t n>
struct is_list<std::array<T, n>> : std::true_type {
};

/// Numbers that are not finite (a bond that never breaks) become null.
template <class T>
Json as_json(const T& value)
{
    if constexpr (std::is_enum_v<T>)
        return static_cast<int>(value);
    else if constexpr (std::is_floating_point_v<T>)
        return std::isfinite(value) ? Json(value) : Json(nullptr);
    else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>)
        return value;
    else if constexpr (is_list<T>::value) {
        Json list = Json::array();
        for (const auto& item : value) list.push_back(as_json(item));
        return list;
    } else {
        JsonWriter writer;
        fields(writer, const_cast<T&>(value));
        return std::move(writer.object);
    }
}

template <class T>
void read_json(const Json& json, T& value)
{
    if constexpr (std::is_enum_v<T>)
        value = static_cast<T>(json.get<int>());
    else if constexpr (std::is_floating_point_v<T>)
        value = json.is_null() ? std::numeric_limits<T>::infinity() : json.get<T>();
    else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>)
        value = json.get<T>();
    else if constexpr (is_list<T>::value) {
        if constexpr (requires { value.resize(0); }) value.resize(json.size());
        for (std::size_t k = 0; k < value.size(); ++k) read_json(json.at(k), value[k]);
    } else {
        JsonReader reader{json};
        fields(reader, value);
    }
}

}  // namespace craze::loading
