// Loops over threads. Results never depend on how many threads there are: write to your own range only, reduce
// floating-point numbers over fixed blocks, never with atomics.

#pragma once

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <vector>

namespace craze {

/// Threads that loops will use from now on; 0 means all cores.
void set_threads(int threads);
int threads();

/// Calls body(begin, end) once per thread on consecutive, nearly equal ranges of [0, n).
/// An exception in one thread is rethrown here after all have ended.
template <class Body>
void parallel_ranges(std::int64_t n, Body&& body)
{
    if (n <= 0) return;
    const auto team = static_cast<std::int64_t>(std::min<std::int64_t>(threads(), n));
    if (team == 1) {
        body(std::int64_t{0}, n);
        return;
    }
    std::vector<std::exception_ptr> errors(static_cast<std::size_t>(team));
#pragma omp parallel for num_threads(static_cast <int>(team)) schedule(static, 1)
    for (std::int64_t t = 0; t < team; ++t) {
        try {
            body(n * t / team, n * (t + 1) / team);
        } catch (...) {
            errors[static_cast<std::size_t>(t)] = std::current_exception();
        }
    }
    for (const auto& error : errors)
        if (error) std::rethrow_exception(error);
}

/// Calls body(task) for each task of [0, n), handed out one by one: for tasks of unequal cost that write apart.
template <class Body>
void parallel_tasks(std::int64_t n, Body&& body)
{
    std::exception_ptr error;
    std::atomic<bool> failed{false};
#pragma omp parallel for num_threads(threads()) schedule(dynamic, 1)
    for (std::int64_t task = 0; task < n; ++task) {
        if (failed.load(std::memory_order_relaxed)) continue;
        try {
            body(task);
        } catch (...) {
            if (!failed.exchange(true)) error = std::current_exception();
        }
    }
    if (error) std::rethrow_exception(error);
}

/// Sum of term(i) over [0, n), in fixed blocks added in order: the same bits on any number of threads.
template <class Term>
double parallel_sum(std::int64_t n, Term&& term)
{
    constexpr std::int64_t block = 4096;
    const std::int64_t blocks = (n + block - 1) / block;
    std::vector<double> partial(static_cast<std::size_t>(blocks), 0.0);
    parallel_ranges(blocks, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t b = begin; b < end; ++b) {
            double sum = 0.0;
            for (std::int64_t i = b * block; i < std::min(n, (b + 1) * block); ++i) sum += term(i);
            partial[static_cast<std::size_t>(b)] = sum;
        }
    });
    double total = 0.0;
    for (const double p : partial) total += p;
    return total;
}

}  // namespace craze
