#include "craze/mechanics/holding.hpp"

namespace craze::mechanics {

Holding::Holding(const Lattice& lattice)
    : lattice_(lattice), first_(lattice.r.size() + 1, 0), other_(2 * lattice.i.size()), bond_(2 * lattice.i.size())
{
    const std::int32_t m = lattice.bonds();
    for (std::size_t b = 0; b < lattice.i.size(); ++b)
        ++first_[static_cast<std::size_t>(lattice.i[b]) + 1], ++first_[static_cast<std::size_t>(lattice.j[b]) + 1];
    for (std::size_t e = 1; e < first_.size(); ++e) first_[e] += first_[e - 1];
    // Bonds are sorted by (i, j): an element's lower neighbours come in ascending order, then its higher ones.
    std::vector<std::int32_t> fill(first_.begin(), first_.end() - 1);
    const auto put = [&](std::int32_t at, std::int32_t other, std::int32_t b) {
        const auto slot = static_cast<std::size_t>(fill[static_cast<std::size_t>(at)]++);
        other_[slot] = other, bond_[slot] = b;
    };
    for (std::int32_t b = 0; b < m; ++b)
        put(lattice.j[static_cast<std::size_t>(b)], lattice.i[static_cast<std::size_t>(b)], b);
    for (std::int32_t b = 0; b < m; ++b)
        put(lattice.i[static_cast<std::size_t>(b)], lattice.j[static_cast<std::size_t>(b)], b);
}

bool Holding::has_lost_a_beam(std::int32_t e, std::span<const domain::BondKind> kind) const
{
    for (std::int32_t s = first_[static_cast<std::size_t>(e)]; s < first_[static_cast<std::size_t>(e) + 1]; ++s) {
        const auto b = static_cast<std::size_t>(bond_[static_cast<std::size_t>(s)]);
        if (kind[b] != lattice_.kind[b]) return true;
    }
    return false;
}

bool Holding::holds(std::int32_t i, std::int32_t j, std::span<const domain::BondKind> kind) const
{
    const auto intact = [&](std::int32_t slot) {
        return kind[static_cast<std::size_t>(bond_[static_cast<std::size_t>(slot)])] == domain::BondKind::beam;
    };
    std::int32_t a = first_[static_cast<std::size_t>(i)], b = first_[static_cast<std::size_t>(j)];
    const std::int32_t a_end = first_[static_cast<std::size_t>(i) + 1], b_end = first_[static_cast<std::size_t>(j) + 1];
    while (a < a_end && b < b_end) {
        const std::int32_t p = other_[static_cast<std::size_t>(a)], q = other_[static_cast<std::size_t>(b)];
        if (p == q && intact(a) && intact(b)) return true;
        if (p <= q) ++a;
        if (q <= p) ++b;
    }
    return false;
}

}  // namespace craze::mechanics
