// Curtains of the ion beam removed, slice by slice [2.3 (2)].

#pragma once

#include "craze/images/fourier.hpp"
#include "craze/images/settings.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace craze::images {

/// Takes stripes out of slices of one size. remove() may be called from several threads at once.
///
/// notch: the slice's cosine transform (its Fourier transform, mirrored at the borders against ringing) is cut
/// around the axis across the stripes: coefficient (k along, m across) loses the share
///     exp(-(k length)^2 / 2) (1 - exp(-ln 2 (m protect / (2 extent))^2)),
/// so that the mean and what varies slowly across the stripes stay. Only the few rows of the transform with small k
/// are computed. Levels far from what the transform says of their surroundings, and their neighbours, are replaced by
/// that, so that pores, cracks and their rims neither draw stripes nor fade. Of what is left, coefficients lose
/// Wiener's share only, max(0, 1 - n^2 / P), n the spread of the solid's levels and P the mean of c^2 over 33
/// neighbouring m: noise is no stripe.
///
/// wavelet: the slice is taken apart into `levels` levels of Daubechies wavelets; in each band that varies across
/// the stripes and not along them, coefficients with k <= damping along the stripes are damped (Muench et al. 2009).
class StripeFilter {
public:
    StripeFilter(std::int64_t nx, std::int64_t ny, const Stripes& settings);
    ~StripeFilter();

    /// In place; `slice` holds gray levels, ny rows of nx.
    void remove(std::span<float> slice) const;

private:
    void notch(std::span<float> slice) const;  // stripes run along the rows
    void wavelet(std::span<float> slice) const;

    Stripes settings_;
    std::int64_t nx_, ny_;  // along, across the stripes
    bool turned_;
    std::vector<float> waves_;     // of the cosine transform along the stripes, one row per k
    std::vector<float> share_;     // removed of each k
    std::vector<float> keep_low_;  // removed of each m
    std::unique_ptr<Cosine> across_;
};

}  // namespace craze::images
