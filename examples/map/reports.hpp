#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/text.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/lanes/junction.hpp"
#include "cambium/map/lanes/lane_network.hpp"
#include "cambium/map/lanes/right_of_way.hpp"
#include "cambium/map/map.hpp"

#include "../common/csv.hpp"
#include "summary.hpp"

namespace map_example {

/// The map's description of a lane, safe to print on a terminal.
inline std::string lane_name(cb::Map const& map, cb::LaneId lane) { return cb::detail::printable(map.describe(lane)); }

/// Problems of the lane network, one per line.
inline std::string network(cb::Map const& map) {
  using cb::map::NetworkFault;
  std::string text;
  for (auto const& finding : check_lane_network(map)) {
    text += "  " + readable(finding.fault);
    if (finding.fault == NetworkFault::kink)
      text += " of " + cb::detail::rounded_text(finding.size) + " rad";
    else if (finding.size > 0.0)
      text += " of " + cb::detail::rounded_text(finding.size) + " m";
    text += ": " + lane_name(map, finding.lane);
    if (is_valid(finding.other)) text += " and " + lane_name(map, finding.other);
    text += '\n';
  }
  return text.empty() ? "  no problems in the lane network\n" : text;
}

/// Conflicts between the lanes of the junction `name`, and which road has priority, one per line.
inline std::string junction(cb::Map const& map, std::string const& name) {
  cb::map::Junction const* found = nullptr;
  std::string names;
  for (auto const& junction : map.junctions()) {
    if (junction.name == name) found = &junction;
    names += (names.empty() ? "" : ", ") + junction.name;
  }
  if (found == nullptr)
    throw cb::MapError("--junction " + name, "the map has no such junction",
                       names.empty() ? "it has none" : "it has " + names);
  std::string text = "junction " + name + ": " + std::to_string(found->roads.size()) + " roads, " +
                     std::to_string(found->lanes.size()) + " lanes";
  if (auto const area = junction_area(map, found->id)) {
    auto const& box = area->bounding_box();
    text += ", x from " + metres(box.min_x) + " to " + metres(box.max_x) + ", y from " + metres(box.min_y) + " to " +
            metres(box.max_y) + " m";
  }
  text += '\n';
  auto const place = [&map](cb::LaneId lane, cb::map::PathStretch const& stretch) {
    return lane_name(map, lane) + " from " + metres(stretch.begin) + " to " + metres(stretch.end) + " m";
  };
  for (auto const& conflict : conflict_areas(map, found->id)) {
    constexpr char const* kinds[] = {"merge", "split", "crossing"};
    text += std::string("  ") + kinds[static_cast<std::size_t>(conflict.kind)] + ": " +
            place(conflict.first, conflict.on_first) + ", " + place(conflict.second, conflict.on_second);
    if (conflict.area) text += ", " + metres(conflict.area->area()) + " m2";
    if (auto const first = goes_first(*found, map.lane(conflict.first).road, map.lane(conflict.second).road))
      text += ", road " + map.road(*first).name + " goes first";
    text += '\n';
  }
  return text;
}

/// A place of the command line, "road:lane:s" or "road:lane:s:direction"; the road's id may have colons itself.
inline cb::map::LaneStation find_place(cb::Map const& map, std::string const& option, std::string const& word) {
  std::string rest = word;
  auto const take = [&rest] {  // removes and returns the part after the last colon
    auto const colon = rest.rfind(':');
    if (colon == rest.npos) return std::string();
    std::string last = rest.substr(colon + 1);
    rest.resize(colon);
    return last;
  };
  std::optional<cb::map::RoadDirection> direction;
  std::string last = take();
  if (last == "forward") direction = cb::map::RoadDirection::forward;
  if (last == "backward") direction = cb::map::RoadDirection::backward;
  if (direction) last = take();
  auto const s = cb::detail::parse_number<double>(last);
  auto const lane = cb::detail::parse_number<int>(take());
  if (!s || !lane)
    throw cb::Error(option, "'" + word + "' is no place", "write it as road:lane:s, such as 12:-1:30.5; see --help");
  auto const id = direction ? map.find_lane(rest, *s, *lane, *direction) : map.find_lane(rest, *s, *lane);
  return {id, map.lane(id).position_at(*s)};
}

/// A lane's speed limits: "50 km/h, from 40 m on 30 km/h".
inline std::string limits(cb::map::Lane const& lane) {
  auto const speed = [](double limit) {
    return std::isfinite(limit) ? metres(3.6 * limit) + " km/h" : std::string("no limit");
  };
  std::string text = speed(lane.speed_limit_at(0.0));
  for (auto const& step : lane.speed_limits)
    if (step.begin > 0.0) text += ", from " + metres(step.begin) + " m on " + speed(step.limit);
  return text;
}

/// Number of the corridor's lanes beside `lane` on one side.
inline int count_beside(cb::Map const& map, cb::map::RoadCorridor const& corridor, cb::LaneId lane,
                        cb::LaneId cb::map::Lane::*side) {
  int count = 0;
  for (lane = map.lane(lane).*side; is_valid(lane); lane = map.lane(lane).*side)
    count += corridor.corridor_of(lane) != cb::none<cb::CorridorId>;
  return count;
}

/// The lanes of a corridor's route, one per line.
inline std::string corridor_text(cb::Map const& map, cb::map::RoadCorridor const& corridor) {
  std::string text;
  for (auto const id : corridor.route) {
    auto const& lane = map.lane(id);
    auto const width = [&lane](double s) {
      auto const sides = lane.widths_at(s);
      return metres(sides.left + sides.right);
    };
    auto const begin = width(0.0), end = width(lane.length());
    int const left = count_beside(map, corridor, id, &cb::map::Lane::left_neighbor),
              right = count_beside(map, corridor, id, &cb::map::Lane::right_neighbor);
    text += "  " + lane_name(map, id) + ": " + metres(lane.length()) + " m, " +
            (begin == end ? begin : begin + " to " + end) + " m wide, " + limits(lane);
    if (left + right > 0)
      text += ", " + std::to_string(left + 1) + " of " + std::to_string(left + right + 1) + " from the left";
    text += '\n';
  }
  auto const& main = corridor.corridors[corridor.main];
  text += "corridor of " + std::to_string(corridor.lanes().size()) + " lanes; those in line with the destination are " +
          metres(main.length()) + " m long";
  return text + (main.continues ? ", and the road goes on\n" : ", where the road ends\n");
}

/// The numbers in "x,y" or "x,y,heading"; empty if `word` is neither.
inline std::vector<double> coordinates(std::string const& word) {
  std::vector<double> numbers;
  for (auto const part : cb::detail::split(word, ",")) {
    auto const number = cb::detail::parse_number<double>(part);
    if (!number) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

/// The shortest route between two places, and its lanes. The places are on lanes, or `from` is a pose and `to` a point.
inline std::string route(cb::Map const& map, std::string const& from, std::string const& to) {
  if (auto const a = coordinates(from), b = coordinates(to); a.size() == 3 && b.size() == 2) {
    auto const corridor = build_road_corridor(map, {a[0], a[1], a[2]}, cb::geometry::Point(b[0], b[1]));
    return "route of " + std::to_string(corridor->route.size()) + " lanes\n" + corridor_text(map, *corridor);
  }
  auto const start = find_place(map, "--route", from), end = find_place(map, "--route", to);
  auto const found = map.shortest_route(start, end);
  if (!found) throw cb::MapError("--route", "there is no way from " + from + " to " + to, "look at the --picture");
  return "route of " + std::to_string(found->lanes.size()) + " lanes, " + metres(found->length) + " m\n" +
         corridor_text(map, *build_road_corridor(map, *found));
}

/// The lanes that can be reached from a place within `distance` [m], one per line.
inline std::string reachable(cb::Map const& map, std::string const& from, std::string const& distance) {
  auto const budget = cb::detail::parse_number<double>(distance);
  if (!budget || *budget < 0.0)
    throw cb::Error("--reachable", "'" + distance + "' is no distance", "give metres, 0 or more");
  auto const reached = map.reachable(find_place(map, "--reachable", from), *budget);
  std::string text = std::to_string(reached.size()) + " lanes can be reached within " + metres(*budget) + " m\n";
  for (auto const& lane : reached) text += "  " + lane_name(map, lane.lane) + ": " + metres(lane.cost) + " m\n";
  return text;
}

}  // namespace map_example
