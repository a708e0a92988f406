#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "cambium/map/building/detail/lane_geometry.hpp"
#include "cambium/map/building/detail/lane_links.hpp"
#include "cambium/map/building/detail/lane_merges.hpp"
#include "cambium/map/building/detail/lane_rules.hpp"
#include "cambium/map/building/detail/lane_signals.hpp"
#include "cambium/map/building/detail/link_check.hpp"
#include "cambium/map/building/detail/missing_links.hpp"
#include "cambium/map/building/detail/path_check.hpp"
#include "cambium/map/building/detail/road_links.hpp"
#include "cambium/map/building/detail/section_sampler.hpp"
#include "cambium/map/building/make_roads.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/detail/id_places.hpp"
#include "cambium/map/lanes/overlaps.hpp"

namespace cambium::inline v0_1::map::detail {

[[nodiscard]] inline bool runs_both_ways(opendrive::LaneElement const& lane) {
  return lane.direction == opendrive::LaneDirection::both || lane.type == LaneType::bidirectional;
}

/// A lane of a road's section `k` as it is driven, without id, geometry and links.
[[nodiscard]] inline Lane unsampled_lane(opendrive::LaneElement const& written, Road const& road, std::size_t k) {
  Lane lane;
  lane.road = road.id;
  lane.section = static_cast<std::uint32_t>(k);
  lane.number = written.id;
  lane.type = written.type;
  lane.along_road = (written.id < 0) != road.left_hand_traffic;
  if (written.direction == opendrive::LaneDirection::reversed) lane.along_road = !lane.along_road;
  lane.road_begin = road.sections[k].begin;
  lane.road_end = road.sections[k].end;
  return lane;
}

/// The document's junctions, in its order (the roads' junction ids count so), with the roads and lanes that belong to
/// them. Priorities between roads that are not in the map are left out, with a finding.
[[nodiscard]] inline std::vector<Junction> make_junctions(OpenDriveDocument const& document,
                                                          std::span<Road const> roads, std::span<Lane const> lanes,
                                                          Findings& findings) {
  auto const ids = places_of(document.roads);
  std::vector<Junction> junctions;
  for (auto const& written : document.junctions) {
    Junction junction;
    junction.id = static_cast<JunctionId>(junctions.size());
    junction.name = written.id;
    for (auto const& priority : written.priorities)
      if (ids.contains(priority.high) && ids.contains(priority.low))
        junction.priorities.push_back(
            {static_cast<RoadId>(ids.at(priority.high)), static_cast<RoadId>(ids.at(priority.low))});
      else
        findings.add(Severity::warning, 0, "priority", "junction " + written.id,
                     "road " + (ids.contains(priority.high) ? priority.low : priority.high) +
                         " of a priority is not there; it was left out");
    junctions.push_back(std::move(junction));
  }
  for (auto const& road : roads)
    if (is_valid(road.junction)) junctions[index_of(road.junction)].roads.push_back(road.id);
  for (auto const& lane : lanes)
    if (auto const id = roads[index_of(lane.road)].junction; is_valid(id))
      junctions[index_of(id)].lanes.push_back(lane.id);
  return junctions;
}

/// Turns a document, which must be buildable and have its roads split, into a map: roads, lanes with their geometry,
/// links, merges, overlaps.
class MapBuild {
 public:
  MapBuild(OpenDriveDocument const& document, MapOptions const& options, std::string file,
           std::vector<Diagnostic>& diagnostics, bool roads_are_lanelets = false)
      : document_(document), findings_{std::move(file), diagnostics}, roads_are_lanelets_(roads_are_lanelets) {
    parts_.options = options;
  }

  [[nodiscard]] std::shared_ptr<Map const> build() {
    add_lanes();
    link_lanes();
    set_rules();
    ExactPaths const paths(parts_.roads, parts_.lanes, parts_.options);
    return finish([&paths](Lane const& lane, double s) { return paths.at(lane, s); });
  }

  // The stages of `build`, in their order. Who does one of them in another way changes `parts`.

  [[nodiscard]] Map::Parts& parts() { return parts_; }
  [[nodiscard]] LaneFindings lane_findings() { return {parts_.roads, document_, findings_, roads_are_lanelets_}; }

  /// Roads, and lanes with their geometry and neighbours.
  void add_lanes() {
    check_parameters(parts_.options, "MapOptions");
    parts_.roads = make_roads(document_);
    for (std::size_t i = 0; i < parts_.roads.size(); ++i)
      for (std::size_t k = 0; k < parts_.roads[i].sections.size(); ++k)
        add_section(document_.roads[i], parts_.roads[i], k);
    if (parts_.lanes.empty())
      throw MapError(findings_.file, "the map has no lane with a length" + likely_cause(findings_.list),
                     "give roads that have lanes beside lane 0");
    if (std::none_of(parts_.lanes.begin(), parts_.lanes.end(), [](Lane const& lane) { return lane.drivable(); }))
      findings_.add(Severity::warning, 0, {}, {}, "the map has no drivable lane");
  }

