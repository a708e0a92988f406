#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/lanes/detail/lane_chords.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/lanes/overlaps.hpp"

namespace cambium::inline v0_1::map {

namespace detail {

/// Moves the ends of an overlap from where they are on chords to where they are on the lanes' exact paths.
class OverlapEnds {
 public:
  /// Without `place` the sampled paths are the exact ones.
  OverlapEnds(ExactPath const& place, double clearance) : place_(place), clearance_(clearance) {}

  /// Lets the stretches begin and end where one lane is as far from the other as the clearance. False where the exact
  /// paths do not come so near.
  [[nodiscard]] bool refine(Lane const& a, PathStretch& on_a, Lane const& b, PathStretch& on_b) const {
    bool const same_way = portable::cos(a.path.pose(on_a.middle()).heading - b.path.pose(on_b.middle()).heading) > 0.0;
    PathStretch const near_b = same_way ? on_b : PathStretch{on_b.end, on_b.begin},
                      near_a = same_way ? on_a : PathStretch{on_a.end, on_a.begin};
    auto const a_begin = refined(a, on_a.begin, on_a.end, b, near_b.begin),
               a_end = refined(a, on_a.end, on_a.begin, b, near_b.end),
               b_begin = refined(b, on_b.begin, on_b.end, a, near_a.begin),
               b_end = refined(b, on_b.end, on_b.begin, a, near_a.end);
    if (!a_begin || !a_end || !b_begin || !b_end) return false;
    on_a = {*a_begin, *a_end};
    on_b = {*b_begin, *b_end};
    return on_a.begin < on_a.end && on_b.begin < on_b.end;
  }

  /// Clips the stretch on `b` where `a` begins or ends within the overlap: what lies beyond belongs to the lane behind
  /// `a`.
  void trim(Lane const& a, PathStretch const& on_a, Lane const& b, PathStretch& on_b) const {
    constexpr double tolerance = 1e-3;
    if (on_a.begin == 0.0) {
      double const s = beside(at(a, 0.0), b, on_b.begin).begin;
      if (s > on_b.begin + tolerance) on_b.begin = s;
    }
    if (on_a.end == a.length()) {
      double const s = beside(at(a, a.length()), b, on_b.end).end;
      if (s < on_b.end - tolerance) on_b.end = s;
    }
  }

 private:
  static constexpr double precise = 1e-6;  // [m] of the distance

  struct Foot {
    double s{}, distance{};
  };

  [[nodiscard]] geometry::Pose at(Lane const& lane, double s) const {
    return place_ ? place_(lane, s) : lane.path.pose(s);
  }

  /// The position on the sampled path of the exact place at `s`.
  [[nodiscard]] double on_path(Lane const& lane, double s) const {
    if (!place_ || s == 0.0 || s == lane.length()) return s;
    return std::clamp(lane.path.project(at(lane, s).position(), lane.path.find(s)).s, 0.0, lane.length());
  }

  /// The nearest place of `lane` to `p`, looked for near path position `near`.
  [[nodiscard]] Foot foot(geometry::Point const& p, Lane const& lane, double near) const {
    double s = std::clamp(lane.path.project(p, lane.path.find(near)).s, 0.0, lane.length());
    for (int i = 0;; ++i) {
      auto const q = at(lane, s);
      double const dx = p.x() - q.x, dy = p.y() - q.y;
      auto const [uy, ux] = portable::sin_cos(q.heading);
      // On the inner side of a bend the foot point moves faster than the point.
      double const speed = std::max(0.1, 1.0 - lane.path.curvature(s) * (ux * dy - uy * dx));
      double const next = std::clamp(s + (dx * ux + dy * uy) / speed, 0.0, lane.length());
      if (std::abs(next - s) < 1e-3 || i == 20)
        return {next, portable::hypot(dx, dy)};  // off by a ten thousandth of that
      s = next;
    }
  }

