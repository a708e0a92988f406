#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/detail/junctions.hpp"
#include "cambium/map/detail/lane_change_marks.hpp"
#include "cambium/map/detail/lane_geometry.hpp"
#include "cambium/map/detail/lane_links.hpp"
#include "cambium/map/detail/section_sampler.hpp"
#include "cambium/map/detail/speed_limits.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive_document.hpp"
#include "cambium/map/overlaps.hpp"
#include "cambium/map/routing.hpp"

namespace cambium::map {

namespace detail {

/// Turns a document into a map: roads, lanes with their geometry, links, merges, overlaps.
class MapBuild {
 public:
  MapBuild(OpenDriveDocument const& document, MapOptions const& options, std::string file,
           std::vector<Diagnostic>& diagnostics)
      : document_(document), file_(std::move(file)), diagnostics_(diagnostics) {
    parts_.options = options;
  }

  [[nodiscard]] std::shared_ptr<Map const> build() {
    check_parameters(parts_.options, "MapOptions");
    parts_.roads.reserve(document_.roads.size());
    for (auto const& road : document_.roads) add_road(road);
    if (parts_.lanes.empty())
      throw MapError(file_, "the file has no lane with a length", "give a file with lanes beside lane 0");
    LaneLinker(document_, parts_.roads, parts_.lanes, file_, diagnostics_).link();
    // From the lanes that go on outwards: one may merge into another that merges itself.
    for (bool found = true; found;) {
      found = false;
      for (auto& lane : parts_.lanes)
        if (lane.drivable() && lane.successors.empty() && find_merge(lane)) found = swing(lane) || found;
    }
    set_speed_limits(document_, parts_.roads, parts_.lanes);
    set_lane_changes(document_, parts_.roads, parts_.lanes);
    parts_.junctions = make_junctions(document_, parts_.roads, parts_.lanes);
    number_lane_coordinate();
    find_overlaps(
        parts_.lanes, [this](Lane const& lane, double s) { return elevation(lane, s); },
        parts_.options.overlap_clearance);
    parts_.route_finder = make_route_finder();
    return std::make_shared<Map const>(std::move(parts_));
  }

 private:
  /// Height of a lane's path [m], to tell a bridge from a crossing.
  [[nodiscard]] double elevation(Lane const& lane, double s) const {
    double const u = s / lane.length();
    double const road_s = lane.along_road ? lane.road_begin + u * (lane.road_end - lane.road_begin)
                                          : lane.road_end - u * (lane.road_end - lane.road_begin);
    return parts_.roads[index_of(lane.road)].elevation.value(road_s);
  }

  [[nodiscard]] static Road make_road(opendrive::Road const& source, RoadId id, opendrive::HeaderOffset const& offset) {
    Road road;
    road.id = id;
    road.name = source.id;
    road.left_hand_traffic = source.rule == opendrive::TrafficRule::left_hand;
    road.reference_line = opendrive::make_reference_line(source, offset);
    road.lane_offset = CubicProfile(source.lane_offset);
    road.elevation = CubicProfile(source.elevation);
    road.length = source.geometry_length();
    for (std::size_t k = 0; k < source.lane_sections.size(); ++k) {
      auto const& section = source.lane_sections[k];
      RoadSection result;
      result.begin = section.s;
      result.end = k + 1 < source.lane_sections.size() ? source.lane_sections[k + 1].s : road.length;
      for (auto const& lane : section.lanes)
        if (lane.id != 0)
          result.lanes.push_back(
              {lane.id, none<LaneId>, CubicProfile(lane.widths, BeforeFirst::hold),
               CubicProfile(lane.widths.empty() ? lane.borders : std::vector<CubicRecord>(), BeforeFirst::hold)});
      road.sections.push_back(std::move(result));
    }
    return road;
  }

  void add_road(opendrive::Road const& source) {
    auto const id = static_cast<RoadId>(parts_.roads.size());
    parts_.roads.push_back(make_road(source, id, document_.header.offset));
    auto& road = parts_.roads.back();
    for (std::size_t j = 0; j < document_.junctions.size(); ++j)
      if (!source.junction.empty() && document_.junctions[j].id == source.junction)
        road.junction = static_cast<JunctionId>(j);
    for (std::size_t k = 0; k < road.sections.size(); ++k) add_section(source, road, k);
  }

  void add_section(opendrive::Road const& source, Road& road, std::size_t k) {
    auto& section = road.sections[k];
    if (section.lanes.empty() || section.end - section.begin < 1e-6) return;
    auto const cross_sections = SectionSampler(road, section, parts_.options).sample();
    auto const first = parts_.lanes.size();
    for (std::size_t column = 0; column < section.lanes.size(); ++column) {
      auto const& written = *source.lane_sections[k].find(section.lanes[column].number);
      Lane lane = make_lane(written, road, k);
      lane.id = static_cast<LaneId>(parts_.lanes.size());
      if (!has_geometry(lane, cross_sections, column)) {
        diagnostics_.push_back(
            {Severity::warning, file_, written.line, "lane",
             "road " + road.name + ", section " + std::to_string(k) + ", lane " + std::to_string(written.id),
             "it has no length, or its numbers are out of all range; it was left out"});
        continue;
      }
      section.lanes[column].id = lane.id;
      parts_.lanes.push_back(std::move(lane));
    }
    for (std::size_t i = first; i + 1 < parts_.lanes.size(); ++i) make_neighbors(parts_.lanes[i], parts_.lanes[i + 1]);
  }

