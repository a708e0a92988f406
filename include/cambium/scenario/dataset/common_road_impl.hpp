#pragma once

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pugixml.hpp>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/map/opendrive/xml.hpp"
#include "cambium/scenario/dataset/common_road.hpp"
#include "cambium/scenario/dataset/detail/common_road_lanes.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// The words of obstacle types and the types that they become; of several words for one type the first is written.
inline constexpr std::pair<std::string_view, TrackType> common_road_types[] = {{"car", TrackType::car},
                                                                               {"truck", TrackType::truck},
                                                                               {"bus", TrackType::bus},
                                                                               {"bicycle", TrackType::bicycle},
                                                                               {"pedestrian", TrackType::pedestrian},
                                                                               {"motorcycle", TrackType::motorcycle},
                                                                               {"unknown", TrackType::other},
                                                                               {"taxi", TrackType::car},
                                                                               {"priorityVehicle", TrackType::car},
                                                                               {"parkedVehicle", TrackType::car}};

/// Reads a CommonRoad scenario, see `parse_common_road`.
class CommonRoadReader : private CommonRoadLanes {
 public:
  CommonRoadReader(std::string_view text, std::string const& file) : CommonRoadLanes(text, file) {}

  [[nodiscard]] RecordedTraffic read(pugi::xml_node root, map::MapOptions const& options) {
    read_head(root);
    read_lanes(root, options);
    xml::for_each_child(root, [&](pugi::xml_node node, std::string_view name) { read_other(node, name); });
    detail::stable_sort(traffic_.tracks, [](Track const& track) { return !track.stands; });
    check_recorded_traffic(traffic_);
    return std::move(traffic_);
  }

 private:
  void read_head(Node root) {
    traffic_.name = root.attribute("benchmarkID").value();
    std::string_view const version = root.attribute("commonRoadVersion").value();
    if (version != "2018b" && version != "2020a")
      warn(root, version.empty() ? "there is no commonRoadVersion; the file was read as one of 2020a"
                                 : "version " + std::string(version) + " is unknown; it was read as one of 2020a");
    auto const step = xml::parse_number<double>(root.attribute("timeStepSize").value());
    if (!step || !(*step > 0.0 && *step <= 3600.0))
      throw Error(place(root), "timeStepSize is missing, or no number of seconds above 0",
                  "give the attribute timeStepSize, such as \"0.1\"");
    traffic_.time_step = *step;
  }

  void read_other(Node node, std::string_view name) {
    constexpr std::string_view known[] = {"lanelet",  "intersection", "trafficSign", "trafficLight",
                                          "location", "scenarioTags", "tags"};
    if (name == "obstacle")
      read_obstacle(node, text_of(xml::find_child(node, "role")) == "static");
    else if (name == "staticObstacle" || name == "dynamicObstacle")
      read_obstacle(node, name == "staticObstacle");
    else if (name == "environmentObstacle")
      read_environment(node);
    else if (name == "planningProblem")
      read_problem(node);
    else if (std::find(std::begin(known), std::end(known), name) == std::end(known))
      note_once(node, "elements <" + std::string(name) + "> are not read");
  }

  void read_obstacle(Node node, bool stands) {
    auto const id = id_of(node);
    if (!id) return;
    auto const name = "obstacle " + std::to_string(*id);
    Track track{.id = *id, .type = type_of(xml::find_child(node, "type")), .stands = stands};
    xml::for_each_child(node, [&](Node child, std::string_view part) {
      constexpr std::string_view read[] = {"role", "type", "shape", "initialState", "trajectory", "occupancySet"};
      if (std::find(std::begin(read), std::end(read), part) == std::end(read))
        note_once(child, "elements <" + std::string(part) + "> of obstacles are not read");
    });
    auto const shape = shape_of(xml::find_child(node, "shape"));
    auto const initial = state_of(xml::find_child(node, "initialState"), 0.0);
    if (!shape || !initial)
      return warn(node, name + " has no shape, or no state with position and time; it was left out");
    track.length = shape->length;
    track.width = shape->width;
    if (!is_body(*shape)) return warn(node, name + " is not up to 100 m long and wide; it was left out");
    track.states.push_back(*initial);
    if (!stands) read_trajectory(node, track);
    for (auto& state : track.states) shift(state, *shape);
    if (!stands) read_occupancies(node, track);
    if (!stands && track.states.size() == 1) note(node, name + " has no motion; it is there for one instant");
    if (!shape->is_rectangle) track.outline = outline_from_middle(node, *shape);
    if (!stands && !track.outline.empty()) note(node, name + " drives as the rectangle around it");
    if (!ids_.insert(*id).second) return warn(node, name + " is there already; the second one was left out");
    traffic_.tracks.push_back(std::move(track));
  }

