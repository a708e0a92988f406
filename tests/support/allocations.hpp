#pragma once

#include <cstdint>

namespace support {

/// How often the calling thread has asked `operator new` for memory.
std::uint64_t allocations();

}  // namespace support
