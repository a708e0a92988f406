#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
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
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/map/opendrive/xml.hpp"
#include "cambium/scenario/dataset/common_road.hpp"

namespace cambium {

namespace detail {

namespace xml = map::xml;

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

/// The words of lanelet types that are more than "driving".
inline constexpr std::pair<std::string_view, map::LaneType> common_road_lane_types[] = {
    {"shoulder", map::LaneType::shoulder},  {"sidewalk", map::LaneType::sidewalk},
    {"busLane", map::LaneType::bus},        {"bicycleLane", map::LaneType::biking},
    {"accessRamp", map::LaneType::on_ramp}, {"exitRamp", map::LaneType::off_ramp},
    {"crosswalk", map::LaneType::walking}};

/// The parts of an OpenDRIVE-like catalogue of signs that matter, by country or without one.
[[nodiscard]] inline std::optional<map::SignalKind> common_road_sign(std::string_view id) {
  if (id == "205" || id == "R1-2") return map::SignalKind::give_way;
  if (id == "206" || id == "R1-1") return map::SignalKind::stop;
  if (id == "301" || id == "306") return map::SignalKind::priority;
  return std::nullopt;
}

/// A shape: the rectangle around it, with its own middle and heading.
struct CommonRoadShape {
  geometry::Point center{};
  double heading = 0.0, length = 0.0, width = 0.0;
  std::vector<geometry::Point> outline{};
};

/// Reads a CommonRoad scenario, see `parse_common_road`.
class CommonRoadReader {
 public:
  CommonRoadReader(std::string_view text, std::string const& file) : context_(text, file, traffic_.diagnostics) {}

  [[nodiscard]] RecordedTraffic read(pugi::xml_node root, map::MapOptions const& options) {
    read_head(root);
    xml::for_each_child(root, [&](pugi::xml_node node, std::string_view name) { read_rule(node, name); });
    xml::for_each_child(root, "lanelet", [&](pugi::xml_node node) { read_lanelet(node); });
    xml::for_each_child(root, "intersection", [&](pugi::xml_node node) { read_intersection(node); });
    xml::for_each_child(root, [&](pugi::xml_node node, std::string_view name) { read_other(node, name); });
    std::stable_partition(traffic_.tracks.begin(), traffic_.tracks.end(),
                          [](Track const& track) { return track.stands; });
    if (!traffic_.lanelets.empty()) make_map(options);
    check_recorded_traffic(traffic_);
    return std::move(traffic_);
  }

 private:
  using Node = pugi::xml_node;
  using Id = std::int64_t;

  struct Interval {
    double begin{}, end{};
    [[nodiscard]] double middle() const { return begin == end ? begin : 0.5 * (begin + end); }
  };

  void warn(Node node, std::string sentence) { context_.report(Severity::warning, node, std::move(sentence)); }
  void note(Node node, std::string sentence) { context_.report(Severity::info, node, std::move(sentence)); }

  [[nodiscard]] static std::string_view text_of(Node node) { return xml::trimmed(node.child_value()); }

  /// The number in a child element; nothing, with a finding, where it is missing or none.
  [[nodiscard]] std::optional<double> number(Node node, char const* name) {
    auto const child = xml::find_child(node, name);
    if (!child) {
      warn(node, std::string("it has no <") + name + ">");
      return std::nullopt;
    }
    auto const value = xml::parse_number<double>(text_of(child));
    if (!value || std::abs(*value) > 1e15) {
      warn(child, "\"" + std::string(text_of(child)) + "\" is no usable number");
      return std::nullopt;
    }
    return value;
  }

  [[nodiscard]] std::optional<geometry::Point> point(Node node) {
    auto const x = number(node, "x"), y = number(node, "y");
    if (!x || !y) return std::nullopt;
    return geometry::Point{*x, *y};
  }

  /// <exact>, or <intervalStart> and <intervalEnd>, of the child of that name; nothing where there is no such child.
  [[nodiscard]] std::optional<Interval> interval(Node node, char const* name) {
    auto const child = xml::find_child(node, name);
    if (!child) return std::nullopt;
    if (xml::find_child(child, "exact")) {
      auto const value = number(child, "exact");
      return value ? std::optional(Interval{*value, *value}) : std::nullopt;
    }
    auto const begin = number(child, "intervalStart"), end = number(child, "intervalEnd");
    if (!begin || !end) return std::nullopt;
    return Interval{*begin, *end};
  }
  /// One value of such an interval.
  [[nodiscard]] std::optional<double> value(Node node, char const* name) {
    auto const found = interval(node, name);
    if (!found) return std::nullopt;
    if (found->begin != found->end)
      note(xml::find_child(node, name), std::string(name) + " is an interval; its middle was taken");
    return found->middle();
  }

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

