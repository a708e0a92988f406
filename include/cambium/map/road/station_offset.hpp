#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/road/reference_line.hpp"

namespace cambium::inline v0_1::map {

/// Where a point lies relative to a reference line.
struct StationOffset {
  double s{};         ///< of the foot point, within the line [m]
  double t{};         ///< signed offset, left positive [m]
  double distance{};  ///< to the foot point: more than |t| beyond an end of the line, or at a kink [m]
};

namespace detail {

[[nodiscard]] inline StationOffset offset_from(CurvePoint const& foot, double s, geometry::Point const& p) {
  auto const [sin, cos] = portable::sin_cos(foot.heading);
  double const dx = p.x() - foot.x, dy = p.y() - foot.y;
  return {s, cos * dy - sin * dx, portable::hypot(dx, dy)};
}

/// Newton's method for the foot point of `p` on the geometries of a line: where (p - r(s)) . T(s) = 0.
class FootFinder {
 public:
  FootFinder(ReferenceLine const& line, geometry::Point const& p) : line_(line), all_(line.geometries()), p_(p) {}

  /// The foot point that the search comes to from `s`, a local minimum of the distance.
  [[nodiscard]] StationOffset from(double s) {
    index_ = line_.locate(s);
    s = std::clamp(s, begin(), end());
    double low = -infinity, high = infinity;  // the foot point is between them
    for (int i = 0; i < 100; ++i) {
      auto const r = evaluate(all_[index_], s - all_[index_].s);
      auto const [sin, cos] = portable::sin_cos(r.heading);
      double const dx = p_.x() - r.x, dy = p_.y() - r.y;
      double const ahead = cos * dx + sin * dy, t = cos * dy - sin * dx;
      (ahead > 0.0 ? low : high) = s;
      // Beyond the centre of curvature there is no foot point near: go on towards where the distance falls.
      double next = s + ahead / std::max(1.0 - r.curvature * t, 0.2);
      if (std::isfinite(low + high) && (next < low || next > high)) next = 0.5 * (low + high);
      double const inside = std::clamp(next, begin(), end());
      if (std::abs(inside - s) > 1e-11 * std::max(1.0, std::abs(s))) {
        s = inside;
      } else if (next != inside && cross_joint(ahead > 0.0)) {
        low = -infinity, high = infinity;
        s = ahead > 0.0 ? begin() : end();
        i = 0;
      } else {
        return {inside, t, portable::hypot(dx, dy)};
      }
    }
    return offset_from(evaluate(all_[index_], s - all_[index_].s), s, p_);
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  [[nodiscard]] double begin() const { return all_[index_].s; }
  [[nodiscard]] double end() const {
    return index_ + 1 < all_.size() ? all_[index_ + 1].s : all_[index_].s + all_[index_].length;
  }

  /// Moves to the next geometry if there is one and the foot point lies that way there too; else it is the joint.
  bool cross_joint(bool forward) {
    if (forward ? index_ + 1 == all_.size() : index_ == 0) return false;
    std::size_t const next = forward ? index_ + 1 : index_ - 1;
    double const joint = forward ? end() : begin();
    auto const r = evaluate(all_[next], joint - all_[next].s);
    auto const [sin, cos] = portable::sin_cos(r.heading);
    double const ahead = cos * (p_.x() - r.x) + sin * (p_.y() - r.y);
    if (forward ? ahead <= 0.0 : ahead >= 0.0) return false;
    index_ = next;
    return true;
  }

  ReferenceLine const& line_;
  std::span<Geometry const> all_;
  geometry::Point p_;
  std::size_t index_ = 0;
};

}  // namespace detail

/// The foot point of `p` on `line` next to station `near` [m]: a local minimum of the distance to the exact curve, by
/// Newton's method to 1e-9 m. It is the nearest one of all while `near` is on the same side of the curve's other bends.
/// Costs a few evaluations of the line. Precondition: the line is not empty.
[[nodiscard]] inline StationOffset project(ReferenceLine const& line, geometry::Point const& p, double near) {
  CAMBIUM_ASSERT(!line.empty(), "a reference line needs a geometry before a point can be projected onto it");
  return detail::FootFinder(line, p).from(near);
}

/// The nearest point of `line`, of equally near ones the first; exact as above. O(length in turns of half a radian and
/// geometries).
[[nodiscard]] inline StationOffset project(ReferenceLine const& line, geometry::Point const& p) {
  CAMBIUM_ASSERT(!line.empty(), "a reference line needs a geometry before a point can be projected onto it");
  // Pieces that turn by half a radian at most have one foot point; those that may hold the nearest are asked for it.
  struct Piece {
    double middle, nearest;
  };
  std::vector<Piece> pieces;
  double farthest = std::numeric_limits<double>::infinity();
  for (Geometry const& g : line.geometries()) {
    double const turn = std::max(std::abs(g.curvature_start), std::abs(g.curvature_end)) * g.length;
    int const count = g.kind == GeometryKind::cubic ? 16 : static_cast<int>(std::min(1e4, turn / 0.5)) + 1;
    for (int i = 0; i < count; ++i) {
      double const middle = g.length * (i + 0.5) / count, half = 0.5 * g.length / count;
      auto const at = evaluate(g, middle);
      double const distance = portable::hypot(p.x() - at.x, p.y() - at.y);
      farthest = std::min(farthest, distance);
      pieces.push_back({g.s + middle, distance - half});
    }
  }
  StationOffset best{0.0, 0.0, std::numeric_limits<double>::infinity()};
  for (auto const& piece : pieces) {
    if (piece.nearest > std::min(farthest, best.distance)) continue;
    auto const foot = project(line, p, piece.middle);
    if (foot.distance < best.distance) best = foot;
  }
  return best;
}

}  // namespace cambium::inline v0_1::map
