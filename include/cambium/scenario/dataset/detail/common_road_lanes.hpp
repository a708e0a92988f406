#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/lanelet/lanelet_map.hpp"
#include "cambium/map/lanes/signal_codes.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive/xml.hpp"
#include "cambium/scenario/dataset/detail/common_road_signals.hpp"

namespace cambium::inline v0_1::detail {

/// The words of lanelet types that are more than "driving".
inline constexpr std::pair<std::string_view, map::LaneType> common_road_lane_types[] = {
    {"shoulder", map::LaneType::shoulder},
    {"sidewalk", map::LaneType::sidewalk},
    {"busLane", map::LaneType::bus},
    {"bicycleLane", map::LaneType::biking},
    {"accessRamp", map::LaneType::on_ramp},
    {"exitRamp", map::LaneType::off_ramp},
    {"crosswalk", map::LaneType::walking},
    {"parking", map::LaneType::parking},
    {"border", map::LaneType::border},
    {"restricted", map::LaneType::restricted},
    {"railway", map::LaneType::rail},
    {"restricted_area", map::LaneType::restricted},
    {"restrictedArea", map::LaneType::restricted}};
/// Those that are "driving".
inline constexpr std::string_view common_road_driving[] = {
    "urban", "country", "highway", "driveWay", "mainCarriageWay", "interstate", "busStop", "intersection", "unknown"};

/// The words of users.
inline constexpr std::string_view common_road_user_words[] = {
    "vehicle", "car", "truck", "bus", "priorityVehicle", "motorcycle", "bicycle", "pedestrian", "train", "taxi"};

/// The words of those that lanelets of a type are for.
[[nodiscard]] inline std::vector<std::string_view> common_road_users(map::LaneType type) {
  switch (type) {
    case map::LaneType::biking:
      return {"bicycle"};
    case map::LaneType::walking:
    case map::LaneType::sidewalk:
      return {"pedestrian"};
    case map::LaneType::shared:
      return {"bicycle", "pedestrian"};
    case map::LaneType::bus:
      return {"bus"};
    case map::LaneType::taxi:
      return {"taxi"};
    case map::LaneType::rail:
      return {"train"};
    default:
      return {"vehicle"};
  }
}

/// The words of line markings, and whether they permit a change from their left and from their right, as seen along
/// them.
struct CommonRoadMarking {
  std::string_view word;
  bool from_left = true, from_right = true;
};
inline constexpr CommonRoadMarking common_road_markings[] = {
    {"dashed", true, true},         {"solid", false, false},       {"broad_dashed", true, true},
    {"broad_solid", false, false},  {"dashed_dashed", true, true}, {"solid_solid", false, false},
    {"solid_dashed", false, true},  {"dashed_solid", true, false}, {"curb", false, false},
    {"lowered_curb", false, false}, {"no_marking", true, true},    {"unknown", true, true}};

/// Reads the lanelets of a CommonRoad file with their signs, lights and intersections, and makes the map of them.
class CommonRoadLanes : protected CommonRoadSignals {
 protected:
  using CommonRoadSignals::CommonRoadSignals;

  /// Fills lanelets, map, lanes and lights of the recording.
  void read_lanes(Node root, map::MapOptions const& options) {
    xml::for_each_child(root, [&](Node node, std::string_view name) { read_sign_or_light(node, name); });
    xml::for_each_child(root, "lanelet", [&](Node node) { read_lanelet(node); });
    xml::for_each_child(root, "intersection", [&](Node node) { read_intersection(node); });
    for (auto const& lanelet : traffic_.lanelets)
      for (auto const id : lanelet.predecessors) named_as_predecessor_.emplace(id, lanelet.id);
    for (auto const& pending : arrows_) hang_arrow(pending);
    report_one_sided();
    xml::for_each_child(root, [&](Node node, std::string_view name) {
      if (name != "trafficSign" && name != "trafficLight") return;
      auto const id = xml::parse_number<Id>(node.attribute("id").value());
      if (id && (signs_.contains(*id) || lights_.contains(*id)) && !used_.contains(*id))
        warn(node, "no lanelet refers to it; it has no effect");
    });
    if (!traffic_.lanelets.empty()) make_map(options);
  }

 private:
  /// A light for some of the ways behind a lanelet.
  struct PendingArrow {
    Node node;
    std::size_t lanelet = 0;
    Id light = 0;
    double before_end = 0.0;
  };

