#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "cambium/core/stable_sort.hpp"

namespace cambium::inline v0_1::map {

/// The polynomial a + b u + c u^2 + d u^3 with u = station - s, valid from `s` to the next record [m].
struct CubicRecord {
  double s{};  ///< start station [m]
  double a{};
  double b{};
  double c{};
  double d{};

  /// Value and derivatives by `station` [m].
  [[nodiscard]] double value(double station) const {
    double const u = station - s;
    return a + u * (b + u * (c + u * d));
  }
  [[nodiscard]] double derivative(double station) const {
    double const u = station - s;
    return b + u * (2.0 * c + u * 3.0 * d);
  }
  [[nodiscard]] double second_derivative(double station) const { return 2.0 * c + 6.0 * d * (station - s); }

  friend bool operator==(CubicRecord const&, CubicRecord const&) = default;
};

/// Whether all numbers of a record are finite; their sum need not be.
[[nodiscard]] inline bool is_finite(CubicRecord const& r) {
  return std::isfinite(r.s) && std::isfinite(r.a) && std::isfinite(r.b) && std::isfinite(r.c) && std::isfinite(r.d);
}

/// The smallest and the largest value of `record` on the stations from `from` to `to`.
[[nodiscard]] inline std::pair<double, double> extremes(CubicRecord const& record, double from, double to) {
  double low = std::min(record.value(from), record.value(to)), high = std::max(record.value(from), record.value(to));
  // Where b + 2 c u + 3 d u^2 = 0, by the form that does not cancel.
  double const root = std::sqrt(std::max(0.0, record.c * record.c - 3.0 * record.d * record.b));
  double const q = -(record.c + std::copysign(root, record.c));
  for (double const u : {q / (3.0 * record.d), record.b / q}) {
    if (!(u > from - record.s && u < to - record.s)) continue;
    low = std::min(low, record.value(record.s + u));
    high = std::max(high, record.value(record.s + u));
  }
  return {low, high};
}

/// Value of a profile before its first record: 0 (lane offset, elevation), or the first record's starting value
/// (widths).
enum class BeforeFirst { zero, hold };

/// A piecewise cubic function of the station, as OpenDRIVE uses it for widths, offsets and elevations. A record holds
/// on the half-open interval from its own start to the next one; at a common start the later record wins; the last one
/// never ends. Without records the function is 0. Every query is a binary search, O(log records).
class CubicProfile {
 public:
  CubicProfile() = default;
  /// Takes records in any order; those of equal start keep their order, so the later one wins.
  explicit CubicProfile(std::vector<CubicRecord> records, BeforeFirst before = BeforeFirst::zero)
      : records_(std::move(records)), before_(before) {
    cambium::detail::stable_sort(records_, &CubicRecord::s);
  }

  /// Before the first record 0, or the value at its start with `BeforeFirst::hold`.
  [[nodiscard]] double value(double s) const {
    CubicRecord const* record = find(s);
    if (record) return record->value(s);
    return before_ == BeforeFirst::hold && !records_.empty() ? records_.front().a : 0.0;
  }
  /// First derivative by the station, from the right at a record's start; 0 before the first record.
  [[nodiscard]] double derivative(double s) const {
    CubicRecord const* record = find(s);
    return record ? record->derivative(s) : 0.0;
  }
  /// Second derivative by the station, from the right at a record's start; 0 before the first record.
  [[nodiscard]] double second_derivative(double s) const {
    CubicRecord const* record = find(s);
    return record ? record->second_derivative(s) : 0.0;
  }

  /// The record in force at `s`, null before the first one.
  [[nodiscard]] CubicRecord const* find(double s) const {
    auto const next =
        std::upper_bound(records_.begin(), records_.end(), s, [](double v, CubicRecord const& r) { return v < r.s; });
    return next == records_.begin() ? nullptr : &*(next - 1);
  }
  /// Sorted by start; the starts are the places where derivatives may jump.
  [[nodiscard]] std::span<CubicRecord const> records() const { return records_; }
  [[nodiscard]] bool empty() const { return records_.empty(); }

 private:
  std::vector<CubicRecord> records_;
  BeforeFirst before_ = BeforeFirst::zero;
};

}  // namespace cambium::inline v0_1::map
