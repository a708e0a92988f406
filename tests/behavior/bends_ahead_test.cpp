#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "../support/maps.hpp"
#include "cambium/cambium.hpp"
#include "cambium/map/road/curve_layout.hpp"

using namespace cambium;

namespace {

/// A road of straights, arcs and clothoids to both sides, whose curvature is known.
struct Winding {
  std::vector<map::CurvePiece> pieces;
  std::shared_ptr<map::RoadCorridor const> road;

  explicit Winding(RandomStream& random) {
    double curvature = 0.0;
    for (int i = 0; i < 8; ++i) {
      double const target = uniform01(random) < 0.3 ? 0.0 : 0.1 * uniform01(random) - 0.05;
      if (uniform01(random) < 0.5) pieces.push_back({10.0 + 30.0 * uniform01(random), curvature, target});
      pieces.push_back({10.0 + 30.0 * uniform01(random), target, target});
      curvature = target;
    }
    auto const map = support::map_of({.id = "1", .line = map::lay_from({}, pieces), .sections = {{.right = {{}}}}});
    auto const lane =
        std::find_if(map->lanes().begin(), map->lanes().end(), [](auto const& l) { return l.drivable(); });
    road = map::build_road_corridor(*map, map::straight_route(*map, lane->id));
  }
  [[nodiscard]] map::LaneCorridor const& corridor() const { return road->corridors[road->main]; }

  /// Smallest and largest curvature of the lane, 1.75 m to the right of its road's reference line, within 3 m of
  /// `place` [m] along the lane; the smallest is 0 where the lane bends to both sides.
  struct Range {
    double least, greatest;
  };
  [[nodiscard]] Range around(double place) const {
    Range range{1.0, 0.0};
    bool left = false, right = false;
    double begin = 0.0;
    for (auto const& piece : pieces) {
      double const parts = 400.0;
      for (double i = 0.0; i < parts; ++i) {
        double const share = (i + 0.5) / parts;
        double const curvature = piece.curvature_start + share * (piece.curvature_end - piece.curvature_start);
        double const stretch = 1.0 + 1.75 * curvature, length = piece.length / parts * stretch;
        if (std::abs(begin + 0.5 * length - place) < 3.0) {
          range.least = std::min(range.least, std::abs(curvature) / stretch);
          range.greatest = std::max(range.greatest, std::abs(curvature) / stretch);
          (curvature > 0.0 ? left : right) = true;
        }
        begin += length;
      }
    }
    if (left && right) range.least = 0.0;
    return range;
  }
};

}  // namespace

TEST_CASE("a corridor's bends are where the lane bends, and as sharp") {
  RandomStream random(11, 0, 0);
  int bent = 0, straight = 0;
  for (int run = 0; run < 30; ++run) {
    Winding const winding(random);
    auto const& corridor = winding.corridor();
    for (double s = 4.0; s < corridor.length() - 4.0; s += 0.7) {
      auto const range = winding.around(s);
      double found = 0.0;
      for (auto const& bend : corridor.bends)
        if (bend.begin <= s && s <= bend.end) found = std::max(found, bend.curvature);
      INFO("s ", s, ", least ", range.least, ", greatest ", range.greatest);
      CHECK(found >= 0.95 * range.least - 1e-3);
      CHECK(found <= 1.15 * range.greatest + 1e-3);
      (found > 0.0 ? bent : straight) += 1;
    }
  }
  CHECK(bent > 1000);
  CHECK(straight > 500);
}

TEST_CASE(
    "braking for a bend ends at the bend at the permitted speed, for any step, and never exceeds the chosen "
    "deceleration") {
  RandomStream random(4, 0, 0);
  for (int run = 0; run < 500; ++run) {
    double const dt = 0.05 + 0.45 * uniform01(random), braking = 1.0 + 3.0 * uniform01(random);
    double const highest = 2.0 + 8.0 * uniform01(random);
    double speed = highest + 12.0 * uniform01(random), left = 80.0 * uniform01(random);
    bool const in_time = speed * speed - highest * highest <= 2.0 * braking * left;
    double hardest = 0.0;
    while (left > 0.0) {
      auto const motion = motion_before_bend(speed, left, highest, braking, 8.0, dt);
      double const end = std::min(motion.speed, speed + 2.0 * dt);
      hardest = std::max(hardest, (speed - end) / dt);
      left -= 0.5 * (speed + end) * dt;
      speed = end;
      REQUIRE(speed >= highest - 1e-9);
    }
    if (!in_time) continue;
    CHECK(hardest <= braking + 1e-6);
    CHECK(speed <= highest + 1e-9);
  }
}

TEST_CASE("the speed for bends suits the sharpest one within the braking distance, and a step keeps to it") {
  RandomStream random(12, 0, 0);
  for (int run = 0; run < 30; ++run) {
    Winding const winding(random);
    auto const& corridor = winding.corridor();
    double const dt = 0.2, lateral = 2.5, braking = 1.5 + uniform01(random);
    double s = 5.0, speed = 3.0;
    while (s < corridor.length() - 30.0) {
      auto const ahead = detail::bends_ahead(corridor, s, speed, 15.0, lateral, braking, 8.0, dt);
      double const end = std::min({ahead.bound.speed, speed + 2.0 * dt, 15.0});
      s += std::min(ahead.bound.distance, 0.5 * (speed + end) * dt);
      speed = end;
      CHECK(ahead.highest <= 15.0);
      // The lane's own curvature at the place; a step may end just inside the next piece.
      CHECK(speed * speed * winding.around(s).least <= 1.1 * lateral);
    }
  }
}
