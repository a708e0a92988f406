#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace support {

/// How many runs a statistical test makes: its usual number times CAMBIUM_SCALE (1 where that is not set; tests/run
/// sets less, and tests/run --all sets 1), at least one. More than 1 looks longer for what is rare.
inline std::uint32_t runs(double usual) {
  char const* const scale = std::getenv("CAMBIUM_SCALE");
  double const factor = scale == nullptr ? 1.0 : std::strtod(scale, nullptr);
  return static_cast<std::uint32_t>(std::clamp(std::round(usual * factor), 1.0, 1e9));
}

}  // namespace support
