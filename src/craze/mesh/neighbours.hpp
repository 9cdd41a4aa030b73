// The 26 neighbours of a voxel as bits, and what they say about it: (26, 6) digital topology.
// Bit x + 3 y + 9 z stands for the voxel at (x - 1, y - 1, z - 1) from the middle, bit 13.

#pragma once

#include <bit>
#include <cstdint>

namespace craze::mesh {

using Cube = std::uint32_t;

namespace cube {

inline constexpr Cube all = (Cube{1} << 27) - 1;
inline constexpr Cube middle = Cube{1} << 13;
/// The middle's face neighbours.
inline constexpr Cube six = 1U << 4 | 1U << 10 | 1U << 12 | 1U << 14 | 1U << 16 | 1U << 22;
inline constexpr Cube corners = 1U << 0 | 1U << 2 | 1U << 6 | 1U << 8 | 1U << 18 | 1U << 20 | 1U << 24 | 1U << 26;
/// Neighbours that share a face or an edge with the middle.
inline constexpr Cube eighteen = all & ~corners & ~middle;

/// The three positions of one row, repeated over the cube.
inline constexpr Cube row(unsigned three)
{
    Cube bits = 0;
    for (unsigned r = 0; r < 9; ++r) bits |= three << (3 * r);
    return bits;
}
/// The nine positions of one layer, repeated over the cube.
inline constexpr Cube layer(unsigned nine) { return nine | nine << 9U | nine << 18U; }

inline constexpr Cube not_x0 = row(0b110), not_x2 = row(0b011), not_y0 = layer(0b111111000),
                      not_y2 = layer(0b000111111);

constexpr Cube along_x(Cube m) { return (m << 1U & not_x0) | (m >> 1U & not_x2); }
constexpr Cube along_y(Cube m) { return (m << 3U & not_y0) | (m >> 3U & not_y2); }
constexpr Cube along_z(Cube m) { return (m << 9U & all) | m >> 9U; }

/// `seed` and all of `within` that is connected to it by faces.
constexpr Cube flooded_by_faces(Cube seed, Cube within)
{
    while (true) {
        const Cube grown = (seed | along_x(seed) | along_y(seed) | along_z(seed)) & within;
        if (grown == seed) return seed;
        seed = grown;
    }
}

/// `seed` and all of `within` that is connected to it by faces, edges or corners.
constexpr Cube flooded(Cube seed, Cube within)
{
    while (true) {
        Cube grown = seed | along_x(seed);
        grown |= along_y(grown);
        grown = (grown | along_z(grown)) & within;
        if (grown == seed) return seed;
        seed = grown;
    }
}

constexpr Cube lowest(Cube m) { return m & (~m + 1U); }

/// The rest around the middle falls into two or more parts that touch it: the middle is part of a sheet.
constexpr bool parts_the_rest(Cube set)
{
    const Cube rest = ~set & eighteen, touching = rest & six;
    if (touching == 0) return false;
    return (touching & ~flooded_by_faces(lowest(touching), rest)) != 0;
}

/// Taking the middle away changes no topology: one part of the set around it, and one part of the rest that touches it
/// (Bertrand and Malandain, Pattern Recogn. Lett. 15, 1994, 169).
constexpr bool simple(Cube set)
{
    const Cube around = set & all & ~middle;
    if (around == 0 || (~set & six) == 0) return false;
    return !parts_the_rest(set) && flooded(lowest(around), around) == around;
}

}  // namespace cube
}  // namespace craze::mesh