  void read_lanelet(Node node) {
    auto const id = id_of(node);
    if (!id) return;
    if (!places_.try_emplace(*id, traffic_.lanelets.size()).second)
      return warn(node, "lanelet " + std::to_string(*id) + " is there already; the second one was left out");
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
      if (auto const marking = xml::find_child(bound, "lineMarking"))
        (is_left ? lanelet.may_change_left : lanelet.may_change_right) = permits_change(marking, is_left);
    }
    if (!good) {
      places_.erase(*id);
      return warn(node, "lanelet " + std::to_string(*id) + " was left out, see the previous finding");
    }
    Users users;
    xml::for_each_child(node,
                        [&](Node child, std::string_view name) { read_lanelet_part(child, name, lanelet, users); });
    if (lanelet.type == map::LaneType::driving) lanelet.type = type_for(users.all);
    lanelet.both_directions = users.both_ways.contains("vehicle") || users.both_ways.contains("car");
    for (auto const user : common_road_users(lanelet.type))
      lanelet.both_directions = lanelet.both_directions || users.both_ways.contains(user);
    if (auto const line = xml::find_child(node, "stopLine")) read_stop_line(line, lanelet);
    traffic_.lanelets.push_back(std::move(lanelet));
  }

  [[nodiscard]] bool permits_change(Node marking, bool is_left) {
    for (auto const& known : common_road_markings)
      if (known.word == text_of(marking)) return is_left ? known.from_right : known.from_left;
    warn(marking, "\"" + std::string(text_of(marking)) + "\" is no marking that is known; it permits lane changes");
    return true;
  }

  /// Who may use a lanelet, and who of them both ways.
  struct Users {
    std::set<std::string_view> all, both_ways;
  };

  void add_user(Node node, bool both_ways, Users& users) {
    auto const word = text_of(node);
    if (std::find(std::begin(common_road_user_words), std::end(common_road_user_words), word) ==
        std::end(common_road_user_words))
      return warn(node, "the user \"" + std::string(word) + "\" is not known; it was left out");
    users.all.insert(word);
    if (both_ways) users.both_ways.insert(word);
  }

  /// What a lanelet is for by its users: usual traffic, or else the fastest of them.
  [[nodiscard]] static map::LaneType type_for(std::set<std::string_view> const& users) {
    using map::LaneType;
    constexpr std::pair<std::string_view, LaneType> by_user[] = {
        {"vehicle", LaneType::driving}, {"car", LaneType::driving},
        {"truck", LaneType::driving},   {"motorcycle", LaneType::driving},
        {"bus", LaneType::bus},         {"taxi", LaneType::taxi},
        {"train", LaneType::rail},      {"priorityVehicle", LaneType::restricted}};
    for (auto const& [word, type] : by_user)
      if (users.contains(word)) return type;
    bool const bikes = users.contains("bicycle"), walks = users.contains("pedestrian");
    if (!bikes && !walks) return LaneType::driving;  // nobody is named
    return bikes && walks ? LaneType::shared : bikes ? LaneType::biking : LaneType::walking;
  }

  void read_type(Node node, map::Lanelet& lanelet) {
    auto const text = text_of(node);
    lanelet.in_junction = lanelet.in_junction || text == "intersection";
    for (auto const& [word, type] : common_road_lane_types)
      if (word == text) {
        lanelet.type = type;
        return;
      }
    if (std::find(std::begin(common_road_driving), std::end(common_road_driving), text) ==
        std::end(common_road_driving))
      warn(node, "the type \"" + std::string(text) + "\" is not known; the lanelet counts as one for driving");
  }

  void read_lanelet_part(Node node, std::string_view name, map::Lanelet& lanelet, Users& users) {
    if (name == "predecessor" || name == "successor") {
      auto& list = name == "successor" ? lanelet.successors : lanelet.predecessors;
      if (auto const ref = reference(node)) list.push_back(*ref);
    } else if (name == "adjacentLeft" || name == "adjacentRight") {
      auto const ref = reference(node);
      std::string_view const way = node.attribute("drivingDir").value();
      if (way != "same" && way != "opposite")
        return warn(node, "its drivingDir \"" + std::string(way) +
                              "\" is neither same nor opposite; this side of the link was left out");
      if (way == "opposite") return note_once(node, "neighbours that are driven the other way are not read");
      if (!ref) return;
      (name == "adjacentLeft" ? lanelet.left_neighbor : lanelet.right_neighbor) = ref;
    } else if (name == "laneletType") {
      read_type(node, lanelet);
    } else if (name == "speedLimit") {
      auto const limit = xml::parse_number<double>(text_of(node));
      if (limit && map::is_speed_limit(*limit))
        lanelet.speed_limit = limit;
      else
        warn(node, "\"" + std::string(text_of(node)) + "\" is no speed between 0.1 and 200 m/s; it was left out");
    } else if (name == "userOneWay" || name == "userBidirectional") {
      add_user(node, name == "userBidirectional", users);
    } else if (name == "trafficSignRef" || name == "trafficLightRef") {
      if (auto const ref = reference(node)) add_signal(node, *ref, 0.0, lanelet);
    } else if (name != "leftBound" && name != "rightBound" && name != "stopLine") {
      note_once(node, "elements <" + std::string(name) + "> of lanelets are not read");
    }
  }

