#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map::detail {

/// Whether a vehicle in lane `from` may go on in its successor `to`: not from a drivable lane onto one that is not.
[[nodiscard]] inline bool may_enter(Lane const& from, Lane const& to) { return to.drivable() || !from.drivable(); }

/// How much a vehicle that goes on from `from` into `to` turns within 50 m [rad].
[[nodiscard]] inline double turn_into(Lane const& from, Lane const& to) {
  double const there = to.path.pose(std::min(to.length(), 50.0)).heading;
  return std::abs(geometry::angle_difference(there, from.path.pose(from.length()).heading));
}

/// The one of `lane`'s successors that `allowed` holds for and that turns least; of equal ones that with the smallest
/// id.
template <class Allowed>
[[nodiscard]] LaneId straightest_successor(Map const& map, Lane const& lane, Allowed const& allowed) {
  LaneId best = none<LaneId>;
  double least = std::numeric_limits<double>::infinity();
  for (auto const next : lane.successors) {
    if (!may_enter(lane, map.lane(next)) || !allowed(next)) continue;
    double const turn = turn_into(lane, map.lane(next));
    bool const is_equal = std::abs(turn - least) < 1e-9;
    if (is_equal ? next > best : turn > least) continue;
    best = next;
    least = turn;
  }
  return best;
}

/// The lanes side by side at one step of a route.
struct RouteStage {
  std::vector<LaneId> lanes;  ///< from left to right
  std::vector<LaneId> route;  ///< those of the route, in its order

  [[nodiscard]] bool has(LaneId lane) const { return std::find(lanes.begin(), lanes.end(), lane) != lanes.end(); }
  [[nodiscard]] bool is_on_route(LaneId lane) const {
    return std::find(route.begin(), route.end(), lane) != route.end();
  }
};

/// The lanes beside `lane` and itself, from left to right.
[[nodiscard]] inline std::vector<LaneId> lanes_beside(Map const& map, LaneId lane) {
  std::vector<LaneId> result{lane};
  auto const is_new = [&](LaneId id) {
    return is_valid(id) && std::find(result.begin(), result.end(), id) == result.end();
  };
  while (is_new(map.lane(result.front()).left_neighbor))
    result.insert(result.begin(), map.lane(result.front()).left_neighbor);
  while (is_new(map.lane(result.back()).right_neighbor)) result.push_back(map.lane(result.back()).right_neighbor);
  return result;
}

/// The route's stages. Throws `MapError` where it is empty, names a lane that the map does not have, or jumps.
[[nodiscard]] inline std::vector<RouteStage> route_stages(Map const& map, std::span<LaneId const> route) {
  if (route.empty()) throw MapError("route", "it has no lane", "give at least one");
  std::vector<RouteStage> stages;
  for (std::size_t i = 0; i < route.size(); ++i) {
    auto const lane = route[i];
    if (index_of(lane) >= map.lanes().size()) throw MapError("route", "lane " + to_string(lane) + " is not in the map");
    if (i > 0 && stages.back().has(lane)) {
      stages.back().route.push_back(lane);
      continue;
    }
    if (i > 0) {
      auto const& ahead = map.lane(route[i - 1]).successors;
      if (std::find(ahead.begin(), ahead.end(), lane) == ahead.end())
        throw MapError("route", map.describe(lane) + " neither follows nor is beside " + map.describe(route[i - 1]),
                       "list every lane, in order, as Map::shortest_route does");
    }
    stages.push_back({lanes_beside(map, lane), {lane}});
  }
  return stages;
}

/// Lanes in sequence, the first one in stage `begin` of the route.
struct LaneChain {
  std::size_t begin{};
  std::vector<LaneId> lanes;

  [[nodiscard]] bool has(LaneId lane) const { return std::find(lanes.begin(), lanes.end(), lane) != lanes.end(); }
  /// Its lane in a stage; none where it has not begun or has ended.
  [[nodiscard]] LaneId at(std::size_t stage) const {
    return stage >= begin && stage - begin < lanes.size() ? lanes[stage - begin] : none<LaneId>;
  }
};

/// Where a chain goes on from `lane` into `stage`: on the route if it can, else the straightest way.
[[nodiscard]] inline LaneId next_in_chain(Map const& map, Lane const& lane, RouteStage const& stage) {
  auto const on_route = straightest_successor(map, lane, [&stage](LaneId next) { return stage.is_on_route(next); });
  if (is_valid(on_route)) return on_route;
  return straightest_successor(map, lane, [&stage](LaneId next) { return stage.has(next); });
}

/// The chains of a route: each goes on while a successor is in the next stage; a lane that none has come to begins a
/// new one.
[[nodiscard]] inline std::vector<LaneChain> lane_chains(Map const& map, std::span<RouteStage const> stages) {
  std::vector<LaneChain> chains;
  for (std::size_t k = 0; k < stages.size(); ++k) {
    for (auto& chain : chains) {
      if (chain.begin + chain.lanes.size() != k) continue;
      auto const next = next_in_chain(map, map.lane(chain.lanes.back()), stages[k]);
      if (is_valid(next)) chain.lanes.push_back(next);
    }
    for (auto const lane : stages[k].lanes) {
      bool const is_reached =
          std::any_of(chains.begin(), chains.end(), [&](LaneChain const& c) { return c.at(k) == lane; });
      if (!is_reached) chains.push_back({k, {lane}});
    }
  }
  return chains;
}

}  // namespace cambium::inline v0_1::map::detail
