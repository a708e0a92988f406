// Replaces the global operators by ones that count: the standard's own way to see allocations. In a translation unit of
// its own, so that the compiler does not inline them into pairs that look mismatched.
#include "allocations.hpp"

#include <cstdlib>
#include <new>

namespace {
thread_local std::uint64_t count = 0, bytes = 0;
}

std::uint64_t support::allocations() { return count; }
std::uint64_t support::allocated_bytes() { return bytes; }

#if CAMBIUM_COUNTS_ALLOCATIONS
void* operator new(std::size_t size) {
  ++count;
  bytes += size;
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
#endif
