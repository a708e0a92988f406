#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/routing/route.hpp"

namespace cambium::inline v0_1::map::detail {

/// A way from lane to lane: ahead over the lane's end, or to the side.
struct LaneStep {
  std::uint32_t from{}, to{};
  double cost{};
  bool ahead{};
};

/// Steps sorted by `from`, one for each pair of places. Place i is lane i; one more is the destination, and behind it
/// come those of the start.
struct LaneGraph {
  std::vector<LaneStep> steps;
  std::vector<std::uint32_t> first;  ///< of each place's steps, and one more

  [[nodiscard]] std::size_t size() const { return first.size() - 1; }  ///< places
  [[nodiscard]] std::span<LaneStep const> from(std::uint32_t place) const {
    return {steps.data() + first[place], steps.data() + first[place + 1]};
  }
};

/// Seconds to drive `lane` at its speed limit, or at `default_speed` where there is none [m/s].
[[nodiscard]] inline double driving_time(Lane const& lane, double default_speed) {
  auto const& steps = lane.speed_limits;
  if (steps.empty()) return lane.length() / default_speed;
  double time = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    double const end = i + 1 < steps.size() ? steps[i + 1].begin : lane.length();
    time += std::max(0.0, end - steps[i].begin) / (std::isfinite(steps[i].limit) ? steps[i].limit : default_speed);
  }
  return time;
}

/// Throws `MapError` where an option is out of range.
inline void check_route_options(RouteOptions const& options) {
  if (!(options.lane_change_cost >= 0.0))
    throw MapError("route options", "lane_change_cost is negative or not a number", "give 0 or more");
  if (!(options.default_speed > 0.0) || !std::isfinite(options.default_speed))
    throw MapError("route options", "default_speed is not a positive number", "give it in m/s");
}

/// Cost of each whole lane. Throws `MapError` where one is negative or not a number.
[[nodiscard]] inline std::vector<double> lane_costs(std::span<Lane const> lanes, RouteOptions const& options) {
  check_route_options(options);
  std::vector<double> costs;
  costs.reserve(lanes.size());
  for (auto const& lane : lanes) {
    if (options.own_cost)
      costs.push_back(options.own_cost(lane));
    else
      costs.push_back(options.cost == RouteCost::time ? driving_time(lane, options.default_speed) : lane.length());
    if (!(costs.back() >= 0.0))
      throw MapError("route options",
                     "own_cost gives lane " + to_string(lane.id) + " a cost that is negative or not a number",
                     "give 0 or more");
  }
  return costs;
}

/// Builds the graph of one query.
///
/// The start has places of its own: one for each lane that its lane leads to by changes alone, ahead of it. What is
/// left of these lanes costs its share; nothing leads back into the places, but a route may come to the lanes again,
/// from their begin. Where the start is on its lane's begin it is the lane's place. The destination is a place of its
/// own; steps into its lane lead there.
class RouteGraphBuilder {
 public:
  static constexpr std::uint32_t no_place = std::numeric_limits<std::uint32_t>::max();

  /// There is no destination if `to` names no lane.
  RouteGraphBuilder(std::span<Lane const> lanes, LaneStation from, LaneStation to, RouteOptions const& options)
      : lanes_(lanes), options_(options), costs_(lane_costs(lanes, options)) {
    start_ = station(from, "start", from_share_);
    if (is_valid(to.lane)) goal_lane_ = station(to, "destination", to_share_);
    start_places_.assign(lanes.size(), no_place);
    if (from_share_ > 0.0) find_start_lanes();
  }

  [[nodiscard]] std::uint32_t start() const { return start_lanes_.empty() ? start_ : goal() + 1; }
  [[nodiscard]] std::uint32_t goal() const { return static_cast<std::uint32_t>(lanes_.size()); }
  [[nodiscard]] double from_share() const { return from_share_; }
  [[nodiscard]] double to_share() const { return to_share_; }
  [[nodiscard]] double cost(std::uint32_t lane) const { return costs_[lane]; }
  /// The lane of a place.
  [[nodiscard]] std::uint32_t lane_of(std::uint32_t place) const {
    if (place > goal()) return start_lanes_[place - goal() - 1];
    return place == goal() ? goal_lane_ : place;
  }
  /// The place of the start on a lane, `no_place` where there is none.
  [[nodiscard]] std::uint32_t start_place(std::uint32_t lane) const { return start_places_[lane]; }
  /// The destination lies ahead of the start on one lane.
  [[nodiscard]] bool is_ahead() const { return start_ == goal_lane_ && from_share_ <= to_share_; }

  [[nodiscard]] LaneGraph build() {
    for (std::uint32_t i = 0; i < lanes_.size(); ++i) add_steps(i);
    for (std::uint32_t i = 0; i < start_lanes_.size(); ++i) add_steps(goal() + 1 + i);
    return finished();
  }

