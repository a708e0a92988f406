#pragma once

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/pose.hpp"

namespace cambium::inline v0_1::geometry {

/// The corners of the convex hull of `points`, counter-clockwise, without points on straight sides (Andrew 1979). Fewer
/// than three if all points lie on one line. All coordinates must be finite. O(n log n).
[[nodiscard]] inline std::vector<Point> convex_hull(std::vector<Point> points) {
  auto const before = [](Point const& a, Point const& b) {
    return std::tuple(a.x(), a.y()) < std::tuple(b.x(), b.y());
  };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Point> hull;
  auto const add = [&hull](Point const& p, std::size_t least) {
    while (hull.size() >= least && turn(hull[hull.size() - 2], hull.back(), p) <= 0.0) hull.pop_back();
    hull.push_back(p);
  };
  for (auto const& p : points) add(p, 2);  // the lower side from left to right, then the upper side back
  std::size_t const lower = hull.size() + 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, lower);
  hull.pop_back();
  return hull;
}

/// The intersection of two convex polygons (Sutherland, Hodgman 1974). Arguments and result are corners,
/// counter-clockwise; the result is empty if the polygons are disjoint. O(n m).
[[nodiscard]] inline std::vector<Point> convex_intersection(std::vector<Point> subject,
                                                            std::vector<Point> const& clip) {
  for (std::size_t i = 0; i < clip.size() && !subject.empty(); ++i) {
    auto const &a = clip[i], &b = clip[(i + 1) % clip.size()];
    std::vector<Point> inside;
    for (std::size_t j = 0; j < subject.size(); ++j) {
      auto const &p = subject[j], &q = subject[(j + 1) % subject.size()];
      double const at_p = turn(a, b, p), at_q = turn(a, b, q);
      if (at_p >= 0.0) inside.push_back(p);
      if ((at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0)) {
        double const u = at_p / (at_p - at_q);
        inside.emplace_back(p.x() + u * (q.x() - p.x()), p.y() + u * (q.y() - p.y()));
      }
    }
    subject = std::move(inside);
  }
  return subject;
}

}  // namespace cambium::inline v0_1::geometry
