#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/building/polyline_roads.hpp"
#include "cambium/map/building/road_plan.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/lanelet/detail/lanelet_bounds.hpp"
#include "cambium/map/lanelet/detail/lanelet_groups.hpp"
#include "cambium/map/lanelet/lanelet_map.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::map {

namespace detail {

/// Makes roads of groups of lanelets, and a map of these.
class LaneletMapMaker {
 public:
  LaneletMapMaker(std::vector<Lanelet> lanelets, std::string const& file, std::vector<Diagnostic>& diagnostics)
      : findings_{file, diagnostics}, groups_(std::move(lanelets), findings_), builder_(file) {}

  [[nodiscard]] LaneletMap make(MapOptions const& options) {
    places_.resize(groups_.lanelets.size());
    for (auto const& group : groups_.groups) add_group(group);
    connect();
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (places_[i]) finish_lane(i, *places_[i]);
    for (auto& [name, controls] : lights_) {
      opendrive::Controller controller;
      controller.id = name;
      controller.controls = std::move(controls);
      builder_.document().controllers.push_back(std::move(controller));
    }
    if (builder_.document().roads.empty())
      throw MapError(findings_.file, "no lanelet is left to make a map of" + likely_cause_here(),
                     "give lanelets with a left and a right bound");
    LaneletMap result;
    result.map = builder_.build(options, &findings_.list);
    std::map<std::pair<std::string, int>, LaneId> lanes;
    for (auto const& lane : result.map->lanes())
      lanes.try_emplace({result.map->road(lane.road).name, lane.number}, lane.id);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (!places_[i]) continue;
      auto const at = lanes.find({places_[i]->road, places_[i]->lane});
      if (at != lanes.end()) result.lanes.emplace(groups_.lanelets[i].id, at->second);
    }
    return result;
  }

 private:
  /// The lane that a lanelet has become.
  struct Place {
    std::string road;
    int lane = 0;
  };

  [[nodiscard]] std::string likely_cause_here() const {
    for (auto const& finding : findings_.list)
      if (finding.sentence.find("left out") != std::string::npos) return " (" + to_string(finding) + ")";
    return {};
  }

  void add_group(LaneletGroup const& group) {
    auto const& of = group.lanelets;
    if (of.size() == 1) return add_road(single(of.front()), of, group.junction);
    try {
      std::vector<std::vector<Point>> borders{evened(groups_.lanelets[of.front()].left)};
      for (auto const i : of) borders.push_back(evened(groups_.lanelets[i].right));
      auto plan = lanes_between(borders);
      check_ends(plan, of);
      return add_road(std::move(plan), of, group.junction);
    } catch (MapError const& problem) {
      groups_.report(Severity::warning, of.front(),
                     "it and its neighbours cannot be one road (" + std::string(problem.what()) +
                         "); each becomes a road of its own, and nobody changes lanes between them");
    }
    for (auto const i : of) add_road(single(i), {i}, group.junction);
  }

  /// Throws `MapError` where a lane of the road does not begin and end where its lanelet does: a road ends square to
  /// its leftmost border.
  void check_ends(RoadPlan const& plan, std::vector<std::size_t> const& of) const {
    constexpr double farthest = 0.3;  // [m]
    MapBuilder trial;
    RoadPlan copy = plan;
    auto const id = trial.add_road(std::move(copy));
    for (std::size_t k = 0; k < of.size(); ++k)
      for (bool const at_end : {false, true}) {
        auto const end = at_end ? opendrive::ContactPoint::end : opendrive::ContactPoint::start;
        auto const is = trial.lane_pose({id, end}, -static_cast<int>(k) - 1);
        auto const wanted = end_pose(groups_.centers[of[k]], at_end);
        if ((is.position() - wanted.position()).norm() > farthest)
          throw MapError("lanelet " + std::to_string(groups_.lanelets[of[k]].id),
                         at_end ? "it ends aslant" : "it begins aslant");
      }
  }

  [[nodiscard]] RoadPlan single(std::size_t lanelet) {
    try {
      auto const& center = groups_.centers[lanelet];
      return lane_along(center.points, center.widths);
    } catch (MapError const& problem) {
      groups_.report(Severity::warning, lanelet, std::string(problem.what()) + "; the lanelet was left out");
      return {};
    }
  }

  void add_road(RoadPlan plan, std::vector<std::size_t> const& of, std::size_t junction) {
    if (plan.line.empty()) return;  // left out
    plan.id = std::to_string(groups_.lanelets[of.front()].id);
    auto& lanes = plan.sections.front().right;
    plan.sections.front().middle_mark = make_mark("solid", opendrive::LaneChangePermission::none);
    for (std::size_t k = 0; k < of.size(); ++k) {
      auto const& lanelet = groups_.lanelets[of[k]];
      lanes[k].type = lanelet.type;
      lanes[k].speed_limit = lanelet.speed_limit;
      if (k + 1 < of.size()) lanes[k].mark = mark_between(lanelet, groups_.lanelets[of[k + 1]]);
    }
    if (junction != LaneletGroup::no_junction) {
      auto const [at, is_new] = junctions_.try_emplace(junction);
      if (is_new) at->second = builder_.add_junction("junction " + plan.id);
      plan.junction = at->second;
    }
    try {
      auto const id = builder_.add_road(std::move(plan));
      for (std::size_t k = 0; k < of.size(); ++k) places_[of[k]] = Place{id, -static_cast<int>(k) - 1};
    } catch (MapError const& problem) {
      for (auto const i : of)
        groups_.report(Severity::warning, i, std::string(problem.what()) + "; the lanelet was left out");
    }
  }