  [[nodiscard]] std::string place(Node node) { return context_.file() + ":" + std::to_string(context_.line(node)); }

  [[nodiscard]] std::optional<Id> id_of(Node node) {
    auto const id = context_.number<Id>(node, "id");
    if (!id) warn(node, "it was left out");
    return id;
  }

  // --- signs and lights ----------------------------------------------------------------------------------------------

  struct Sign {
    std::optional<map::SignalKind> kind{};
    std::optional<double> speed{};  ///< limit [m/s]
  };

  void read_rule(Node node, std::string_view name) {
    if (name == "trafficSign") read_sign(node);
    if (name == "trafficLight") read_light(node);
  }

  void read_sign(Node node) {
    auto const id = id_of(node);
    if (!id) return;
    Sign sign;
    xml::for_each_child(node, "trafficSignElement", [&](Node element) {
      auto const word = text_of(xml::find_child(element, "trafficSignID"));
      if (auto const kind = common_road_sign(word)) sign.kind = kind;
      bool const is_limit = word == "274" || word == "R2-1";
      if (!is_limit) return;
      auto const limit = number(element, "additionalValue");
      if (limit && *limit > 0.0 && *limit < 300.0) sign.speed = limit;
    });
    signs_.emplace(*id, sign);
  }

  /// The phases of a light: from the end of the red one. Several greens become the first.
  void read_light(Node node) {
    auto const id = id_of(node);
    if (!id) return;
    map::LightPlan plan;
    double offset = 0.0, at = 0.0, yellow = 0.0;
    std::optional<Interval> green;
    auto cycle = xml::find_child(node, "cycle");
    xml::for_each_child(cycle, [&](Node element, std::string_view name) {
      if (name == "timeOffset") offset = xml::parse_number<double>(text_of(element)).value_or(0.0);
      if (name != "cycleElement") return;
      auto const steps = number(element, "duration");
      if (!steps || !(*steps >= 0.0 && *steps <= 1e6)) return;
      double const lasts = *steps * traffic_.time_step;
      auto const color = text_of(xml::find_child(element, "color"));
      if (color == "green" && green) note(element, "a second green phase was left out");
      if (color == "green" && !green) green = Interval{at, at + lasts};
      if (color == "yellow" && green && at == green->end) yellow = lasts;
      at += lasts;
    });
    if (text_of(xml::find_child(node, "active")) != "false" && at > 0.0 && green) {
      plan = {.cycle = at, .green_begin = green->begin, .green_end = green->end, .yellow = yellow};
      plan.green_begin += offset * traffic_.time_step;
      plan.green_end += offset * traffic_.time_step;
    }
    if (!plan.is_possible()) {
      warn(node, "its cycle is impossible; the light is off");
      plan = {};
    }
    lights_.emplace(*id, plan);
  }

  // --- lanelets ------------------------------------------------------------------------------------------------------

  [[nodiscard]] std::optional<Id> reference(Node node) {
    auto const ref = context_.number<Id>(node, "ref");
    return ref;
  }

  void read_lanelet(Node node) {
    auto const id = id_of(node);
    if (!id) return;
    map::Lanelet lanelet{.id = *id};
    lanelet.line = context_.line(node);
    bool good = true;
    for (bool const is_left : {true, false}) {
      auto const bound = xml::find_child(node, is_left ? "leftBound" : "rightBound");
      auto& points = is_left ? lanelet.left : lanelet.right;
      xml::for_each_child(bound, "point", [&](Node child) {
        auto const p = point(child);
        good = good && p;
        if (p) points.push_back(*p);
      });
      auto const marking = text_of(xml::find_child(bound, "lineMarking"));
      (is_left ? lanelet.may_change_left : lanelet.may_change_right) =
          marking != "solid" && marking != "broad_solid" && marking != "curb";
    }
    if (!good) return warn(node, "lanelet " + std::to_string(*id) + " was left out, see the previous finding");
    xml::for_each_child(node, [&](Node child, std::string_view name) { read_lanelet_part(child, name, lanelet); });
    if (auto const line = xml::find_child(node, "stopLine")) read_stop_line(line, lanelet);
    traffic_.lanelets.push_back(std::move(lanelet));
  }

