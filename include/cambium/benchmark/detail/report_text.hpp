#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "cambium/benchmark/measure.hpp"
#include "cambium/benchmark/result_group.hpp"

/// What all formats of a report share.
namespace cambium::inline v0_1::detail {

/// `value` with that many places after the point.
[[nodiscard]] inline std::string fixed_text(double value, int decimals) {
  char buffer[400];
  auto const end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals).ptr;
  std::string text(buffer, end);
  return text.find_first_not_of("-0.") == text.npos && text.front() == '-' ? text.substr(1) : text;
}

/// `value` with three significant digits.
[[nodiscard]] inline std::string short_text(double value) {
  char buffer[40];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 3).ptr};
}

/// "least gap [m]".
[[nodiscard]] inline std::string titled(Measure const& measure) {
  return measure.unit.empty() ? measure.name : measure.name + " [" + measure.unit + "]";
}

/// Mean of the finite values; 0 without any.
[[nodiscard]] inline double mean_of_measure(ResultGroup const& group, Measure const& measure) {
  double sum = 0.0, count = 0.0;
  for (auto const& row : group.rows)
    if (double const value = measure.value(row); std::isfinite(value)) {
      sum += value;
      count += 1.0;
    }
  return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

/// The groups of each set, in order.
[[nodiscard]] inline std::vector<std::vector<std::size_t>> groups_by_set(std::vector<ResultGroup> const& groups) {
  std::vector<std::vector<std::size_t>> sets;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (i == 0 || groups[i].set_hash != groups[i - 1].set_hash) sets.emplace_back();
    sets.back().push_back(i);
  }
  return sets;
}

}  // namespace cambium::inline v0_1::detail