  /// What follows on what, and what merges.
  void link_lanes() {
    RoadLinks const links(document_, parts_.roads);
    LaneLinker(links, parts_.lanes, findings_).link();
    MissingLinks missing(links, parts_.lanes, findings_);
    auto const dead_ends = missing.find(parts_.options.infer_links);
    LaneMerger(parts_.roads, parts_.lanes, parts_.options, dead_ends).merge();
    missing.report_dead_ends(dead_ends);
    LinkCheck check(links, findings_);
    check.report_one_sided();
    check.report_joints(parts_.lanes);
  }

  /// Limits, marks, signs and lights.
  void set_rules() {
    report_speed_limits(document_, findings_);
    set_speed_limits(document_, parts_.lanes);
    set_lane_changes(document_, parts_.lanes);
    parts_.lights = LaneSignals(document_, parts_.lanes, findings_).set();
  }

  /// Junctions and overlaps: all that a world needs.
  [[nodiscard]] std::shared_ptr<Map const> finish(ExactPath const& path) {
    report_paths(parts_.lanes, lane_findings());
    parts_.junctions = make_junctions(document_, parts_.roads, parts_.lanes, findings_);
    number_lane_coordinate();
    find_overlaps(
        parts_.lanes, [this](Lane const& lane, double s) { return elevation(lane, s); },
        parts_.options.overlap_clearance, path);
    return std::make_shared<Map const>(std::move(parts_));
  }

 private:
  /// Height of a lane's path [m], to tell a bridge from a crossing.
  [[nodiscard]] double elevation(Lane const& lane, double s) const {
    return parts_.roads[index_of(lane.road)].elevation.value(lane.station_at(s));
  }

  void add_section(opendrive::RoadElement const& source, Road& road, std::size_t k) {
    auto& section = road.sections[k];
    if (section.lanes.empty() || section.end - section.begin < shortest_section) return;
    auto const cross_sections = SectionSampler(road, section, parts_.options).sample();
    for (std::size_t column = 0; column < section.lanes.size(); ++column) {
      auto const& written = *source.lane_sections[k].find(section.lanes[column].number);
      Lane lane = unsampled_lane(written, road, k);
      lane.id = static_cast<LaneId>(parts_.lanes.size());
      if (!has_geometry(lane, cross_sections, column)) {
        findings_.add(Severity::warning, written.line, "lane",
                      "road " + road.name + ", section " + std::to_string(k) + ", lane " + std::to_string(written.id),
                      "it has no length, or its numbers are out of range; it was left out");
        continue;
      }
      section.lanes[column].id = lane.id;
      parts_.lanes.push_back(std::move(lane));
      if (runs_both_ways(written)) section.lanes[column].opposite = add_opposite(cross_sections, column);
    }
    RoadLane const* left = nullptr;
    for (auto const& lane : section.lanes) {
      if (!is_valid(lane.id)) continue;
      if (left != nullptr) make_neighbors(*left, lane);
      left = &lane;
    }
  }

  /// Adds the last lane once more, driven the other way.
  LaneId add_opposite(std::span<CrossSection const> cross_sections, std::size_t column) {
    Lane lane = parts_.lanes.back();
    lane.id = static_cast<LaneId>(parts_.lanes.size());
    lane.opposite = parts_.lanes.back().id;
    lane.along_road = !lane.along_road;
    (void)has_geometry(lane, cross_sections, column);  // the other one has
    parts_.lanes.back().opposite = lane.id;
    parts_.lanes.push_back(std::move(lane));
    return parts_.lanes.back().id;
  }

  [[nodiscard]] static bool has_geometry(Lane& lane, std::span<CrossSection const> cross_sections, std::size_t column) {
    try {
      return set_geometry(lane, cross_sections, column, [column](CrossSection const& c) { return c.center(column); });
    } catch (MapError const&) {  // a point that is not a finite number
      return false;
    }
  }

  /// `left` lies left of `right` as seen along the road. Nobody changes onto a lane with oncoming traffic.
  void make_neighbors(RoadLane const& left, RoadLane const& right) {
    auto &a = parts_.lanes[index_of(left.id)], &b = parts_.lanes[index_of(right.id)];
    if (!a.drivable() || !b.drivable() || a.along_road != b.along_road) return;
    if (is_valid(left.opposite) || is_valid(right.opposite)) return;
    (a.along_road ? a.right_neighbor : a.left_neighbor) = b.id;
    (b.along_road ? b.left_neighbor : b.right_neighbor) = a.id;
  }

  /// Every lane gets a range of its own, apart from the next by more than an agent can be past a lane's end.
  void number_lane_coordinate() {
    constexpr double apart = 10.0;
    double begin = 0.0;
    for (auto& lane : parts_.lanes) {
      lane.index_begin = begin;
      begin += std::ceil(lane.length() + apart);
    }
  }

  OpenDriveDocument const& document_;
  Findings findings_;
  bool roads_are_lanelets_ = false;  ///< findings name them so
  Map::Parts parts_;
};

}  // namespace cambium::inline v0_1::map::detail