  void read_lanelet_part(Node node, std::string_view name, map::Lanelet& lanelet) {
    if (name == "predecessor" || name == "successor") {
      auto& list = name == "successor" ? lanelet.successors : lanelet.predecessors;
      if (auto const ref = reference(node)) list.push_back(*ref);
    } else if (name == "adjacentLeft" || name == "adjacentRight") {
      auto const ref = reference(node);
      if (!ref || std::string_view(node.attribute("drivingDir").value()) == "opposite") return;
      (name == "adjacentLeft" ? lanelet.left_neighbor : lanelet.right_neighbor) = *ref;
    } else if (name == "laneletType") {
      for (auto const& [word, type] : common_road_lane_types)
        if (word == text_of(node)) lanelet.type = type;
      lanelet.in_junction = lanelet.in_junction || text_of(node) == "intersection";
    } else if (name == "speedLimit") {
      auto const limit = xml::parse_number<double>(text_of(node));
      if (limit && *limit > 0.0 && *limit < 1000.0) lanelet.speed_limit = limit;
    } else if (name == "userBidirectional") {
      lanelet.both_directions = lanelet.both_directions || text_of(node) == "vehicle" || text_of(node) == "car";
    } else if (name == "trafficSignRef" || name == "trafficLightRef") {
      if (auto const ref = reference(node)) add_signal(node, *ref, 0.0, lanelet);
    }
  }

  /// Signs that the lanelet has stand at its stop line, where it has one.
  void read_stop_line(Node node, map::Lanelet& lanelet) {
    std::vector<geometry::Point> ends;
    xml::for_each_child(node, "point", [&](Node child) {
      if (auto const p = point(child)) ends.push_back(*p);
    });
    double before = 0.0;
    if (ends.size() == 2 && !lanelet.left.empty() && !lanelet.right.empty())
      before = (0.5 * (ends[0] + ends[1]) - 0.5 * (lanelet.left.back() + lanelet.right.back())).norm();
    if (!(before >= 0.0 && before <= 1000.0)) before = 0.0;
    xml::for_each_child(node, [&](Node child, std::string_view name) {
      if (name != "trafficSignRef" && name != "trafficLightRef") return;
      if (auto const ref = reference(child)) add_signal(child, *ref, before, lanelet);
    });
    for (auto& signal : lanelet.signals) signal.before_end = before;
  }

  void add_signal(Node node, Id ref, double before, map::Lanelet& lanelet) {
    if (auto const sign = signs_.find(ref); sign != signs_.end()) {
      if (sign->second.speed) lanelet.speed_limit = sign->second.speed;
      if (sign->second.kind) add_once(lanelet, {*sign->second.kind, before, {}});
    } else if (lights_.contains(ref)) {
      add_once(lanelet, {map::SignalKind::light, before, std::to_string(ref)});
    } else {
      warn(node, "sign or light " + std::to_string(ref) + " is not there");
    }
  }
  static void add_once(map::Lanelet& lanelet, map::LaneletSignal const& signal) {
    for (auto const& known : lanelet.signals)
      if (known.kind == signal.kind && known.light == signal.light) return;
    lanelet.signals.push_back(signal);
  }

  /// The ways through an intersection lie in it.
  void read_intersection(Node node) {
    std::set<Id> inside;
    xml::for_each_child(node, "incoming", [&](Node incoming) {
      xml::for_each_child(incoming, [&](Node child, std::string_view name) {
        if (!name.starts_with("successors")) return;
        if (auto const ref = reference(child)) inside.insert(*ref);
      });
    });
    for (auto& lanelet : traffic_.lanelets)
      if (inside.contains(lanelet.id)) lanelet.in_junction = true;
  }

  void make_map(map::MapOptions const& options) {
    auto made = map::build_lanelet_map(traffic_.lanelets, options, context_.file());
    for (auto& found : made.diagnostics) traffic_.diagnostics.push_back(std::move(found));
    traffic_.map = std::move(made.map);
    traffic_.lanes = std::move(made.lanes);
    for (auto const& light : traffic_.map->lights()) {
      auto const id = xml::parse_number<Id>(light.name);
      auto const plan = id ? lights_.find(*id) : lights_.end();
      traffic_.lights.push_back(plan == lights_.end() ? map::LightPlan{} : plan->second);
    }
  }

