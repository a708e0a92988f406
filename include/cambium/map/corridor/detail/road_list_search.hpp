#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/route.hpp"

namespace cambium::map::detail {

/// The lanes by which traffic in one direction comes onto a road, or leaves it.
[[nodiscard]] inline std::vector<LaneId> lanes_at_end(Map const& map, Road const& road, RoadDirection direction,
                                                      bool entry) {
  bool const forward = direction == RoadDirection::forward;
  std::vector<LaneId> lanes;
  for (std::size_t i = 0; i < road.sections.size() && lanes.empty(); ++i) {
    auto const& section = road.sections[forward == entry ? i : road.sections.size() - 1 - i];
    for (auto const& lane : section.lanes)
      for (auto const id : {lane.id, lane.opposite})
        if (is_valid(id) && map.lane(id).drivable() && map.lane(id).along_road == forward) lanes.push_back(id);
  }
  return lanes;
}

/// The cheapest lanes along a list of roads, in which a road may come more than once: Dijkstra's algorithm over the
/// lanes of each entry of the list. O(n log n) in those lanes.
class RoadListSearch {
 public:
  /// Both must outlive the search; `order` is not empty.
  RoadListSearch(Map const& map, std::span<RoadId const> order) : map_(map), order_(order) {}

  /// The route from the begin of the first road, driven in `direction`, to the end of the last one.
  [[nodiscard]] std::optional<Route> find(RoadDirection direction) {
    find_exits(direction);
    for (auto const lane : lanes_at_end(map_, map_.road(order_.front()), direction, true))
      offer({0, lane}, 0.0, {0, lane});
    while (!open_.empty()) {
      auto const [cost, place] = *open_.begin();
      open_.erase(open_.begin());
      if (place.step == order_.size()) return route_to(place, cost);
      follow(place, cost);
    }
    return std::nullopt;
  }

 private:
  /// A lane of the list's entry `step`; behind the last one, the end of it.
  struct Place {
    std::size_t step{};
    LaneId lane = none<LaneId>;
    friend auto operator<=>(Place const&, Place const&) = default;
  };
  struct Reached {
    double cost{};
    Place from;
  };

  void find_exits(RoadDirection direction) {
    for (auto const way : {RoadDirection::forward, RoadDirection::backward}) {
      if (order_.size() == 1 && way != direction) continue;
      for (auto const lane : lanes_at_end(map_, map_.road(order_.back()), way, false)) exits_.push_back(lane);
    }
  }

  void offer(Place const& to, double cost, Place const& from) {
    auto const [known, is_new] = reached_.try_emplace(to, Reached{cost, from});
    if (!is_new) {
      if (known->second.cost <= cost) return;
      open_.erase({known->second.cost, to});
      known->second = {cost, from};
    }
    open_.emplace(cost, to);
  }

  void follow(Place const& at, double cost) {
    auto const& lane = map_.lane(at.lane);
    for (auto const side : {lane.left_neighbor, lane.right_neighbor})
      if (is_valid(side) && map_.lane(side).drivable()) offer({at.step, side}, cost + lane_change_cost_, at);
    for (auto const next : lane.successors) {
      if (!map_.lane(next).drivable()) continue;
      if (stays_on_road(lane, map_.lane(next)))
        offer({at.step, next}, cost + lane.length(), at);
      else if (at.step + 1 < order_.size() && map_.lane(next).road == order_[at.step + 1])
        offer({at.step + 1, next}, cost + lane.length(), at);
    }
    bool const leaves = std::find(exits_.begin(), exits_.end(), at.lane) != exits_.end();
    if (leaves && at.step + 1 == order_.size()) offer({order_.size(), at.lane}, cost + lane.length(), at);
  }

  /// Whether a lane's successor is in one of the road's further sections, and not at its other end.
  [[nodiscard]] static bool stays_on_road(Lane const& lane, Lane const& next) {
    return next.road == lane.road && next.along_road == lane.along_road &&
           (lane.along_road ? next.section > lane.section : next.section < lane.section);
  }

  [[nodiscard]] Route route_to(Place const& end, double cost) const {
    Route route{{}, map_.lane(end.lane).length(), cost};
    for (Place at = reached_.at(end).from;; at = reached_.at(at).from) {
      if (!route.lanes.empty()) {
        auto const& ahead = map_.lane(at.lane).successors;
        if (std::find(ahead.begin(), ahead.end(), route.lanes.back()) != ahead.end())
          route.length += map_.lane(at.lane).length();
      }
      route.lanes.push_back(at.lane);
      if (reached_.at(at).from == at) break;
    }
    std::reverse(route.lanes.begin(), route.lanes.end());
    return route;
  }

  Map const& map_;
  std::span<RoadId const> order_;
  double lane_change_cost_ = RouteOptions{}.lane_change_cost;  // [m]
  std::vector<LaneId> exits_;
  std::map<Place, Reached> reached_;
  std::set<std::pair<double, Place>> open_;
};

}  // namespace cambium::map::detail
