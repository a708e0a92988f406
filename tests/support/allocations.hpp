#pragma once

#include <cstdint>

// ThreadSanitizer has operators of its own, which cannot be replaced.
#define CAMBIUM_COUNTS_ALLOCATIONS 1
#ifdef __has_feature
#if __has_feature(thread_sanitizer)
#undef CAMBIUM_COUNTS_ALLOCATIONS
#define CAMBIUM_COUNTS_ALLOCATIONS 0
#endif
#endif

namespace support {

/// How often the calling thread has asked `operator new` for memory; 0 under ThreadSanitizer.
std::uint64_t allocations();

/// How many bytes that was in all.
std::uint64_t allocated_bytes();

}  // namespace support
