// Fourier transforms of slices, through FFTW with plans that depend on the size alone.

#pragma once

#include <complex>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace craze::images {

/// Largest number up to n with no prime factor above 7: the sizes that transforms are fast for.
std::int64_t fast_size(std::int64_t n);

/// Real transforms in two dimensions. forward and backward may be called from several threads at once.
class Fourier2D {
public:
    Fourier2D(std::int64_t nx, std::int64_t ny);
    ~Fourier2D();
    Fourier2D(const Fourier2D&) = delete;
    Fourier2D& operator=(const Fourier2D&) = delete;

    std::int64_t spectrum_size() const { return (nx_ / 2 + 1) * ny_; }
    /// ny rows of nx values to ny rows of nx/2 + 1 coefficients; both are overwritten.
    void forward(std::span<float> values, std::span<std::complex<float>> spectrum) const;
    /// Not normalised: backward(forward(v)) = nx ny v.
    void backward(std::span<std::complex<float>> spectrum, std::span<float> values) const;

private:
    struct Plans;
    std::int64_t nx_, ny_;
    std::unique_ptr<Plans> plans_;
};

/// Cosine transforms of `count` columns at once: those of a line mirrored at its ends.
class Cosine {
public:
    explicit Cosine(std::int64_t n);
    ~Cosine();
    Cosine(const Cosine&) = delete;
    Cosine& operator=(const Cosine&) = delete;

    /// In place; backward(forward(v)) = 2 n v.
    void forward(std::span<float> line) const;
    void backward(std::span<float> line) const;

private:
    struct Plans;
    std::unique_ptr<Plans> plans_;
};

}  // namespace craze::images
