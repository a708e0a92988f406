#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace examples {

struct Interval {
  double low, high;
};

/// 95 % confidence interval of a share (Wilson 1927). `n` > 0.
[[nodiscard]] inline Interval wilson(std::uint64_t count, std::uint64_t n) {
  constexpr double z = 1.959963984540054;
  auto const total = static_cast<double>(n);
  double const p = static_cast<double>(count) / total;
  double const middle = (p + z * z / (2 * total)) / (1 + z * z / total);
  double const half = z / (1 + z * z / total) * std::sqrt(p * (1 - p) / total + z * z / (4 * total * total));
  return {count == 0 ? 0.0 : std::max(0.0, middle - half), count == n ? 1.0 : std::min(1.0, middle + half)};
}

}  // namespace examples
