// Arrays that begin on a cache line.

#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace craze {

/// Allocates whole cache lines.
template <class T>
struct CacheLines {
    using value_type = T;
    CacheLines() = default;
    template <class U>
    CacheLines(const CacheLines<U>&)
    {
    }
    T* allocate(std::size_t n) { return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{64})); }
    void deallocate(T* p, std::size_t) { ::operator delete (p, std::align_val_t{64}); }
    bool operator==(const CacheLines&) const { return true; }
};
template <class T>
using Aligned = std::vector<T, CacheLines<T>>;

}  // namespace craze