  [[nodiscard]] static opendrive::RoadMark mark_between(Lanelet const& left, Lanelet const& right) {
    using opendrive::LaneChangePermission;
    bool const to_right = left.may_change_right, to_left = right.may_change_left;
    if (to_right && to_left) return make_mark("broken", LaneChangePermission::both);
    if (to_right) return make_mark("solid broken", LaneChangePermission::decrease);
    if (to_left) return make_mark("broken solid", LaneChangePermission::increase);
    return make_mark("solid", LaneChangePermission::none);
  }

  /// Connects roads; all links between two of them at once.
  void connect() {
    using Ends = std::pair<std::string, std::string>;
    std::vector<std::pair<Ends, std::vector<opendrive::LaneLink>>> connections;
    std::map<Ends, std::size_t> known;
    std::map<Ends, std::size_t> lanelet_of;
    for (auto const& [from, to] : groups_.links) {
      if (!places_[from] || !places_[to]) continue;
      Ends const ends{places_[from]->road, places_[to]->road};
      auto const [at, is_new] = known.try_emplace(ends, connections.size());
      if (is_new) connections.push_back({ends, {}});
      lanelet_of.try_emplace(ends, from);
      connections[at->second].second.push_back({places_[from]->lane, places_[to]->lane});
    }
    for (auto const& [ends, lanes] : connections) {
      try {
        builder_.connect({ends.first, opendrive::ContactPoint::end}, {ends.second, opendrive::ContactPoint::start},
                         lanes);
      } catch (MapError const& problem) {
        groups_.report(Severity::warning, lanelet_of[ends],
                       "what follows it cannot be linked (" + std::string(problem.what()) + "); it was left out");
      }
    }
  }

  /// Signs, lights and the direction of a lane.
  void finish_lane(std::size_t i, Place const& place) {
    auto const& lanelet = groups_.lanelets[i];
    if (lanelet.signals.empty() && !lanelet.both_directions) return;
    auto& road = builder_.road(place.road);
    if (lanelet.both_directions)
      for (auto& lane : road.lane_sections.front().lanes)
        if (lane.id == place.lane) lane.direction = opendrive::LaneDirection::both;
    for (auto const& signal : lanelet.signals) {
      constexpr char const* types[] = {"301", "205", "206", "1000001"};  // by kind, see `kind_of`
      opendrive::Signal written;
      written.id = place.road + "." + std::to_string(-place.lane) + "." + std::to_string(road.signals.size());
      written.s = std::clamp(road.geometry_length() - signal.before_end, 0.0, road.geometry_length());
      written.orientation = opendrive::Orientation::along;
      written.type = types[static_cast<std::size_t>(signal.kind)];
      written.validities = {{place.lane, place.lane}};
      if (signal.kind == SignalKind::light) lights_[signal.light].push_back({written.id});
      road.signals.push_back(std::move(written));
    }
  }

  Findings findings_;
  LaneletGroups groups_;
  MapBuilder builder_;
  std::vector<std::optional<Place>> places_;      ///< of each lanelet
  std::map<std::size_t, std::string> junctions_;  ///< by `LaneletGroup::junction`
  std::map<std::string, std::vector<opendrive::Control>> lights_;
};

}  // namespace detail

CAMBIUM_COLD LaneletMap build_lanelet_map(std::vector<Lanelet> lanelets, MapOptions const& options,
                                          std::string const& file) {
  std::vector<Diagnostic> diagnostics;
  auto result = detail::LaneletMapMaker(std::move(lanelets), file, diagnostics).make(options);
  result.diagnostics = std::move(diagnostics);
  return result;
}

CAMBIUM_COLD std::vector<Lanelet> lanelets_of(Map const& map, std::int64_t first_id) {
  std::vector<Lanelet> result;
  auto const id_of = [first_id](LaneId lane) { return first_id + static_cast<std::int64_t>(index_of(lane)); };
  auto const is_kept = [&map](LaneId id) {
    return is_valid(id) && map.lane(id).drivable() && !map.lane(id).left.empty() && !map.lane(id).right.empty();
  };
  for (auto const& lane : map.lanes()) {
    if (!is_kept(lane.id)) continue;
    Lanelet lanelet{.id = id_of(lane.id), .left = lane.left.points(), .right = lane.right.points()};
    for (auto const other : lane.successors)
      if (is_kept(other)) lanelet.successors.push_back(id_of(other));
    for (auto const other : lane.predecessors)
      if (is_kept(other)) lanelet.predecessors.push_back(id_of(other));
    if (is_kept(lane.left_neighbor)) lanelet.left_neighbor = id_of(lane.left_neighbor);
    if (is_kept(lane.right_neighbor)) lanelet.right_neighbor = id_of(lane.right_neighbor);
    lanelet.may_change_left = !is_valid(lane.left_neighbor) || !lane.left_changes.empty();
    lanelet.may_change_right = !is_valid(lane.right_neighbor) || !lane.right_changes.empty();
    lanelet.type = lane.type;
    if (double const limit = lane.speed_limit_at(0.5 * lane.length()); std::isfinite(limit))
      lanelet.speed_limit = limit;
    lanelet.in_junction = is_valid(map.road(lane.road).junction);
    for (auto const& signal : lane.signals)
      lanelet.signals.push_back({signal.kind, lane.length() - signal.s,
                                 is_valid(signal.light) ? map.lights()[index_of(signal.light)].name : ""});
    result.push_back(std::move(lanelet));
  }
  return result;
}

}  // namespace cambium::map