  [[nodiscard]] static bool has_geometry(Lane& lane, std::span<CrossSection const> cross_sections, std::size_t column) {
    try {
      return set_geometry(lane, cross_sections, column, [column](CrossSection const& c) { return c.center(column); });
    } catch (MapError const&) {  // a point that is not a finite number
      return false;
    }
  }

  [[nodiscard]] static Lane make_lane(opendrive::Lane const& written, Road const& road, std::size_t k) {
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

  /// `a` lies left of `b` as seen along the road.
  static void make_neighbors(Lane& a, Lane& b) {
    if (!a.drivable() || !b.drivable() || a.along_road != b.along_road) return;
    (a.along_road ? a.right_neighbor : a.left_neighbor) = b.id;
    (b.along_road ? b.left_neighbor : b.right_neighbor) = a.id;
  }

  /// A lane that ends while its neighbour goes on merges into that one.
  bool find_merge(Lane& lane) {
    bool const keeps_left = parts_.roads[index_of(lane.road)].left_hand_traffic;
    for (auto const side : {keeps_left ? lane.right_neighbor : lane.left_neighbor,
                            keeps_left ? lane.left_neighbor : lane.right_neighbor}) {
      if (!is_valid(side) || parts_.lanes[index_of(side)].successors.empty() || dead_ends_.contains(lane.id)) continue;
      if (goes_on_unlinked(lane, parts_.lanes[index_of(side)])) break;
      lane.merges_into = side;
      return true;
    }
    return false;
  }

  /// True where a lane beside the neighbour's successor begins at this lane's end: the file forgot the link.
  [[nodiscard]] bool goes_on_unlinked(Lane const& lane, Lane const& neighbor) {
    auto const end = lane.path.pose(lane.length()).position();
    for (auto const next : neighbor.successors)
      for (auto const beside :
           {parts_.lanes[index_of(next)].left_neighbor, parts_.lanes[index_of(next)].right_neighbor}) {
        if (!is_valid(beside)) continue;
        auto const& candidate = parts_.lanes[index_of(beside)];
        if (!candidate.predecessors.empty() || (candidate.path.pose(0.0).position() - end).norm() > 0.5) continue;
        diagnostics_.push_back(
            {Severity::warning, file_, 0, "link",
             "road " + parts_.roads[index_of(lane.road)].name + ", lane " + std::to_string(lane.number),
             "it has no successor, but lane " + std::to_string(candidate.number) + " of road " +
                 parts_.roads[index_of(candidate.road)].name +
                 " begins where it ends; is the link missing? It was left as a dead end"});
        dead_ends_.insert(lane.id);
        return true;
      }
    return false;
  }

  [[nodiscard]] static std::size_t column_of(RoadSection const& section, LaneId id) {
    return static_cast<std::size_t>(
        std::find_if(section.lanes.begin(), section.lanes.end(), [id](RoadLane const& l) { return l.id == id; }) -
        section.lanes.begin());
  }

  /// Lets the lane's path swing onto the neighbour's and go on as that one does.
  bool swing(Lane& lane) {
    // [m] between the stations of a swing: it turns by some 0.03 rad a metre at most (3.5 m over 30 m).
    double const spacing = std::clamp(parts_.options.heading_tolerance / 0.03, 0.05, 1.5);
    auto const& road = parts_.roads[index_of(lane.road)];
    auto const& section = road.sections[lane.section];
    auto const column = column_of(section, lane.id), target = column_of(section, lane.merges_into);
    auto const cross_sections = SectionSampler(road, section, parts_.options).sample(spacing);
    double const from = taper_begin(cross_sections, column, lane.along_road, parts_.options.merge_length);
    double const to = lane.along_road ? section.end : section.begin;
    auto const path = [&](CrossSection const& c) { return merging_path(c, column, target, from, to); };
    if (!set_geometry(lane, cross_sections, column, path)) {
      lane.merges_into = none<LaneId>;
      dead_ends_.insert(lane.id);
      return false;
    }
    auto const start = road.reference_line.at(from);
    lane.merge_begin = lane.path.project({start.x, start.y}).s;
    auto const& neighbor = parts_.lanes[index_of(lane.merges_into)];
    lane.successors = neighbor.successors;
    for (auto const next : lane.successors) parts_.lanes[index_of(next)].predecessors.push_back(lane.id);
    return !lane.successors.empty();
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
  std::string file_;
  std::vector<Diagnostic>& diagnostics_;
  std::set<LaneId> dead_ends_;  ///< lanes that could not be merged
  Map::Parts parts_;
};

}  // namespace detail

/// The map that a document describes; what was odd is added to `diagnostics`, with `file` as the place. Throws
/// `MapError` where no lane is left.
[[nodiscard]] inline std::shared_ptr<Map const> build_map(OpenDriveDocument const& document, MapOptions const& options,
                                                          std::string file, std::vector<Diagnostic>& diagnostics) {
  return detail::MapBuild(document, options, std::move(file), diagnostics).build();
}

}  // namespace cambium::map
