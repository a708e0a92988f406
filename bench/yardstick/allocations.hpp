#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

// Replaces the global operator new and delete, so include this header in exactly one translation unit of a program.
// The array and nothrow forms of the standard library end in the functions below and are counted through them.
// What calls malloc itself (a dynamic Eigen matrix, say) is not seen.

namespace yardstick {

namespace detail {
inline thread_local constinit std::uint64_t allocation_count = 0;

inline void* counted(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  ++allocation_count;
  return memory;
}
}  // namespace detail

/// Number of successful calls of operator new by the calling thread so far.
[[nodiscard]] inline std::uint64_t allocations() { return detail::allocation_count; }

}  // namespace yardstick

// Out of line: g++ 12 warns of mismatched pairs where it inlines only one of the two.
[[gnu::noinline]] void* operator new(std::size_t size) {
  return yardstick::detail::counted(std::malloc(size > 0 ? size : 1));
}

[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  auto const step = static_cast<std::size_t>(alignment);
  return yardstick::detail::counted(std::aligned_alloc(step, (size + step - 1) / step * step));
}

[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
