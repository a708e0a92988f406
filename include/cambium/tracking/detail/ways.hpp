#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/world.hpp"

namespace cambium::inline v0_1::detail {

/// A road that an object may follow, its place there, and how probable that is.
struct Way {
  std::shared_ptr<map::RoadCorridor const> road;
  map::LanePlace place;
  double odds = 1.0;
};

/// How an object moves, as ways are judged by it.
struct Moving {
  geometry::Pose pose;
  double speed = 0.0, yaw_rate = 0.0;
};

inline constexpr double most_aslant_in_lane = 0.8;  ///< to its lane: more is off the lanes [rad]; own choice
inline constexpr double farthest_off_lane = 0.5;    ///< beyond its border: likewise [m]

/// The lane of a way at its place.
[[nodiscard]] inline LaneId lane_of(Way const& way) {
  return way.road->corridors[way.place.corridor].pieces[way.place.piece].lane;
}

/// How well a way fits a motion, as the logarithm of a likelihood; -infinity where it does not.
[[nodiscard]] inline double fit(Moving const& moving, Way const& way) {
  constexpr double aside = 0.7, aslant = 0.15, turning = 0.15;  // standard deviations [m], [rad], [rad/s]
  auto const& corridor = way.road->corridors[way.place.corridor];
  auto const widths = corridor.widths_at(way.place.s, way.place.segment);
  double const lateral = way.place.lateral, outside = std::max(lateral - widths.left, -widths.right - lateral);
  if (outside > farthest_off_lane || std::abs(way.place.heading_error) > most_aslant_in_lane ||
      way.place.s > corridor.length())
    return -std::numeric_limits<double>::infinity();
  auto const& segment = corridor.center.segments()[way.place.segment];
  double const turn = moving.yaw_rate - segment.curvature * moving.speed;
  auto const square = [](double x) { return x * x; };
  return -0.5 * (square(lateral / aside) + square(way.place.heading_error / aslant) + square(turn / turning));
}

/// Sorts ways by odds, drops the negligible ones, and makes the sum of the odds 1.
inline void normalize(std::vector<Way>& ways) {
  constexpr double negligible = 0.002;
  constexpr std::size_t most = 6;
  for (auto way = ways.begin(); way != ways.end(); ++way) {  // they are few, and mostly in order
    auto const at =
        std::upper_bound(ways.begin(), way, *way, [](Way const& a, Way const& b) { return a.odds > b.odds; });
    std::rotate(at, way, way + 1);
  }
  auto const sum = [&] {
    double all = 0.0;
    for (auto const& way : ways) all += way.odds;
    return all;
  };
  std::erase_if(ways, [least = negligible * sum()](Way const& way) { return !(way.odds > least); });
  if (ways.size() > most) ways.resize(most);
  for (double const all = sum(); auto& way : ways) way.odds /= all;
}

/// The odds before anything was measured there of a road among `forks` that begin in its lane.
[[nodiscard]] inline double inherited_odds(std::vector<Way> const& before, map::RoadCorridor const& road,
                                           std::size_t forks) {
  constexpr double unforeseen = 0.02;
  double odds = before.empty() ? 1.0 : unforeseen;
  auto const& route = road.route;
  for (auto const& way : before) {
    auto const& old = way.road->route;
    auto const at = std::find(old.begin(), old.end(), route.front());
    if (at == old.end()) continue;
    auto const same = std::mismatch(at, old.end(), route.begin(), route.end());
    if (same.first == old.end() || same.second == route.end() || same.first - at > 1) odds += way.odds;
  }
  return odds / static_cast<double>(forks);
}

/// The ways from where an object is. Those that go on like one that it had are as probable as that.
[[nodiscard]] inline std::vector<Way> ways_at(Map const& map, Moving const& moving, std::vector<Way> const& before) {
  std::vector<Way> ways;
  map.for_each_drivable_near(moving.pose.position(), farthest_off_lane, [&](map::LaneHit const& hit) {
    auto const& lane = map.lane(hit.lane);
    double const error = geometry::angle_difference(moving.pose.heading, lane.path.pose(hit.s).heading);
    if (std::abs(error) > most_aslant_in_lane || hit.s < -1.0 || hit.s > lane.length() + 1.0) return;
    auto const roads = map::roads_ahead(map, hit.lane);
    for (auto const& road : roads) {
      map::LanePlace hint;
      auto const& corridor = road->corridors[road->main];
      hint.segment = corridor.center.find(std::clamp(hit.s, 0.0, corridor.length()));
      Way way{road, map::locate(*road, road->main, moving.pose, hint), 1.0};
      double const likelihood = fit(moving, way);
      way.odds = inherited_odds(before, *road, roads.size()) * portable::exp(std::max(-700.0, likelihood));
      if (way.odds > 0.0 && likelihood > -std::numeric_limits<double>::infinity()) ways.push_back(std::move(way));
    }
  });
  if (!ways.empty()) normalize(ways);
  return ways;
}

/// Follows the ways of an object, measured `since` [s] the last time, or finds new ones where it has come into another
/// lane or fits none; none are left where it is on no lane.
inline void follow_ways(Map const& map, Moving const& moving, double since, std::vector<Way>& ways) {
  constexpr double independent = 0.4;  // [s] after which measurements are new evidence
  constexpr double impossible = -std::numeric_limits<double>::infinity();
  double best = impossible;
  std::vector<double> fits;
  for (auto& way : ways) {
    way.place = seen_place(map, *way.road, way.place, moving.pose, true);
    fits.push_back(fit(moving, way));
    best = std::max(best, fits.back());
  }
  if (best == impossible) {
    ways.clear();
  } else {
    for (std::size_t i = 0; i < fits.size(); ++i)
      ways[i].odds *= portable::exp(std::min(1.0, since / independent) * (fits[i] - best));
    normalize(ways);
  }
  if (ways.empty() || lane_of(ways.front()) != ways.front().road->route.front()) ways = ways_at(map, moving, ways);
}

}  // namespace cambium::inline v0_1::detail
