#pragma once

#include <cstdint>

namespace support {

/// How often the calling thread has asked `operator new` for memory.
std::uint64_t allocations();

/// How many bytes that was in all.
std::uint64_t allocated_bytes();

}  // namespace support
