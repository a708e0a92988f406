#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace support {

/// How many runs a statistical test makes: its usual number times CAMBIUM_SCALE (1 where that is not set; tests/run
/// sets less, and tests/run --all sets 1), at least one. More than 1 looks longer for what is rare.
inline std::uint32_t runs(double usual) {
  char const* const scale = std::getenv("CAMBIUM_SCALE");
  char* end = nullptr;
  double const factor = scale == nullptr ? 1.0 : std::strtod(scale, &end);
  if (scale != nullptr && (end == scale || *end != '\0' || !(factor > 0.0)))
    throw std::runtime_error("CAMBIUM_SCALE is '" + std::string(scale) + "'; give a number above 0, such as 0.2");
  return static_cast<std::uint32_t>(std::clamp(std::round(usual * factor), 1.0, 1e9));
}

/// Whether this is a build of `tests/run --sanitize`, which takes more memory than others.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define CAMBIUM_HAS_SANITIZER true
#endif
#endif
#ifndef CAMBIUM_HAS_SANITIZER
#define CAMBIUM_HAS_SANITIZER false
#endif
inline constexpr bool has_sanitizer = CAMBIUM_HAS_SANITIZER;

}  // namespace support
