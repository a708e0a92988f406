#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "cambium/map/building/detail/road_links.hpp"
#include "cambium/map/detail/id_places.hpp"
#include "cambium/map/detail/move_records.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::inline v0_1::map::detail {

/// Lets a lane section begin at `s` [m] of the road, with the lanes and their links as they were. Nothing to do where
/// one begins there already, or nearer than `shortest_section`.
inline void split_section(opendrive::RoadElement& road, double s) {
  auto& sections = road.lane_sections;
  auto const next = std::find_if(sections.begin(), sections.end(), [s](auto const& section) { return section.s > s; });
  constexpr std::size_t most = 1000;  // sections of a road that is split
  if (next == sections.begin() || sections.size() > most) return;
  auto const at = next - 1;
  double const end = next == sections.end() ? road.geometry_length() : next->s;
  double const shift = s - at->s;
  if (shift <= shortest_section || end - s <= shortest_section) return;
  opendrive::LaneSection behind = *at;
  behind.s = s;
  for (auto& lane : behind.lanes) {
    move_records(lane, shift);
    if (lane.id != 0) lane.predecessors = {lane.id};
  }
  for (auto& lane : at->lanes)
    if (lane.id != 0) lane.successors = {lane.id};
  sections.insert(next, std::move(behind));
}

/// Splits sections so that lanes are linked at their ends only: where a connecting road of a virtual junction meets the
/// middle of a road, and in the middle of a road that closes upon itself with a single section. O(size of the
/// document).
inline void split_roads(OpenDriveDocument& document) {
  std::vector<std::pair<std::string, double>> places;
  for (auto const& road : document.roads)
    for (auto const* link : {&road.predecessor, &road.successor}) {
      if (!*link || (*link)->element_type != opendrive::ElementType::road) continue;
      if ((*link)->element_s)
        places.emplace_back((*link)->id, *(*link)->element_s);
      else if ((*link)->id == road.id && road.lane_sections.size() == 1)
        places.emplace_back(road.id, 0.5 * (road.lane_sections.front().s + road.geometry_length()));
    }
  if (places.empty()) return;
  auto const index = places_of(document.roads);
  for (auto const& [id, s] : places)
    if (auto const at = index.find(id); at != index.end()) split_section(document.roads[at->second], s);
}

}  // namespace cambium::inline v0_1::map::detail
