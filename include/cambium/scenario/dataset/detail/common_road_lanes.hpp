#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/map/lanelet/lanelet_map.hpp"
#include "cambium/map/lanes/signal_codes.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive/xml.hpp"
#include "cambium/scenario/dataset/detail/common_road_values.hpp"

namespace cambium::detail {

/// The words of lanelet types that are more than "driving".
inline constexpr std::pair<std::string_view, map::LaneType> common_road_lane_types[] = {
    {"shoulder", map::LaneType::shoulder},  {"sidewalk", map::LaneType::sidewalk},
    {"busLane", map::LaneType::bus},        {"bicycleLane", map::LaneType::biking},
    {"accessRamp", map::LaneType::on_ramp}, {"exitRamp", map::LaneType::off_ramp},
    {"crosswalk", map::LaneType::walking}};

/// What a sign says by the catalogue of a benchmark's country, "DEU_Test-1_1" or "C-USA_US101-1_1_T-1"; by the American
/// one where the country is none on Earth, as Zamunda (ZAM) is.
[[nodiscard]] inline map::SignalCode const* common_road_sign(std::string_view benchmark, std::string_view id) {
  if (benchmark.starts_with("C-")) benchmark.remove_prefix(2);
  auto const country = benchmark.substr(0, 3);
  for (auto const& [word, code] : {std::pair{"USA", "us"}, {"ZAM", "us"}, {"ESP", "es"}, {"AUS", "au"}, {"CHN", "cn"}})
    if (word == country) return map::find_signal_code(code, id, "");
  return map::find_signal_code("", id, "");
}

/// Reads the lanelets of a CommonRoad file with their signs, lights and intersections, and makes the map of them.
class CommonRoadLanes : protected CommonRoadValues {
 protected:
  using CommonRoadValues::CommonRoadValues;

  /// Fills lanelets, map, lanes and lights of the recording.
  void read_lanes(Node root, map::MapOptions const& options) {
    xml::for_each_child(root, [&](Node node, std::string_view name) { read_rule(node, name); });
    xml::for_each_child(root, "lanelet", [&](Node node) { read_lanelet(node); });
    xml::for_each_child(root, "intersection", [&](Node node) { read_intersection(node); });
    if (!traffic_.lanelets.empty()) make_map(options);
  }

 private:
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
      auto const* const code = common_road_sign(traffic_.name, word);
      if (code == nullptr) return warn(element, "its sign " + std::string(word) + " is not known; it was left out");
      if (auto const kind = map::kind_of(code->meaning); kind && kind != map::SignalKind::light) sign.kind = kind;
      if (code->meaning != map::SignalMeaning::speed_limit) return;
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

  void read_lanelet(Node node) {
    auto const id = id_of(node);
    if (!id) return;
    map::Lanelet lanelet{.id = *id};
    lanelet.line = context_.line(node);
    bool good = true;
    for (bool const is_left : {true, false}) {
      auto const bound = xml::find_child(node, is_left ? "leftBound" : "rightBound");
      auto& points = is_left ? lanelet.left : lanelet.right;
      auto& heights = is_left ? lanelet.left_heights : lanelet.right_heights;
      xml::for_each_child(bound, "point", [&](Node child) {
        auto const p = point(child);
        good = good && p;
        if (p) points.push_back(*p);
        if (auto const height = xml::parse_number<double>(text_of(xml::find_child(child, "z"))))
          heights.push_back(*height);
      });
      if (heights.size() != points.size()) heights.clear();
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
      (name == "adjacentLeft" ? lanelet.left_neighbor : lanelet.right_neighbor) = ref;
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
    double const before = ends.size() == 2 ? map::distance_before_end(lanelet, 0.5 * (ends[0] + ends[1])) : 0.0;
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

  std::map<Id, Sign> signs_;
  std::map<Id, map::LightPlan> lights_;
};

}  // namespace cambium::detail
