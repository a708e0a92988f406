#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/map/detail/geometry_fault.hpp"
#include "cambium/map/detail/id_places.hpp"
#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/cubic.hpp"
#include "cambium/map/road/reference_line.hpp"

namespace cambium::inline v0_1::map::detail {

/// Whether an offset of a header is finite and within the range of coordinates.
[[nodiscard]] inline bool is_bearable(opendrive::HeaderOffset const& offset) {
  return std::abs(offset.x) <= 1e8 && std::abs(offset.y) <= 1e8 && std::abs(offset.z) <= 1e8 &&
         std::abs(offset.heading) <= 1e4;
}

/// Throws `MapError` where a document, which may have been made or changed in code, lacks what the reader guarantees
/// and a map cannot be made without. Linear in the document.
class RequireBuildable {
 public:
  static void check(OpenDriveDocument const& document) {
    RequireBuildable("header").require(is_bearable(document.header.offset),
                                       "its offset is not finite, or beyond any map", "give m and rad");
    IdPlaces ids;
    for (auto const& road : document.roads) {
      RequireBuildable const here("road " + road.id);
      here.require(ids.emplace(road.id, 0).second, "another road has the same id", "give each road an id of its own");
      here.check_line(road);
      for (auto const* records : {&road.elevation, &road.superelevation, &road.lane_offset})
        here.check_records(*records, "of the road");
      for (auto const& type : road.types) here.check_speed(type.s, type.limit, "of the road");
      for (auto const& crossfall : road.crossfall) here.check_record(crossfall.record, "of the crossfall");
      for (auto const& shape : road.shape) here.check_record(shape.record, "of the shape");
      here.check_sections(road);
    }
  }

 private:
  explicit RequireBuildable(std::string where) : where_(std::move(where)) {}

  void require(bool holds, char const* what, char const* remedy) const {
    if (!holds) throw MapError(where_, what, remedy);
  }

  void check_line(opendrive::RoadElement const& road) const {
    for (auto const& g : road.geometries)
      if (auto const* const fault = fault_of(g))
        throw MapError(where_, std::string("a geometry: ") + fault, "see lay_from");
    bool const is_sorted = std::is_sorted(road.geometries.begin(), road.geometries.end(),
                                          [](Geometry const& a, Geometry const& b) { return a.s < b.s; });
    require(is_sorted, "its geometries are not in the order of s", "sort them");
    require(road.geometry_length() > 0.0, "it has no geometry with a length", "lay out a line, see lay_from");
  }

  void check_sections(opendrive::RoadElement const& road) const {
    require(!road.lane_sections.empty(), "it has no lane section", "add one at 0");
    for (std::size_t k = 0; k < road.lane_sections.size(); ++k) {
      auto const& section = road.lane_sections[k];
      require(std::isfinite(section.s) && (k == 0 || road.lane_sections[k - 1].s <= section.s),
              "its lane sections are not in the order of s", "sort them; s must be finite");
      bool const is_ordered =
          std::adjacent_find(section.lanes.begin(), section.lanes.end(),
                             [](opendrive::LaneElement const& left, opendrive::LaneElement const& right) {
                               return left.id <= right.id;
                             }) == section.lanes.end();
      require(is_ordered, "the lanes of a section are not ordered from left to right, or one occurs twice",
              "sort them by descending id");
      for (auto const& lane : section.lanes) check_lane(lane);
    }
  }

  void check_lane(opendrive::LaneElement const& lane) const {
    check_records(lane.widths, "of a lane's width");
    check_records(lane.borders, "of a lane's border");
    for (auto const& height : lane.heights)
      require(std::isfinite(height.s_offset) && std::isfinite(height.inner) && std::isfinite(height.outer),
              "a lane's height is not finite", "give finite numbers");
    for (auto const& speed : lane.speeds) check_speed(speed.s, speed.limit, "of a lane");
    for (auto const& mark : lane.road_marks)
      require(std::isfinite(mark.s_offset), "the s offset of a road mark is not finite", "give it in m");
  }

  void check_speed(double s, std::optional<double> const& limit, char const* of) const {
    if (!std::isfinite(s) || (limit && std::isnan(*limit)))
      throw MapError(where_, std::string("a speed ") + of + " is not a number", "give m and m/s");
  }

  void check_records(std::vector<CubicRecord> const& records, char const* of) const {
    for (auto const& record : records) check_record(record, of);
  }

  void check_record(CubicRecord const& r, char const* of) const {
    if (!is_finite(r)) throw MapError(where_, std::string("a record ") + of + " is not finite", "give finite numbers");
  }

  std::string where_;
};

}  // namespace cambium::inline v0_1::map::detail
