#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/lanelet/lanelet.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/lanes/overlaps.hpp"

/// The geometry of lanelets: bounds that can be built from, the line between them, and where they cross.
namespace cambium::inline v0_1::map::detail {

using geometry::Point;

/// A polyline and the arc lengths of its points [m].
struct Rail {
  explicit Rail(std::span<Point const> given) : points(given.begin(), given.end()) {
    for (auto const& p : points) s.push_back(s.empty() ? 0.0 : s.back() + (p - points[s.size() - 1]).norm());
  }

  [[nodiscard]] double length() const { return s.back(); }

  /// The point at share `u` of the length, from 0 to 1.
  [[nodiscard]] Point at(double u) const {
    double const place = u * length();
    auto const next = std::upper_bound(s.begin() + 1, s.end() - 1, place) - s.begin();
    auto const i = static_cast<std::size_t>(next);
    double const share = std::clamp((place - s[i - 1]) / (s[i] - s[i - 1]), 0.0, 1.0);
    return points[i - 1] + share * (points[i] - points[i - 1]);
  }

  std::vector<Point> points;
  std::vector<double> s;
};

/// Without points less than a centimetre from the one before, and with others between those more than 4 m apart: a
/// curve through them then keeps close to the straight pieces.
[[nodiscard]] inline std::vector<Point> evened(std::span<Point const> points) {
  constexpr double shortest = 0.01, longest = 4.0;
  constexpr double most = 2000.0;  // [m] of a segment that is divided
  std::vector<Point> result;
  for (auto const& p : points) {
    if (result.empty()) {
      result.push_back(p);
      continue;
    }
    auto const from = result.back();
    double const length = (p - from).norm();
    if (length < shortest) continue;
    int const pieces = length < most ? static_cast<int>(std::ceil(length / longest)) : 1;
    for (int k = 1; k < pieces; ++k) result.push_back(from + (p - from) * (static_cast<double>(k) / pieces));
    result.push_back(p);
  }
  return result;
}

/// Twice the area of the ring along the left bound and back along the right one [m^2]: negative, for it runs clockwise,
/// where the bounds lie on their sides.
[[nodiscard]] inline double twice_area_between(std::vector<Point> ring, std::span<Point const> right) {
  ring.insert(ring.end(), right.rbegin(), right.rend());
  return geometry::twice_area(ring);
}

/// Why a bound cannot be used; null where it can.
[[nodiscard]] inline char const* fault_of_bound(std::span<Point const> bound) {
  constexpr double farthest = 1e8;  // [m]
  for (auto const& p : bound)
    if (!(std::abs(p.x()) <= farthest && std::abs(p.y()) <= farthest)) return "a point is no finite place in metres";
  return evened(bound).size() < 2 ? "a bound has fewer than two points that are a centimetre apart" : nullptr;
}

/// Whether two segments cross away from their ends.
[[nodiscard]] inline bool segments_cross(Point const& a, Point const& b, Point const& c, Point const& d) {
  using geometry::turn;
  return turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0;
}

/// Whether the segment from `a` to `b` crosses a line away from its own ends; with `corners`, at a corner of the line,
/// too.
[[nodiscard]] inline bool crosses(Point const& a, Point const& b, std::span<Point const> line, bool corners = false) {
  using geometry::turn;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    auto const &c = line[i], &d = line[i + 1];
    if (segments_cross(a, b, c, d)) return true;
    bool const at_corner = (i > 0 && turn(a, b, c) == 0.0) || (i + 2 < line.size() && turn(a, b, d) == 0.0);
    if (corners && at_corner && turn(c, d, a) * turn(c, d, b) < 0.0) return true;
  }
  return false;
}

