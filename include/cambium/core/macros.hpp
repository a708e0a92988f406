#pragma once

#if (defined(_MSVC_LANG) ? _MSVC_LANG : __cplusplus) < 202002L
#error "cambium needs C++20: compile with -std=c++20, with CMake by target_link_libraries(... cambium::cambium)"
#include <C++20>  // there is no such file: the compiler stops here
#endif

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "cambium needs IEEE arithmetic: compile without -ffast-math and -ffinite-math-only (they remove checks for NaN)"
#endif

/// Checks an invariant of the library, never user input, which raises errors. The default is `assert`, which NDEBUG
/// turns off. To install your own handler, define `CAMBIUM_ASSERT` before the first cambium header, identically in all
/// sources and, if you link cambium::compiled, as a PUBLIC definition of the CMake target cambium_compiled_core.
#ifndef CAMBIUM_ASSERT
#include <cassert>
#define CAMBIUM_ASSERT(condition, sentence) assert((condition) && (sentence))
#endif

/// Marks cold code, which is declared in `x.hpp` and defined in `x_impl.hpp`: inline in the header-only library,
/// compiled once in `cambium::compiled`.
#ifdef CAMBIUM_COMPILED
#define CAMBIUM_COLD
#else
#define CAMBIUM_COLD inline
#endif

/// Asks the compiler to inline everything that a function calls. This saves a quarter of the time of a step and costs
/// seconds of compile time where behaviours are large. Compile with `-DCAMBIUM_FLATTEN=` to turn it off; to measure the
/// difference, compare `bench/run step` with a checkout configured with `CXXFLAGS=-DCAMBIUM_FLATTEN=`.
#ifndef CAMBIUM_FLATTEN
#if defined(__GNUC__)
#define CAMBIUM_FLATTEN [[gnu::flatten]]
#else
#define CAMBIUM_FLATTEN
#endif
#endif

/// Keeps a large, rarely called function from being inlined, even into flattened callers.
#if defined(__GNUC__)
#define CAMBIUM_NOINLINE [[gnu::noinline]]
#else
#define CAMBIUM_NOINLINE
#endif

/// Asks the processor to load an address that will soon be read. The address need not be valid.
#if defined(__GNUC__)
#define CAMBIUM_PREFETCH(address) __builtin_prefetch(address)
#else
#define CAMBIUM_PREFETCH(address) static_cast<void>(address)
#endif