  /// Signs that the lanelet has stand at its stop line, where it has one.
  void read_stop_line(Node node, map::Lanelet& lanelet) {
    std::vector<geometry::Point> ends;
    xml::for_each_child(node, "point", [&](Node child) {
      if (auto const p = point(child)) ends.push_back(*p);
    });
    if (ends.size() == 1 || ends.size() > 2)
      warn(node, "it has " + std::to_string(ends.size()) + " points, not two; it lies at the end of lanelet " +
                     std::to_string(lanelet.id));
    double before = 0.0;
    if (ends.size() == 2) {
      geometry::Point const middle = 0.5 * (ends[0] + ends[1]);
      before = map::distance_before_end(lanelet, middle);
      constexpr double farthest = 20.0;  // [m] behind its end
      if (before == 0.0 && !lanelet.left.empty() && (middle - lanelet.left.back()).norm() > farthest)
        warn(node, "it lies " + rounded_text(std::round((middle - lanelet.left.back()).norm())) +
                       " m from the end of lanelet " + std::to_string(lanelet.id) + ", where it counts");
    }
    xml::for_each_child(node, [&](Node child, std::string_view name) {
      if (name != "trafficSignRef" && name != "trafficLightRef") return;
      if (auto const ref = reference(child)) add_signal(child, *ref, before, lanelet);
    });
    for (auto& signal : lanelet.signals) signal.before_end = before;
    auto arrow = arrows_.rbegin();
    for (; arrow != arrows_.rend() && arrow->lanelet == traffic_.lanelets.size(); ++arrow) arrow->before_end = before;
    if (lanelet.signals.empty() && arrow == arrows_.rbegin())
      note_once(node, "stop lines without a sign or light have no effect");
  }