/// Whether bounds run opposite ways: places at the same shares of their lengths lie farther apart than those at
/// opposite shares. Where that is close, as in tight turns and short lanelets: whether only so the ends, joined by
/// straight lines, cross neither the bounds nor each other. False where a bound cannot be used.
[[nodiscard]] inline bool run_opposite_ways(std::span<Point const> left, std::span<Point const> right) {
  if (fault_of_bound(left) != nullptr || fault_of_bound(right) != nullptr) return false;
  constexpr int places = 16;
  constexpr double clear = 0.8, rounding = 1.0 + 1e-9;  // ratios of sums of distances
  Rail const a(evened(left)), b(evened(right));
  double same = 0.0, opposite = 0.0;  // [m]
  for (int k = 0; k <= places; ++k) {
    double const u = static_cast<double>(k) / places;
    Point const p = a.at(u);
    same += (p - b.at(u)).norm();
    opposite += (p - b.at(1.0 - u)).norm();
  }
  if (same < clear * opposite || opposite < clear * same) return same > opposite;
  auto const is_open = [&](Point const& right_begin, Point const& right_end) {
    auto const &begin = left.front(), &end = left.back();
    return !segments_cross(begin, right_begin, end, right_end) && !crosses(begin, right_begin, left, true) &&
           !crosses(begin, right_begin, right, true) && !crosses(end, right_end, left, true) &&
           !crosses(end, right_end, right, true);
  };
  bool const as_given = is_open(right.front(), right.back()), reversed = is_open(right.back(), right.front());
  return as_given != reversed ? reversed : same > rounding * opposite;
}

/// Why bounds cannot be used; null where they can. Of bounds that run opposite ways, that one is turned which then lies
/// on its side, which `turned` reports; bounds that lie on the wrong sides are exchanged, which `swapped` reports.
[[nodiscard]] inline char const* fault_of_bounds(Lanelet& lanelet, bool& swapped, bool& turned) {
  for (auto const* bound : {&lanelet.left, &lanelet.right})
    if (auto const* const fault = fault_of_bound(*bound)) return fault;
  turned = run_opposite_ways(lanelet.left, lanelet.right);
  if (turned) {
    std::reverse(lanelet.left.begin(), lanelet.left.end());
    bool const left_lies_right = twice_area_between(lanelet.left, lanelet.right) > 0.0;
    if (left_lies_right) {  // the other one is the wrong one
      std::reverse(lanelet.left.begin(), lanelet.left.end());
      std::reverse(lanelet.right.begin(), lanelet.right.end());
    }
    auto& heights = left_lies_right ? lanelet.right_heights : lanelet.left_heights;
    std::reverse(heights.begin(), heights.end());
  }
  double const twice_area = twice_area_between(lanelet.left, lanelet.right);
  if (!(std::abs(twice_area) > 0.02)) return "there is no room between its bounds";
  swapped = twice_area > 0.0;
  if (swapped) {
    std::swap(lanelet.left, lanelet.right);
    std::swap(lanelet.left_heights, lanelet.right_heights);
  }
  return nullptr;
}

/// The bounds as points of equal shares of their lengths face each other.
struct FacingBounds {
  explicit FacingBounds(Lanelet const& lanelet) : left(evened(lanelet.left)), right(evened(lanelet.right)) {
    for (auto const* rail : {&left, &right})
      for (double const s : rail->s) shares.push_back(s / rail->length());
    std::sort(shares.begin(), shares.end());
  }

  [[nodiscard]] Point middle(double u) const { return 0.5 * (left.at(u) + right.at(u)); }
  [[nodiscard]] double length() const { return 0.5 * (left.length() + right.length()); }

  Rail left, right;
  std::vector<double> shares{0.0, 1.0};  ///< of all corners of the bounds, sorted: between them the middle is straight
};

/// Places on the middle between the bounds: the begin, the middle of each straight piece, the end; with the direction
/// of the way there, and what lies beside it. A curve that has these directions there turns no more than the pieces do.
struct LaneletCenter {
  std::vector<Point> points, left, right;  ///< `left` and `right`: places on the bounds
  std::vector<double> headings;            ///< [rad]
  std::vector<Point> corners;              ///< between each two points, where the way turns
  std::vector<SideWidths> widths;
  std::vector<double> heights;  ///< of `points` [m]; empty: not known
};

/// The height at share `u` of a bound's length; `heights` are those of its points.
[[nodiscard]] inline double height_at(Rail const& rail, std::span<double const> heights, double u) {
  double const place = u * rail.length();
  auto const next = std::upper_bound(rail.s.begin() + 1, rail.s.end() - 1, place) - rail.s.begin();
  auto const i = static_cast<std::size_t>(next);
  double const length = rail.s[i] - rail.s[i - 1];
  double const share = length > 0.0 ? std::clamp((place - rail.s[i - 1]) / length, 0.0, 1.0) : 1.0;
  return heights[i - 1] + share * (heights[i] - heights[i - 1]);
}