  // --- obstacles -----------------------------------------------------------------------------------------------------

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
    else if (std::find(std::begin(known), std::end(known), name) == std::end(known) &&
             unknown_.insert(std::string(name)).second)
      note(node, "elements of this kind are not read");
  }

  /// The first shape of <shape>, <occupancy> or <position>; in the frame of what it belongs to.
  [[nodiscard]] std::optional<CommonRoadShape> shape_of(Node parent) {
    if (!parent) return std::nullopt;
    std::optional<CommonRoadShape> found;
    bool second = false;
    xml::for_each_child(parent, [&](Node node, std::string_view name) {
      if (name != "rectangle" && name != "circle" && name != "polygon") return;
      if (found)
        second = true;
      else
        found = name == "rectangle" ? rectangle(node) : name == "circle" ? circle(node) : polygon(node);
    });
    if (second) note(parent, "it has several shapes; the first one was taken");
    return found;
  }

  [[nodiscard]] geometry::Point center(Node node) {
    auto const child = xml::find_child(node, "center");
    return child ? point(child).value_or(geometry::Point{}) : geometry::Point{};
  }

  /// To a nanometre: cosines of right angles are not 0.
  [[nodiscard]] static geometry::Point rounded(geometry::Point const& p) {
    return {std::round(p.x() * 1e9) / 1e9, std::round(p.y() * 1e9) / 1e9};
  }

  [[nodiscard]] std::optional<CommonRoadShape> rectangle(Node node) {
    auto const length = number(node, "length"), width = number(node, "width");
    if (!length || !width || !(*length > 0.0 && *width > 0.0)) return std::nullopt;
    CommonRoadShape shape{center(node), 0.0, *length, *width, {}};
    if (xml::find_child(node, "orientation")) shape.heading = number(node, "orientation").value_or(0.0);
    double const c = std::cos(shape.heading), s = std::sin(shape.heading);
    for (auto const& [a, b] : {std::pair{0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}}) {
      double const x = a * *length, y = b * *width;
      shape.outline.push_back(rounded({shape.center.x() + c * x - s * y, shape.center.y() + s * x + c * y}));
    }
    return shape;
  }

  [[nodiscard]] std::optional<CommonRoadShape> circle(Node node) {
    auto const radius = number(node, "radius");
    if (!radius || !(*radius > 0.0)) return std::nullopt;
    CommonRoadShape shape{center(node), 0.0, 2.0 * *radius, 2.0 * *radius, {}};
    constexpr int corners = 32;
    for (int k = 0; k < corners; ++k) {
      double const angle = 2.0 * geometry::pi * k / corners;
      shape.outline.push_back(
          rounded({shape.center.x() + *radius * std::cos(angle), shape.center.y() + *radius * std::sin(angle)}));
    }
    return shape;
  }

  [[nodiscard]] std::optional<CommonRoadShape> polygon(Node node) {
    CommonRoadShape shape;
    geometry::Box box;
    bool good = true;
    xml::for_each_child(node, "point", [&](Node child) {
      auto const p = point(child);
      good = good && p;
      if (!p) return;
      shape.outline.push_back(*p);
      box.add(p->x(), p->y());
    });
    if (!good || shape.outline.size() < 3) return std::nullopt;
    shape.center = box.center();
    shape.length = box.max_x - box.min_x;
    shape.width = box.max_y - box.min_y;
    return shape;
  }

  /// A position: a point, or the middle of an area.
  [[nodiscard]] std::optional<geometry::Point> position(Node state) {
    auto const node = xml::find_child(state, "position");
    if (auto const child = xml::find_child(node, "point")) return point(child);
    auto const area = shape_of(node);
    if (area) {
      note(node, "the position is an area; its middle was taken");
      return area->center;
    }
    return std::nullopt;
  }

  /// A state; the heading without one is `heading`.
  [[nodiscard]] std::optional<State> state_of(Node node, double heading) {
    auto const at = position(node);
    auto const step = value(node, "time");
    if (!at || !step) return std::nullopt;
    State state;
    state.time = *step * traffic_.time_step;
    state.x = at->x();
    state.y = at->y();
    state.heading = value(node, "orientation").value_or(heading);
    state.speed = value(node, "velocity").value_or(0.0);
    return state;
  }