 private:
  [[nodiscard]] std::uint32_t station(LaneStation const& at, char const* what, double& share) const {
    if (index_of(at.lane) >= lanes_.size())
      throw MapError("route", std::string("its ") + what + ", lane " + to_string(at.lane) + ", is not in the map",
                     "see Map::lanes for those it has");
    if (std::isnan(at.s)) throw MapError("route", std::string("the station of its ") + what + " is not a number");
    double const length = lanes_[index_of(at.lane)].length();
    share = std::clamp(at.s, 0.0, length) / length;
    return static_cast<std::uint32_t>(at.lane);
  }

  [[nodiscard]] bool may_go(Lane const& lane, LaneId to) const {
    return is_valid(to) && (!lane.drivable() || lanes_[index_of(to)].drivable());
  }

  /// Whether there is a place for a change between the shares `from` and `to` of the lane.
  [[nodiscard]] bool may_change(Lane const& lane, std::span<PathStretch const> changes, double from, double to) const {
    if (!options_.obey_lane_marks) return true;
    return std::any_of(changes.begin(), changes.end(), [&](PathStretch const& stretch) {
      return std::max(stretch.begin, from * lane.length()) <= std::min(stretch.end, to * lane.length());
    });
  }

  void find_start_lanes() {
    auto const add_lane = [&](std::uint32_t lane) {
      start_places_[lane] = goal() + 1 + static_cast<std::uint32_t>(start_lanes_.size());
      start_lanes_.push_back(lane);
    };
    add_lane(start_);
    for (std::size_t i = 0; i < start_lanes_.size(); ++i) {
      auto const& lane = lanes_[start_lanes_[i]];
      for (auto const& [side, changes] :
           {std::pair(lane.left_neighbor, &lane.left_changes), std::pair(lane.right_neighbor, &lane.right_changes)})
        if (may_go(lane, side) && start_places_[index_of(side)] == no_place &&
            may_change(lane, *changes, from_share_, 1.0))
          add_lane(static_cast<std::uint32_t>(side));
    }
  }

  void add(std::uint32_t from, std::uint32_t to, double cost, bool ahead) {
    if (std::isfinite(cost)) graph_.steps.push_back({from, to, cost, ahead});
  }

  void add_steps(std::uint32_t place) {
    auto const& lane = lanes_[lane_of(place)];
    double const begin = place > goal() ? from_share_ : 0.0;
    add_side(lane, place, begin, lane.left_neighbor, lane.left_changes);
    add_side(lane, place, begin, lane.right_neighbor, lane.right_changes);
    // Once more over the end of the start's lane leads nowhere that the start does not lead to at less.
    if (place == start_ && place != start()) return;
    for (auto const next : lane.successors) add_ahead(lane, place, begin, next);
  }

  void add_ahead(Lane const& lane, std::uint32_t from, double begin, LaneId next) {
    if (!may_go(lane, next)) return;
    auto const to = static_cast<std::uint32_t>(next);
    double const cost = (1.0 - begin) * costs_[index_of(lane.id)];
    if (to == goal_lane_)
      add(from, goal(), cost + to_share_ * costs_[to], true);
    else if (to != from)
      add(from, to, cost, true);
  }

  void add_side(Lane const& lane, std::uint32_t from, double begin, LaneId side, std::span<PathStretch const> changes) {
    if (!may_go(lane, side)) return;
    auto const to = static_cast<std::uint32_t>(side);
    if (to == goal_lane_ && begin <= to_share_ && may_change(lane, changes, begin, to_share_))
      add(from, goal(), options_.lane_change_cost + (to_share_ - begin) * costs_[to], false);
    else if (may_change(lane, changes, begin, 1.0) && std::isfinite(costs_[to]))
      add(from, from > goal() ? start_place(to) : to, options_.lane_change_cost, false);
  }

  [[nodiscard]] LaneGraph finished() {
    auto& steps = graph_.steps;
    cambium::detail::stable_sort(steps, [](LaneStep const& s) { return std::tuple(s.from, s.to, s.cost, s.ahead); });
    auto const same = [](LaneStep const& a, LaneStep const& b) { return a.from == b.from && a.to == b.to; };
    steps.erase(std::unique(steps.begin(), steps.end(), same), steps.end());
    for (std::uint32_t place = 0, i = 0; place <= goal() + start_lanes_.size(); ++place) {
      graph_.first.push_back(i);
      while (i < steps.size() && steps[i].from == place) ++i;
    }
    graph_.first.push_back(static_cast<std::uint32_t>(steps.size()));
    return std::move(graph_);
  }

  std::span<Lane const> lanes_;
  RouteOptions const& options_;
  std::vector<double> costs_;
  std::uint32_t start_{}, goal_lane_ = no_place;
  double from_share_{}, to_share_{};
  std::vector<std::uint32_t> start_lanes_;   // of the start's places; none where it is on its lane's begin
  std::vector<std::uint32_t> start_places_;  // of each lane
  LaneGraph graph_;
};

}  // namespace cambium::inline v0_1::map::detail
