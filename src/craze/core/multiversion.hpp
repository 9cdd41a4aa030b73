// Hot loops compiled for several instruction sets, the best one chosen when the program starts.
//
//     CRAZE_MULTIVERSION void add(float* a, const float* b, std::size_t n) { ... plain loop ... }
//
// The attribute does not reach into lambdas or other translation units: keep the loop in the marked function and
// what it calls inlined. Off under sanitizers, whose start-up comes after the choice.

#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(CRAZE_SANITIZED)
#define CRAZE_MULTIVERSION __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define CRAZE_MULTIVERSION
#endif

/// For small functions that a multi-versioned loop must absorb.
#define CRAZE_INLINE inline __attribute__((always_inline))
