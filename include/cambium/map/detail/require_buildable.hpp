#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/map/cubic.hpp"
#include "cambium/map/opendrive_document.hpp"
#include "cambium/map/reference_line.hpp"

namespace cambium::map::detail {

/// Throws `MapError` where a document, which may have been made or changed in code, lacks what the reader guarantees
/// and a map cannot be made without. Linear in the document.
class RequireBuildable {
 public:
  static void check(OpenDriveDocument const& document) {
    auto const& offset = document.header.offset;
    RequireBuildable("header").require(std::isfinite(offset.x + offset.y + offset.z + offset.heading),
                                       "its offset is not finite", "give finite numbers");
    std::unordered_set<std::string_view> ids;
    for (auto const& road : document.roads) {
      RequireBuildable const here("road " + road.id);
      here.require(ids.insert(road.id).second, "another road has the same id", "give each road an id of its own");
      here.check_line(road);
      for (auto const* records : {&road.elevation, &road.superelevation, &road.lane_offset})
        here.check_records(*records, "of the road");
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

  /// The bounds are the reader's.
  void check_line(opendrive::Road const& road) const {
    constexpr double farthest = 1e8, longest = 1e6, most_turn = 1000.0;  // [m], [m], [rad]
    for (auto const& g : road.geometries) {
      require(std::max(std::abs(g.x), std::abs(g.y)) <= farthest && std::abs(g.heading) <= 1e4 &&
                  std::abs(g.s) <= longest && g.length >= 0.0 && g.length <= longest,
              "a geometry has a number that is not finite or beyond any map, or a length below 0",
              "give m and rad; see lay_from");
      require(std::max(std::abs(g.curvature_start), std::abs(g.curvature_end)) * g.length < most_turn &&
                  std::isfinite(g.curvature_start + g.curvature_end),
              "a geometry turns by more than 1000 rad, or its curvature is not finite", "give curvatures in 1/m");
      require(g.kind != GeometryKind::cubic || (g.cubic != nullptr && g.length > 0.0 && g.cubic->length() <= longest),
              "a geometry of the kind cubic has no curve, or no length", "set its cubic and length");
    }
    bool const is_sorted = std::is_sorted(road.geometries.begin(), road.geometries.end(),
                                          [](Geometry const& a, Geometry const& b) { return a.s < b.s; });
    require(is_sorted, "its geometries are not in the order of s", "sort them");
    require(road.geometry_length() > 0.0, "it has no geometry with a length", "lay out a line, see lay_from");
  }

  void check_sections(opendrive::Road const& road) const {
    require(!road.lane_sections.empty(), "it has no lane section", "add one at 0");
    for (std::size_t k = 0; k < road.lane_sections.size(); ++k) {
      auto const& section = road.lane_sections[k];
      require(std::isfinite(section.s) && (k == 0 || road.lane_sections[k - 1].s <= section.s),
              "its lane sections are not in the order of s", "sort them; s must be finite");
      bool const is_ordered = std::adjacent_find(section.lanes.begin(), section.lanes.end(),
                                                 [](opendrive::Lane const& left, opendrive::Lane const& right) {
                                                   return left.id <= right.id;
                                                 }) == section.lanes.end();
      require(is_ordered, "the lanes of a section do not stand from left to right, or one is there twice",
              "sort them by falling id");
      for (auto const& lane : section.lanes) check_lane(lane);
    }
  }

  void check_lane(opendrive::Lane const& lane) const {
    check_records(lane.widths, "of a lane's width");
    check_records(lane.borders, "of a lane's border");
    for (auto const& height : lane.heights)
      require(std::isfinite(height.s_offset + height.inner + height.outer), "a lane's height is not finite",
              "give finite numbers");
    for (auto const& speed : lane.speeds)
      require(std::isfinite(speed.s) && !(speed.limit && std::isnan(*speed.limit)), "a lane's speed is not a number",
              "give m and m/s");
    for (auto const& mark : lane.road_marks)
      require(std::isfinite(mark.s_offset), "a road mark begins at no finite place", "give it in m");
  }

  void check_records(std::vector<CubicRecord> const& records, char const* of) const {
    for (auto const& record : records) check_record(record, of);
  }

  void check_record(CubicRecord const& r, char const* of) const {
    if (!std::isfinite(r.s + r.a + r.b + r.c + r.d))
      throw MapError(where_, std::string("a record ") + of + " is not finite", "give finite numbers");
  }

  std::string where_;
};

}  // namespace cambium::map::detail