  [[nodiscard]] TrackType type_of(Node node) {
    if (!node) return TrackType::other;
    for (auto const& [word, type] : common_road_types)
      if (word == text_of(node)) return type;
    note_once(node, "obstacles of the type \"" + std::string(text_of(node)) + "\" count as others");
    return TrackType::other;
  }

  /// The corners of a polygon or circle, whose own heading is 0; none, with a finding, where they are no outline.
  [[nodiscard]] std::vector<geometry::Point> outline_from_middle(Node node, CommonRoadShape const& shape) {
    auto outline = shape.outline;
    for (auto& corner : outline) corner -= shape.center;
    try {
      geometry::Polygon const usable(outline);
    } catch (Error const& problem) {
      warn(node, std::string(problem.what()) + "; its rectangle was taken");
      outline.clear();
    }
    return outline;
  }

  [[nodiscard]] static bool is_body(CommonRoadShape const& shape) {
    return shape.length > 1e-3 && shape.width > 1e-3 && shape.length <= 100.0 && shape.width <= 100.0;
  }

  /// From the origin of the obstacle's frame to the middle of its shape.
  static void shift(State& state, CommonRoadShape const& shape) {
    if (shape.center != geometry::Point{}) {
      double const c = portable::cos(state.heading), s = portable::sin(state.heading);
      state.x += c * shape.center.x() - s * shape.center.y();
      state.y += s * shape.center.x() + c * shape.center.y();
    }
    if (shape.heading != 0.0) state.heading += shape.heading;
  }

  void add_state(Node at, Track& track, std::optional<State> const& state) {
    auto const name = "a state of obstacle " + std::to_string(track.id);
    if (!state)
      warn(at, name + " has no position or time; it was left out");
    else if (!(state->time > track.states.back().time))
      warn(at, name + " is not later than the one before; it was left out");
    else
      track.states.push_back(*state);
  }

  void read_trajectory(Node node, Track& track) {
    xml::for_each_child(xml::find_child(node, "trajectory"), "state",
                        [&](Node child) { add_state(child, track, state_of(child, track.states.back().heading)); });
  }

  /// Shapes in the map's frame, unlike those of trajectories; other shapes than rectangles head where they move.
  void read_occupancies(Node node, Track& track) {
    auto const set = xml::find_child(node, "occupancySet");
    if (set) note(set, "the occupancies of obstacle " + std::to_string(track.id) + " became places: their middles");
    xml::for_each_child(set, "occupancy", [&](Node child) {
      auto const shape = shape_of(xml::find_child(child, "shape"));
      auto const step = value(child, "time");
      if (step && *step * traffic_.time_step <= track.states.front().time) return;  // the initial state again
      if (!shape || !step) return add_state(child, track, std::nullopt);
      State state = track.states.back();
      double const passed = *step * traffic_.time_step - state.time;
      geometry::Point const way = shape->center - geometry::Point{state.x, state.y};
      if (shape->is_rectangle)
        state.heading = shape->heading;
      else if (way.norm() > 0.1)
        state.heading = portable::atan2(way.y(), way.x());
      state = {*step * traffic_.time_step, shape->center.x(), shape->center.y(), state.heading,
               passed > 0.0 ? way.norm() / passed : 0.0};
      add_state(child, track, state);
    });
  }

  /// Buildings and the like: an obstacle that stands, about its middle.
  void read_environment(Node node) {
    auto const id = id_of(node);
    auto const shape = shape_of(xml::find_child(node, "shape"));
    if (!id) return;
    if (!shape || !is_body(*shape) || !ids_.insert(*id).second)
      return warn(node, "obstacle " + std::to_string(*id) + " has no shape of up to 100 m; it was left out");
    traffic_.tracks.push_back({.id = *id,
                               .type = TrackType::other,
                               .length = shape->length,
                               .width = shape->width,
                               .stands = true,
                               .states = {State{0.0, shape->center.x(), shape->center.y(), shape->heading, 0.0}}});
    if (!shape->is_rectangle) traffic_.tracks.back().outline = outline_from_middle(node, *shape);
  }

