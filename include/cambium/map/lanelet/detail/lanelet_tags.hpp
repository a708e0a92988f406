#pragma once

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <pugixml.hpp>

#include "cambium/core/error.hpp"
#include "cambium/map/lanelet/detail/osm_ways.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/road/lane_type.hpp"
#include "cambium/map/opendrive/xml.hpp"

namespace cambium::inline v0_1::map::detail {

/// What a subtype means: the kind of lane, and the speed limits of Lanelet2's German rules within and outside of
/// towns (GermanTrafficRules and lanelet2_traffic_rules' table) [km/h], 0: none.
struct LaneletSubtype {
  std::string_view word;
  LaneType type;
  double urban = 0.0, rural = 0.0;
};
[[nodiscard]] inline LaneletSubtype const* lanelet_subtype(std::string_view word) {
  static constexpr LaneletSubtype all[] = {{"", LaneType::driving, 50, 50},
                                           {"road", LaneType::driving, 50, 100},
                                           {"highway", LaneType::driving, 130, 130},
                                           {"play_street", LaneType::driving, 7, 7},
                                           {"exit", LaneType::driving, 50, 50},
                                           {"bus_lane", LaneType::bus, 50, 100},
                                           {"emergency_lane", LaneType::shoulder},
                                           {"road_shoulder", LaneType::shoulder},
                                           {"bicycle_lane", LaneType::biking},
                                           {"walkway", LaneType::walking},
                                           {"shared_walkway", LaneType::walking},
                                           {"pedestrian_lane", LaneType::walking},
                                           {"crosswalk", LaneType::walking},
                                           {"stairs", LaneType::walking},
                                           {"parking", LaneType::parking}};
  auto const* const found = std::find_if(std::begin(all), std::end(all), [&](auto const& s) { return s.word == word; });
  return found == std::end(all) ? nullptr : found;
}

/// The kind of lane of a lanelet: that of its subtype, unless tags `participant:...` say who may use it.
[[nodiscard]] inline std::optional<LaneType> lane_type_of(pugi::xml_node node, LaneletSubtype const* subtype) {
  constexpr std::string_view prefix = "participant:";
  bool any = false, buses = false, bicycles = false, walkers = false, emergency = false;
  std::optional<bool> vehicles, cars, coaches;  // the more special word counts
  for (auto child = node.first_child(); child; child = child.next_sibling()) {
    std::string_view const key = child.attribute("k").value();
    if (local_name(child) != "tag" || !key.starts_with(prefix)) continue;
    auto const truth = osm_truth(child.attribute("v").value());
    if (!truth) continue;
    any = true;
    auto const who = key.substr(prefix.size());
    if (who == "vehicle") vehicles = truth;
    if (who == "vehicle:car") cars = truth;
    if (who == "vehicle:bus") coaches = truth;
    if (!*truth) continue;
    buses = buses || who == "vehicle:taxi";
    emergency = emergency || who == "vehicle:emergency";
    bicycles = bicycles || who == "bicycle";
    walkers = walkers || who.starts_with("pedestrian");
  }
  if (!any) return subtype != nullptr ? std::optional(subtype->type) : std::nullopt;
  if (cars.value_or(vehicles.value_or(false))) return LaneType::driving;
  if (buses || coaches.value_or(vehicles.value_or(false))) return LaneType::bus;
  if (bicycles) return LaneType::biking;
  if (walkers) return LaneType::walking;
  if (emergency) return LaneType::shoulder;
  return std::nullopt;
}

/// A speed as "50", "50 km/h", "30 mph" or "13.9 m/s"; km/h without a unit. [m/s]
[[nodiscard]] inline std::optional<double> speed_of_text(std::string_view text) {
  text = trimmed(text);
  auto const number_end = std::min(text.find_first_not_of("0123456789."), text.size());
  auto const value = parse_number<double>(text.substr(0, number_end));
  auto const unit = trimmed(text.substr(number_end));
  double factor = 0.0;  // [m/s]
  if (unit.empty() || unit == "km/h" || unit == "kmh" || unit == "kph") factor = 1.0 / 3.6;
  if (unit == "mph" || unit == "m/h") factor = 0.44704;
  if (unit == "m/s" || unit == "mps") factor = 1.0;
  if (!value || !is_speed_limit(*value * factor)) return std::nullopt;
  return *value * factor;
}

/// The tag that says for a kind of lane alone whether it is one-way.
[[nodiscard]] constexpr std::string_view one_way_of(LaneType type) {
  if (is_drivable(type)) return "one_way:vehicle";
  return type == LaneType::walking ? "one_way:pedestrian" : type == LaneType::biking ? "one_way:bicycle" : "";
}

/// Whether a lanelet is used both ways: vehicles only where it says so, people on foot unless it says the contrary.
[[nodiscard]] inline bool goes_both_ways(pugi::xml_node node, LaneType type) {
  if (!is_drivable(type) && type != LaneType::walking) return false;
  bool const usual = osm_truth(osm_tag(node, "one_way")).value_or(type != LaneType::walking);
  return !osm_truth(osm_tag(node, one_way_of(type))).value_or(usual);
}

/// Reports participants that are not known.
inline void report_participants(CountedFindings& counted, pugi::xml_node node) {
  constexpr std::string_view prefix = "participant:";
  constexpr std::string_view known[] = {
      "vehicle",           "vehicle:car",   "vehicle:car:electric", "vehicle:car:combustion",
      "vehicle:bus",       "vehicle:truck", "vehicle:taxi",         "vehicle:motorcycle",
      "vehicle:emergency", "bicycle",       "pedestrian",           "train"};
  for (auto child = node.first_child(); child; child = child.next_sibling()) {
    std::string_view const key = child.attribute("k").value(), value = child.attribute("v").value();
    if (local_name(child) != "tag" || !key.starts_with(prefix)) continue;
    auto const said = std::string(key) + "=" + std::string(value);
    if (!osm_truth(value))
      counted.add(Severity::warning, child, said + " is neither yes nor no; it was left out");
    else if (std::find(std::begin(known), std::end(known), key.substr(prefix.size())) == std::end(known))
      counted.add(Severity::warning, child, said + ": this participant is not known; it has no effect");
  }
}

/// Reports tags of a lanelet that have no effect, or not the written one.
inline void report_lanelet_tags(CountedFindings& counted, pugi::xml_node node, LaneType type) {
  auto const warn = [&](pugi::xml_node at, std::string const& sentence) {
    counted.add(Severity::warning, at, sentence);
  };
  for (auto child = node.first_child(); child; child = child.next_sibling()) {
    if (local_name(child) != "tag") continue;
    std::string_view const key = child.attribute("k").value(), value = child.attribute("v").value();
    auto const said = std::string(key) + "=" + std::string(value);
    auto const truth = osm_truth(value);
    bool const is_one_way = key == "one_way" || (key == one_way_of(type) && !key.empty());
    if (key.starts_with("one_way") && !truth)
      warn(child, said + " is neither yes nor no; it was left out");
    else if (key.starts_with("one_way:") && !is_one_way)
      counted.add(Severity::info, child,
                  said + " has no effect on a lanelet of the kind " + std::string(to_string(type)));
    else if (is_one_way && truth == false && !is_drivable(type) && type != LaneType::walking)
      counted.add(
          Severity::info, child,
          said + ": lanes of the kind " + std::string(to_string(type)) + " are used one way only, as their bounds run");
    else if (key == "location" && value != "urban" && value != "nonurban")
      counted.add(Severity::info, child, said + " is neither urban nor nonurban; urban was taken");
    else if (key == "turn_direction" && value != "left" && value != "right" && value != "straight")
      warn(child, said + " is none of left, straight, right; it says only that the lanelet lies in a junction");
    else if (key == "dynamic" && truth != false)
      counted.add(Severity::info, child, said + " is not read: limits and rules hold always");
    else if (key == "no_drivable_lane" && truth != false && is_drivable(type))
      warn(child, said + " is not read: its subtype and participants say that it is driven on");
    else if (key.starts_with("speed_limit:"))
      warn(child, said + " is not read: limits hold for everyone");
  }
}

}  // namespace cambium::inline v0_1::map::detail