/// The middle between facing points goes forwards wherever the directions of the bounds there are less than half a turn
/// apart. Precondition: `fault_of_bounds` finds none.
[[nodiscard]] inline LaneletCenter center_of(Lanelet const& lanelet) {
  constexpr double shortest = 1.0;  // [m] of a straight piece: shorter ones are jogs of the survey
  FacingBounds const bounds(lanelet);
  Rail const left_rail(lanelet.left), right_rail(lanelet.right);
  std::vector<double> corners;
  auto const middle = [&](double u) { return bounds.middle(u); };
  for (double const u : bounds.shares)
    if (corners.empty() || (middle(u) - middle(corners.back())).norm() >= shortest) corners.push_back(u);
  if (corners.size() > 1 && (middle(1.0) - middle(corners.back())).norm() < shortest) corners.pop_back();
  if (middle(1.0) != middle(corners.back())) corners.push_back(1.0);
  LaneletCenter center;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    Point const begin = middle(corners[i]), end = middle(corners[i + 1]), way = (end - begin).normalized();
    auto const add = [&](double u, Point const& p) {
      center.points.push_back(p);
      center.headings.push_back(portable::atan2(way.y(), way.x()));
      center.left.push_back(bounds.left.at(u));
      center.right.push_back(bounds.right.at(u));
      Point const across = center.left.back() - center.right.back();
      double const half = 0.5 * std::max(0.0, across.y() * way.x() - across.x() * way.y());
      center.widths.push_back({half, half});
      if (!lanelet.left_heights.empty())
        center.heights.push_back(
            0.5 * (height_at(left_rail, lanelet.left_heights, u) + height_at(right_rail, lanelet.right_heights, u)));
    };
    if (i == 0) add(0.0, begin);
    center.corners.push_back(i == 0 ? 0.75 * begin + 0.25 * end : begin);
    add(0.5 * (corners[i] + corners[i + 1]), 0.5 * (begin + end));
    if (i + 2 < corners.size()) continue;
    center.corners.push_back(0.25 * begin + 0.75 * end);
    add(1.0, end);
  }
  return center;
}

/// The direction of a way's first or last 1.5 m, of length 1.
[[nodiscard]] inline Point end_way(LaneletCenter const& center, bool at_end) {
  constexpr double far = 1.5;  // [m]
  auto const& p = center.points;
  auto const n = p.size();
  std::size_t k = 1;
  while (k + 1 < n && (at_end ? p[n - 1] - p[n - 1 - k] : p[k] - p[0]).norm() < far) ++k;
  return (at_end ? p[n - 1] - p[n - 1 - k] : p[k] - p[0]).normalized();
}

[[nodiscard]] inline double distance_to(std::span<Point const> line, Point const& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    Point const way = line[i + 1] - line[i];
    double const length = way.squaredNorm();
    double const u = length > 0.0 ? std::clamp((p - line[i]).dot(way) / length, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (p - (line[i] + u * way)).norm());
  }
  return nearest;
}

/// Whether the ring, which may touch or cross itself, runs round `p`: by its winding number.
[[nodiscard]] inline bool is_within(std::span<Point const> ring, Point const& p) {
  int turns = 0;
  for (std::size_t i = 0, k = ring.size() - 1; i < ring.size(); k = i++) {
    auto const &b = ring[i], &a = ring[k];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) turns += b.y() > a.y() ? 1 : -1;
  }
  return turns != 0;
}

/// Whether the bounds cross and lie on each other's sides by more than 0.1 m. Those that end aslant may face each
/// other the wrong way round without crossing.
[[nodiscard]] inline bool bounds_cross(Lanelet const& lanelet) {
  constexpr double most = 0.1;  // [m] by which they may lie on each other's sides
  FacingBounds const bounds(lanelet);
  auto const wrong = [&](double u, double v) {
    Point const way = bounds.middle(v) - bounds.middle(u), across = bounds.left.at(u) - bounds.right.at(u);
    return across.y() * way.x() - across.x() * way.y() < -most * way.norm();
  };
  bool any = false;
  for (std::size_t i = 0; i + 1 < bounds.shares.size(); ++i) any = any || wrong(bounds.shares[i], bounds.shares[i + 1]);
  if (!any) return false;
  auto const &l = lanelet.left, &r = lanelet.right;
  for (std::size_t i = 0; i + 1 < l.size(); ++i)
    if (crosses(l[i], l[i + 1], r)) return true;
  return false;
}