  /// Moves `end` of the stretch between `end` and `other_end` to where `a` is exactly as far from `b` as the clearance.
  /// Nothing where the whole stretch is farther off: the lanes only graze each other.
  [[nodiscard]] std::optional<double> refined(Lane const& a, double end, double other_end, Lane const& b,
                                              double near) const {
    constexpr double farthest = 50.0;  // [m] outwards: lanes part as slowly as that
    auto const excess = [&](double s) {
      auto const nearest = foot(at(a, s).position(), b, near);
      near = nearest.s;
      return nearest.distance - clearance_;
    };
    Bracket bracket{end, end, excess(end), 0.0};
    if (std::abs(bracket.from_excess) < precise) return on_path(a, end);
    double const outwards = end < other_end ? -1.0 : 1.0;
    bool const goes_out = bracket.from_excess < 0.0;
    double const limit = goes_out ? std::clamp(end + outwards * farthest, 0.0, a.length()) : other_end;
    // Outwards in growing steps, for the end is mostly near; inwards in even ones, to find what is left.
    constexpr int pieces = 16;
    for (int i = 1;; ++i) {
      double const step = goes_out
                              ? std::min(0.05 * std::ldexp(1.0, i - 1) / std::max(std::abs(limit - end), 1e-9), 1.0)
                              : static_cast<double>(i) / pieces;
      bracket.to = step < 1.0 ? end + step * (limit - end) : limit;
      bracket.to_excess = excess(bracket.to);
      if ((bracket.to_excess < 0.0) != goes_out) return on_path(a, root(bracket, excess));
      if (bracket.to == limit) break;
      bracket.from = bracket.to;
      bracket.from_excess = bracket.to_excess;
    }
    if (!goes_out) return std::nullopt;
    return limit == 0.0 || limit == a.length() ? limit : end;
  }

  /// Between two places there is one where the excess is 0.
  struct Bracket {
    double from, to, from_excess, to_excess;
  };

  /// By regula falsi (Illinois), which a jump of the path does not lead astray.
  template <class Excess>
  [[nodiscard]] static double root(Bracket b, Excess const& excess) {
    constexpr double short_one = 1e-4;  // [m]
    for (int i = 0; i < 40 && std::abs(b.to - b.from) > short_one; ++i) {
      double const u = i % 4 == 3 ? 0.5 : std::clamp(b.from_excess / (b.from_excess - b.to_excess), 0.01, 0.99);
      double const s = b.from + u * (b.to - b.from), here = excess(s);
      if (std::abs(here) < precise) return s;
      if ((here < 0.0) == (b.from_excess < 0.0)) {
        b.from = s;
        b.from_excess = here;
        b.to_excess *= 0.5;
      } else {
        b.to = s;
        b.to_excess = here;
        b.from_excess *= 0.5;
      }
    }
    return 0.5 * (b.from + b.to);
  }

  /// The foot point of the lane end `end` on `b`, and the place on `b` from which `end` is the foot point, in the order
  /// of `b`; the same for lanes side by side.
  [[nodiscard]] PathStretch beside(geometry::Pose const& end, Lane const& b, double near) const {
    double const foot_point = foot(end.position(), b, near).s;
    auto const [uy, ux] = portable::sin_cos(end.heading);
    double other = foot_point;
    for (int i = 0; i < 8; ++i) {
      auto const pose = at(b, other);
      double const ahead = (pose.x - end.x) * ux + (pose.y - end.y) * uy;
      double const step = ahead / std::max(0.5, portable::cos(end.heading - pose.heading));
      other = std::clamp(other - step, 0.0, b.length());
      if (std::abs(step) < 1e-3) break;
    }
    double const p = on_path(b, foot_point), q = on_path(b, other);
    return {std::min(p, q), std::max(p, q)};
  }

  ExactPath const& place_;
  double clearance_;
};

}  // namespace detail
}  // namespace cambium::inline v0_1::map
