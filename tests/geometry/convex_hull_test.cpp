// Convex hulls and what two of them have in common.
#include "cambium/geometry/convex_hull.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"

using namespace cambium::geometry;

namespace {

/// Numbers from `low` to `high`.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : stream_(seed, 0, 0) {}
  double operator()(double low, double high) { return low + (high - low) * cambium::uniform01(stream_); }

 private:
  cambium::RandomStream stream_;
};

}  // namespace

TEST_CASE("the convex hull holds all points, has corners among them, and turns left at each") {
  Numbers random(7);
  for (int run = 0; run < 200; ++run) {
    std::vector<Point> points;
    int const count = static_cast<int>(random(3, 30));
    // On a coarse grid, so that points coincide and lie on lines.
    for (int i = 0; i < count; ++i) points.emplace_back(std::floor(random(0, 6)), std::floor(random(0, 6)));
    auto const hull = convex_hull(points);
    for (std::size_t i = 0; hull.size() > 2 && i < hull.size(); ++i) {
      auto const &a = hull[i], &b = hull[(i + 1) % hull.size()], &c = hull[(i + 2) % hull.size()];
      CHECK(turn(a, b, c) > 0.0);
      for (auto const& p : points) CHECK(turn(a, b, p) >= 0.0);
      CHECK(std::count(points.begin(), points.end(), a) > 0);
    }
    if (hull.size() > 2) continue;
    for (auto const& p : points) CHECK(turn(hull.front(), hull.back(), p) == 0.0);
  }
}

TEST_CASE("two convex polygons have in common what both hold") {
  Numbers random(3);
  int inside = 0;
  for (int run = 0; run < 300; ++run) {
    std::vector<std::vector<Point>> hulls;
    for (int k = 0; k < 2; ++k) {
      std::vector<Point> points;
      for (int i = 0; i < 8; ++i) points.emplace_back(random(0, 10) + 3 * k, random(0, 10));
      hulls.push_back(convex_hull(points));
    }
    auto const common = convex_intersection(hulls[0], hulls[1]);
    auto const holds = [](std::vector<Point> const& hull, Point const& p, double margin) {
      for (std::size_t i = 0; i < hull.size(); ++i) {
        auto const& a = hull[i];
        auto const& b = hull[(i + 1) % hull.size()];
        if (turn(a, b, p) < margin * (b - a).norm()) return false;
      }
      return hull.size() > 2;
    };
    for (int i = 0; i < 20; ++i) {
      Point const p(random(0, 13), random(0, 10));
      bool const in_both = holds(hulls[0], p, 1e-6) && holds(hulls[1], p, 1e-6);
      if (in_both) CHECK(holds(common, p, -1e-6));
      if (holds(common, p, 1e-6)) CHECK((holds(hulls[0], p, -1e-6) && holds(hulls[1], p, -1e-6)));
      inside += in_both;
    }
  }
  CHECK(inside > 500);
}