  void add_signal(Node node, Id ref, double before, map::Lanelet& lanelet) {
    used_.insert(ref);
    if (auto const sign = signs_.find(ref); sign != signs_.end()) {
      if (sign->second.speed) lanelet.speed_limit = sign->second.speed;
      if (sign->second.kind) add_once(lanelet, {*sign->second.kind, before, {}});
    } else if (auto const light = lights_.find(ref); light != lights_.end()) {
      if (light->second.arrow != map::Arrow::none)
        return arrows_.push_back({node, traffic_.lanelets.size(), ref, before});
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

  /// The ways through an intersection lie in it; each turns as it says.
  void read_intersection(Node node) {
    std::set<Id> inside;
    xml::for_each_child(node, "incoming", [&](Node incoming) {
      xml::for_each_child(incoming, [&](Node child, std::string_view name) {
        if (name == "isLeftOf") return note_once(child, "who comes from the left of whom is read from the geometry");
        if (!name.starts_with("successors")) return;
        auto const ref = reference(child);
        if (!ref) return;
        inside.insert(*ref);
        xml::for_each_child(incoming, "incomingLanelet", [&](Node from) {
          auto const lanelet = reference(from);
          if (!lanelet) return;
          auto& turn = turns_[{*lanelet, *ref}];
          if (name == "successorsLeft") turn = turn | map::Arrow::left;
          if (name == "successorsStraight") turn = turn | map::Arrow::straight;
          if (name == "successorsRight") turn = turn | map::Arrow::right;
        });
      });
    });
    if (auto const crossing = xml::find_child(node, "crossing"))
      note_once(crossing, "the crossings of intersections are not read: lanelets of the type crosswalk are");
    for (auto const id : inside)
      if (auto const at = places_.find(id); at != places_.end())
        traffic_.lanelets[at->second].in_junction = true;
      else
        warn(node, "the way through it, lanelet " + std::to_string(id) + ", is not there");
  }

  /// An arrow light is for the ways behind the lanelet that turn so, as intersections say, else as their bounds do.
  void hang_arrow(PendingArrow const& pending) {
    auto& from = traffic_.lanelets[pending.lanelet];
    auto const arrow = lights_.at(pending.light).arrow;
    auto const name = "light " + std::to_string(pending.light);
    std::vector<std::size_t> ways;
    std::size_t followers = 0;
    bool guessed = false;
    auto const [first, last] = named_as_predecessor_.equal_range(from.id);
    std::set<Id> behind(from.successors.begin(), from.successors.end());
    for (auto at = first; at != last; ++at) behind.insert(at->second);
    for (auto const id : behind) {
      auto const at = places_.find(id);
      if (at == places_.end()) continue;
      auto const i = at->second;
      auto const& to = traffic_.lanelets[i];
      ++followers;
      auto const known = turns_.find({from.id, to.id});
      guessed = guessed || known == turns_.end();
      if (has(arrow, known != turns_.end() ? known->second : turn_of(to))) ways.push_back(i);
    }
    if (ways.empty())
      warn(pending.node, "no way behind lanelet " + std::to_string(from.id) + " has the direction of " + name +
                             "; it counts for the whole lanelet");
    else if (guessed)
      note(pending.node, "no intersection says how all ways behind lanelet " + std::to_string(from.id) + " turn; for " +
                             name + " their bounds count");
    if (ways.empty() || ways.size() == followers)
      return add_once(from, {map::SignalKind::light, pending.before_end, std::to_string(pending.light)});
    for (auto const i : ways) {
      auto& way = traffic_.lanelets[i];
      if (way.left.empty() || way.right.empty()) continue;
      double const length = map::distance_before_end(way, 0.5 * (way.left.front() + way.right.front()));
      add_once(way, {map::SignalKind::light, length, std::to_string(pending.light)});
    }
  }

  [[nodiscard]] static bool names(std::vector<Id> const& ids, Id id) {
    return std::find(ids.begin(), ids.end(), id) != ids.end();
  }

  [[nodiscard]] static map::Arrow turn_of(map::Lanelet const& lanelet) {
    auto const& line = lanelet.left;
    if (line.size() < 2) return map::Arrow::straight;
    auto const heading = [](geometry::Point const& a, geometry::Point const& b) {
      return portable::atan2(b.y() - a.y(), b.x() - a.x());
    };
    return map::arrow_of_turn(
        geometry::angle_difference(heading(line[line.size() - 2], line.back()), heading(line[0], line[1])));
  }

  /// Links and neighbours that only one of both lanelets names.
  void report_one_sided() {
    auto const report = [&](map::Lanelet const& by, Id other, std::string_view as, std::string_view back) {
      traffic_.diagnostics.push_back({Severity::info, context_.file(), by.line, "lanelet",
                                      "lanelet " + std::to_string(by.id),
                                      "it names lanelet " + std::to_string(other) + " as its " + std::string(as) +
                                          ", which does not name it as its " + std::string(back)});
    };
    auto const other = [&](Id id) {
      auto const at = places_.find(id);
      return at == places_.end() ? nullptr : &traffic_.lanelets[at->second];
    };
    for (auto const& lanelet : traffic_.lanelets) {
      for (auto const id : lanelet.successors)
        if (auto const* const to = other(id); to != nullptr && !names(to->predecessors, lanelet.id))
          report(lanelet, id, "successor", "predecessor");
      for (auto const id : lanelet.predecessors)
        if (auto const* const from = other(id); from != nullptr && !names(from->successors, lanelet.id))
          report(lanelet, id, "predecessor", "successor");
      if (auto const id = lanelet.left_neighbor)
        if (auto const* const left = other(*id); left != nullptr && left->right_neighbor != lanelet.id)
          report(lanelet, *id, "left neighbour", "right one");
      if (auto const id = lanelet.right_neighbor)
        if (auto const* const right = other(*id); right != nullptr && right->left_neighbor != lanelet.id)
          report(lanelet, *id, "right neighbour", "left one");
    }
  }

  void make_map(map::MapOptions const& options) {
    auto made =
        map::build_lanelet_map(traffic_.lanelets, options, context_.file(), std::exchange(traffic_.diagnostics, {}));
    traffic_.diagnostics = std::move(made.diagnostics);
    traffic_.map = std::move(made.map);
    traffic_.lanes = std::move(made.lanes);
    for (auto const& light : traffic_.map->lights()) {
      auto const id = xml::parse_number<Id>(light.name);
      auto const plan = id ? lights_.find(*id) : lights_.end();
      traffic_.lights.push_back(plan == lights_.end() ? map::LightPlan{} : plan->second.plan);
    }
  }

  std::map<Id, std::size_t> places_;            ///< of the lanelets
  std::multimap<Id, Id> named_as_predecessor_;  ///< and the lanelets that name them so
  std::set<Id> used_;                           ///< signs and lights that lanelets refer to
  std::vector<PendingArrow> arrows_;
  std::map<std::pair<Id, Id>, map::Arrow> turns_;  ///< of a lanelet and one behind it
};

}  // namespace cambium::inline v0_1::detail
