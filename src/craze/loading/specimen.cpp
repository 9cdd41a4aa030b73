#include "craze/loading/specimen.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/units.hpp"

#include <fmt/core.h>

#include <array>

namespace craze::loading {

using Thickness = domain::Defects::Thickness;

domain::Defects parse_specimen(std::string_view name)
{
    const auto wrong = [&](std::string_view why) {
        return InvalidInput(
            fmt::format("specimen \"{}\": {}; write dense, pores, cracks or both, and after the last two, "
                        "if you wish, T2, T1, closed or a thickness such as 40 nm",
                        name, why));
    };
    const auto space = name.find(' ');
    const std::string kind(name.substr(0, space));
    std::string rule(space == std::string_view::npos ? std::string_view{} : name.substr(space + 1));
    rule.erase(0, rule.find_first_not_of(' '));

    domain::Defects defects;
    const std::array<std::string, 4> kinds{"dense", "pores", "cracks", "both"};
    if (kind == "dense")
        defects.pores = defects.cracks = false;
    else if (kind == "pores")
        defects.cracks = false;
    else if (kind == "cracks")
        defects.pores = false;
    else if (kind != "both") {
        const std::string near = nearest_name(kind, kinds.data(), kinds.data() + kinds.size());
        throw wrong(near.empty() ? "no such specimen" : fmt::format("did you mean \"{}\"?", near));
    }
    if (rule.empty()) return defects;
    if (!defects.cracks) throw wrong("it has no cracks to give a thickness to");
    if (rule == "T2")
        defects.thickness = Thickness::T2;
    else if (rule == "T1")
        defects.thickness = Thickness::T1;
    else if (rule == "closed")
        defects.thickness = Thickness::closed;
    else {
        defects.thickness = Thickness::constant;
        try {
            defects.constant = parse_quantity(rule, Dimension::length);
        } catch (const InvalidInput& error) {
            throw wrong(error.what());
        }
        if (!(defects.constant >= 0.0)) throw wrong("a thickness is zero or more");
    }
    return defects;
}

std::string specimen_name(const domain::Defects& defects)
{
    if (!defects.cracks) return defects.pores ? "pores" : "dense";
    const std::string kind = defects.pores ? "both" : "cracks";
    switch (defects.thickness) {
        case Thickness::T2: return kind;
        case Thickness::T1: return fmt::format("{} T1", kind);
        case Thickness::closed: return fmt::format("{} closed", kind);
        case Thickness::constant:
            return fmt::format("{} {}", kind, format_quantity(defects.constant, Dimension::length));
    }
    return kind;
}

}  // namespace craze::loading
