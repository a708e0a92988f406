#pragma once

#include <cstdint>
#include <cstdlib>

namespace support {

/// CAMBIUM_SAMPLES, 1 where it is not set: how many times their usual samples tests take that show only a part of what
/// there is.
inline std::uint64_t sample_factor() {
  char const* const factor = std::getenv("CAMBIUM_SAMPLES");
  return factor == nullptr ? 1 : std::strtoull(factor, nullptr, 10);
}

}  // namespace support