  void read_obstacle(Node node, bool stands) {
    auto const id = id_of(node);
    if (!id) return;
    auto const name = "obstacle " + std::to_string(*id);
    Track track{.id = *id, .type = TrackType::other, .stands = stands};
    for (auto const& [word, type] : common_road_types)
      if (word == text_of(xml::find_child(node, "type"))) track.type = type;
    auto const shape = shape_of(xml::find_child(node, "shape"));
    auto const initial = state_of(xml::find_child(node, "initialState"), 0.0);
    if (!shape || !initial)
      return warn(node, name + " has no shape, or no state with position and time; it was left out");
    track.length = shape->length;
    track.width = shape->width;
    if (!(track.length > 1e-3 && track.width > 1e-3 && track.length <= 100.0 && track.width <= 100.0))
      return warn(node, name + " is not up to 100 m long and wide; it was left out");
    track.states.push_back(*initial);
    if (!stands) read_motion(node, track);
    for (auto& state : track.states) shift(state, *shape);
    if (!ids_.insert(*id).second) return warn(node, name + " is there already; the second one was left out");
    traffic_.tracks.push_back(std::move(track));
  }

  /// From the origin of the obstacle's frame to the middle of its shape.
  static void shift(State& state, CommonRoadShape const& shape) {
    if (shape.center != geometry::Point{}) {
      double const c = std::cos(state.heading), s = std::sin(state.heading);
      state.x += c * shape.center.x() - s * shape.center.y();
      state.y += s * shape.center.x() + c * shape.center.y();
    }
    if (shape.heading != 0.0) state.heading += shape.heading;
  }

  void read_motion(Node node, Track& track) {
    auto const add = [&](Node at, std::optional<State> const& state) {
      if (!state)
        warn(at, "a state of obstacle " + std::to_string(track.id) + " has no position or time; it was left out");
      else if (!(state->time > track.states.back().time))
        warn(at,
             "a state of obstacle " + std::to_string(track.id) + " is not later than the one before; it was left out");
      else
        track.states.push_back(*state);
    };
    xml::for_each_child(xml::find_child(node, "trajectory"), "state",
                        [&](Node child) { add(child, state_of(child, track.states.back().heading)); });
    auto const set = xml::find_child(node, "occupancySet");
    if (set) note(set, "the occupancies of obstacle " + std::to_string(track.id) + " became places: their middles");
    xml::for_each_child(set, "occupancy", [&](Node child) {
      auto const shape = shape_of(xml::find_child(child, "shape"));
      auto const step = value(child, "time");
      if (step && *step * traffic_.time_step <= track.states.front().time) return;  // the initial state again
      if (!shape || !step) return add(child, std::nullopt);
      State state = track.states.back();
      double const passed = *step * traffic_.time_step - state.time;
      double const way = (shape->center - geometry::Point{state.x, state.y}).norm();
      state = {*step * traffic_.time_step, shape->center.x(), shape->center.y(),
               shape->heading != 0.0 ? shape->heading : state.heading, passed > 0.0 ? way / passed : 0.0};
      add(child, state);
    });
  }

  /// Buildings and the like: an obstacle that stands, about its middle.
  void read_environment(Node node) {
    auto const id = id_of(node);
    auto const shape = shape_of(xml::find_child(node, "shape"));
    if (!id) return;
    if (!shape || !(shape->length > 1e-3 && shape->width > 1e-3 && shape->length <= 100.0 && shape->width <= 100.0) ||
        !ids_.insert(*id).second)
      return warn(node, "obstacle " + std::to_string(*id) + " has no shape of up to 100 m; it was left out");
    note(node, "obstacle " + std::to_string(*id) + " became the rectangle around it");
    traffic_.tracks.push_back({*id,
                               TrackType::other,
                               shape->length,
                               shape->width,
                               true,
                               {State{0.0, shape->center.x(), shape->center.y(), shape->heading, 0.0}}});
  }

  // --- planning problems ---------------------------------------------------------------------------------------------

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
    if (problem.goals.empty()) warn(node, "planning problem " + std::to_string(*id) + " has no goal");
    traffic_.problems.push_back(std::move(problem));
  }

  [[nodiscard]] std::optional<GoalState> goal_of(Node node) {
    GoalState goal;
    if (auto const time = interval(node, "time")) {
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

  RecordedTraffic traffic_;
  xml::XmlContext context_;
  std::map<Id, Sign> signs_;
  std::map<Id, map::LightPlan> lights_;
  std::set<Id> ids_;  ///< of the obstacles
  std::set<std::string> unknown_;
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

}  // namespace cambium