/// From which point of a lanelet's middle to which its left (else its right) bound runs along `line`.
[[nodiscard]] inline std::vector<std::pair<std::size_t, std::size_t>> places_beside(LaneletCenter const& center,
                                                                                    bool on_left,
                                                                                    std::span<Point const> line) {
  constexpr double farthest = 1.0;  // [m]
  auto const& bound = on_left ? center.left : center.right;
  std::vector<std::pair<std::size_t, std::size_t>> stretches;
  for (std::size_t i = 0; i < bound.size(); ++i) {
    if (distance_to(line, bound[i]) > farthest) continue;
    if (!stretches.empty() && stretches.back().second + 1 == i)
      stretches.back().second = i;
    else
      stretches.emplace_back(i, i);
  }
  std::erase_if(stretches, [](auto const& stretch) { return stretch.first == stretch.second; });
  return stretches;
}

/// Whether the left (else right) bound of a lanelet runs along `line` for at least half of its length.
[[nodiscard]] inline bool runs_along(LaneletCenter const& center, bool on_left, std::span<Point const> line) {
  Rail const way(center.points);
  double beside = 0.0;
  for (auto const& [first, last] : places_beside(center, on_left, line)) beside += way.s[last] - way.s[first];
  return beside >= 0.5 * way.length();
}

inline constexpr std::size_t part_length = 16;  ///< segments

/// The boxes of a line's parts of `part_length` segments each.
[[nodiscard]] inline std::vector<geometry::Box> boxes_of_parts(std::span<Point const> line) {
  std::vector<geometry::Box> boxes;
  for (std::size_t i = 0; i + 1 < line.size(); i += part_length)
    boxes.push_back(geometry::box_around(line.subspan(i, std::min(part_length + 1, line.size() - i))));
  return boxes;
}

/// Whether a part of one way, from segment `i_first`, crosses a part of another one.
[[nodiscard]] inline bool parts_cross(LaneletCenter const& one, std::size_t i_first, LaneletCenter const& other,
                                      std::size_t k_first) {
  auto const &a = one.points, &b = other.points;
  constexpr double near_end = 0.5, sine = 0.34;  // [m], of 20 degrees
  auto const from_ends = [](std::vector<Point> const& line, Point const& p) {
    return std::min((p - line.front()).norm(), (p - line.back()).norm());
  };
  for (std::size_t i = i_first; i < std::min(i_first + part_length, a.size() - 1); ++i)
    for (std::size_t k = k_first; k < std::min(k_first + part_length, b.size() - 1); ++k) {
      Point const u = a[i + 1] - a[i], v = b[k + 1] - b[k], w = b[k] - a[i];
      double const turn = u.x() * v.y() - u.y() * v.x();
      if (!(std::abs(turn) >= sine * u.norm() * v.norm()) || turn == 0.0) continue;
      double const along = (w.x() * v.y() - w.y() * v.x()) / turn, across = (w.x() * u.y() - w.y() * u.x()) / turn;
      if (along < 0.0 || along > 1.0 || across < 0.0 || across > 1.0) continue;
      auto const height = [](LaneletCenter const& center, std::size_t at, double share) {
        auto const& h = center.heights;
        return h.empty() ? 0.0 : h[at] + share * (h[at + 1] - h[at]);
      };
      if (std::abs(height(one, i, along) - height(other, k, across)) > clear_height) continue;
      Point const p = a[i] + along * u;
      if (from_ends(a, p) > near_end && from_ends(b, p) > near_end) return true;
    }
  return false;
}

/// Whether two ways cross, away from their ends, at an angle of 20 degrees or more.
[[nodiscard]] inline bool cross_each_other(LaneletCenter const& one, LaneletCenter const& other) {
  auto const own = boxes_of_parts(one.points), others = boxes_of_parts(other.points);
  for (std::size_t i = 0; i < own.size(); ++i)
    for (std::size_t k = 0; k < others.size(); ++k)
      if (own[i].intersects(others[k]) && parts_cross(one, i * part_length, other, k * part_length)) return true;
  return false;
}

}  // namespace cambium::inline v0_1::map::detail