  void read_problem(Node node) {
    auto const id = id_of(node);
    if (!id) return;
    auto const initial = state_of(xml::find_child(node, "initialState"), 0.0);
    if (!initial)
      return warn(node, "planning problem " + std::to_string(*id) + " has no initial state; it was left out");
    PlanningProblem problem{.id = *id, .initial = *initial};
    xml::for_each_child(node, "goalState", [&](Node child) {
      if (auto goal = goal_of(child)) problem.goals.push_back(std::move(*goal));
    });
    if (!problem_ids_.insert(*id).second)
      return warn(node, "planning problem " + std::to_string(*id) + " is there already; the second one was left out");
    if (problem.goals.empty()) warn(node, "planning problem " + std::to_string(*id) + " has no goal");
    traffic_.problems.push_back(std::move(problem));
  }

  [[nodiscard]] std::optional<GoalState> goal_of(Node node) {
    GoalState goal;
    if (auto const time = interval(node, "time")) {
      if (time->begin > time->end) {
        warn(node, "its time ends before it begins; the goal was left out");
        return std::nullopt;
      }
      goal.first_time = time->begin * traffic_.time_step;
      goal.last_time = time->end * traffic_.time_step;
    } else {
      warn(node, "the goal has no time; it counts at any time");
    }
    if (auto const angle = interval(node, "orientation")) {
      goal.limits.heading_from = angle->begin;
      goal.limits.heading_to = angle->end;
    }
    if (auto const speed = interval(node, "velocity")) {
      goal.limits.lowest_speed = speed->begin;
      goal.limits.highest_speed = speed->end;
    }
    try {
      check_parameters(goal.limits, "goal");
    } catch (Error const& problem) {
      warn(node, std::string(problem.what()) + "; the goal was left out");
      return std::nullopt;
    }
    auto const area = xml::find_child(node, "position");
    xml::for_each_child(area, [&](Node child, std::string_view name) { add_area(child, name, goal); });
    if (area && goal.areas.empty()) {
      warn(area, "no area of the goal's position is usable; the goal was left out");
      return std::nullopt;
    }
    return goal;
  }

  void add_area(Node node, std::string_view name, GoalState& goal) {
    std::vector<geometry::Point> outline;
    if (name == "lanelet") {
      auto const ref = reference(node);
      auto const at = std::find_if(traffic_.lanelets.begin(), traffic_.lanelets.end(),
                                   [&](map::Lanelet const& lanelet) { return ref && lanelet.id == *ref; });
      if (at == traffic_.lanelets.end()) return warn(node, "that lanelet is not there");
      outline = at->right;
      outline.insert(outline.end(), at->left.rbegin(), at->left.rend());
    } else if (name == "rectangle" || name == "circle" || name == "polygon") {
      auto const shape = name == "rectangle" ? rectangle(node) : name == "circle" ? circle(node) : polygon(node);
      if (!shape) return;
      outline = shape->outline;
    } else if (name == "point") {
      return warn(node, "a single point as a goal is never met; it was left out");
    } else {
      return;
    }
    try {
      goal.areas.emplace_back(outline);
    } catch (Error const& problem) {
      warn(node, problem.what());
    }
  }

  std::set<Id> ids_, problem_ids_;  ///< of the obstacles, and of the planning problems
};

}  // namespace detail

CAMBIUM_COLD RecordedTraffic parse_common_road(std::string_view text, map::MapOptions const& options,
                                               std::string const& file) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  pugi::xml_document document;
  auto const root = map::xml::parse_root(document, text, file, "commonRoad", "give a CommonRoad scenario (.xml)");
  return detail::CommonRoadReader(text, file).read(root, options);
}

CAMBIUM_COLD RecordedTraffic load_common_road(std::string const& path, map::MapOptions const& options) {
  return parse_common_road(map::xml::read_map_file(path, "give a CommonRoad scenario (.xml)"), options, path);
}

}  // namespace cambium::inline v0_1
