#include "craze/images/fourier.hpp"

#include <fftw3.h>

#include <cassert>
#include <mutex>

namespace craze::images {

namespace {

// Making and destroying plans is the one thing FFTW does not allow from several threads. FFTW_ESTIMATE keeps the
// choice of algorithm, and so the bits, the same from run to run.
std::mutex planning;
constexpr unsigned how = FFTW_ESTIMATE | FFTW_UNALIGNED | FFTW_DESTROY_INPUT;

fftwf_complex* complex_of(std::span<std::complex<float>> values)
{
    return reinterpret_cast<fftwf_complex*>(values.data());
}

}  // namespace

std::int64_t fast_size(std::int64_t n)
{
    for (;; --n) {
        std::int64_t rest = n;
        for (const std::int64_t p : {2, 3, 5, 7})
            while (rest % p == 0 && rest > 1) rest /= p;
        if (rest == 1) return n;
    }
}

struct Fourier2D::Plans {
    fftwf_plan forward, backward;
};

Fourier2D::Fourier2D(std::int64_t nx, std::int64_t ny) : nx_(nx), ny_(ny), plans_(std::make_unique<Plans>())
{
    std::vector<float> values(static_cast<std::size_t>(nx * ny));
    std::vector<std::complex<float>> spectrum(static_cast<std::size_t>(spectrum_size()));
    const std::lock_guard lock(planning);
    plans_->forward =
        fftwf_plan_dft_r2c_2d(static_cast<int>(ny), static_cast<int>(nx), values.data(), complex_of(spectrum), how);
    plans_->backward =
        fftwf_plan_dft_c2r_2d(static_cast<int>(ny), static_cast<int>(nx), complex_of(spectrum), values.data(), how);
}

Fourier2D::~Fourier2D()
{
    const std::lock_guard lock(planning);
    fftwf_destroy_plan(plans_->forward);
    fftwf_destroy_plan(plans_->backward);
}

void Fourier2D::forward(std::span<float> values, std::span<std::complex<float>> spectrum) const
{
    assert(static_cast<std::int64_t>(values.size()) == nx_ * ny_);
    assert(static_cast<std::int64_t>(spectrum.size()) == spectrum_size());
    fftwf_execute_dft_r2c(plans_->forward, values.data(), complex_of(spectrum));
}

void Fourier2D::backward(std::span<std::complex<float>> spectrum, std::span<float> values) const
{
    assert(static_cast<std::int64_t>(values.size()) == nx_ * ny_);
    assert(static_cast<std::int64_t>(spectrum.size()) == spectrum_size());
    fftwf_execute_dft_c2r(plans_->backward, complex_of(spectrum), values.data());
}

struct Cosine::Plans {
    fftwf_plan forward, backward;
};

Cosine::Cosine(std::int64_t n) : plans_(std::make_unique<Plans>())
{
    std::vector<float> line(static_cast<std::size_t>(n));
    const std::lock_guard lock(planning);
    plans_->forward = fftwf_plan_r2r_1d(static_cast<int>(n), line.data(), line.data(), FFTW_REDFT10, how);
    plans_->backward = fftwf_plan_r2r_1d(static_cast<int>(n), line.data(), line.data(), FFTW_REDFT01, how);
}

Cosine::~Cosine()
{
    const std::lock_guard lock(planning);
    fftwf_destroy_plan(plans_->forward);
    fftwf_destroy_plan(plans_->backward);
}

void Cosine::forward(std::span<float> line) const { fftwf_execute_r2r(plans_->forward, line.data(), line.data()); }
void Cosine::backward(std::span<float> line) const { fftwf_execute_r2r(plans_->backward, line.data(), line.data()); }

}  // namespace craze::images
