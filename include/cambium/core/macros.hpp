#pragma once

#if (defined(_MSVC_LANG) ? _MSVC_LANG : __cplusplus) < 202002L
#error "cambium needs C++20: compile with -std=c++20, with CMake by target_link_libraries(... cambium::cambium)"
#endif

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error \
    "cambium needs IEEE arithmetic: compile without -ffast-math and -ffinite-math-only (checks for NaN would be gone)"
#endif

/// Checks an invariant of the library (never user input: that is checked with errors). Define `CAMBIUM_ASSERT` before
/// the first cambium header to install a handler of your own: the same in all sources, and, where cambium::compiled is
/// linked, for the CMake target cambium_compiled. By default it is `assert`, and off with NDEBUG.
#ifndef CAMBIUM_ASSERT
#include <cassert>
#define CAMBIUM_ASSERT(condition, sentence) assert((condition) && (sentence))
#endif

/// Cold code: declared in `x.hpp`, defined in `x_impl.hpp` beside it; inline where the library is header-only, compiled
/// once in `cambium::compiled`.
#ifdef CAMBIUM_COMPILED
#define CAMBIUM_COLD
#else
#define CAMBIUM_COLD inline
#endif

/// Asks the compiler to inline everything that a function calls: worth a quarter of the time of a step (`bench/run
/// step` beside the same in a checkout that was configured with `CXXFLAGS=-DCAMBIUM_FLATTEN=`), for seconds of
/// compiling where behaviours are large. Compile with `-DCAMBIUM_FLATTEN=` to do without.
#ifndef CAMBIUM_FLATTEN
#if defined(__GNUC__)
#define CAMBIUM_FLATTEN [[gnu::flatten]]
#else
#define CAMBIUM_FLATTEN
#endif
#endif

/// Keeps a large function that few steps need out of those that call it, even where they are flattened.
#if defined(__GNUC__)
#define CAMBIUM_NOINLINE [[gnu::noinline]]
#else
#define CAMBIUM_NOINLINE
#endif

/// Asks the processor to load what is at an address that will soon be read. The address need not be valid.
#if defined(__GNUC__)
#define CAMBIUM_PREFETCH(address) __builtin_prefetch(address)
#else
#define CAMBIUM_PREFETCH(address) static_cast<void>(address)
#endif
