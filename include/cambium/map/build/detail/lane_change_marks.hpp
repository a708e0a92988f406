#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::map::detail {

/// What the marks of a section say about changing lanes.
class LaneChangeMarks {
 public:
  explicit LaneChangeMarks(opendrive::LaneSection const& section) : section_(section) {}

  /// The stretches of the path of `lane` from which the marks permit a change to its neighbour `to`.
  [[nodiscard]] std::vector<PathStretch> permitted(Lane const& lane, Lane const& to) const {
    std::vector<double> stations{lane.road_begin, lane.road_end};
    auto const borders = borders_between(lane.number, to.number);
    for (auto const* border : borders)
      for (auto const& mark : border->road_marks)
        if (std::isfinite(mark.s_offset))
          stations.push_back(std::min(lane.road_begin + std::max(mark.s_offset, 0.0), lane.road_end));
    std::sort(stations.begin(), stations.end());
    std::vector<PathStretch> stretches;
    double end_of_last = -1.0;
    for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
      double const from = stations[i], until = stations[i + 1];
      if (until - from < 1e-6 || !is_permitted(borders, to.number > lane.number, from - lane.road_begin)) continue;
      auto const stretch = lane.stretch_between(from, until);
      if (from != end_of_last)
        stretches.push_back(stretch);
      else
        stretches.back() = {std::min(stretches.back().begin, stretch.begin),
                            std::max(stretches.back().end, stretch.end)};
      end_of_last = until;
    }
    if (!lane.along_road) std::reverse(stretches.begin(), stretches.end());
    return stretches;
  }

 private:
  using Borders = std::vector<opendrive::Lane const*>;

  /// The lanes whose marks are those of the borders between the lanes `a` and `b`: of each border the lane nearer to
  /// lane 0. Ids may be any distance apart.
  [[nodiscard]] Borders borders_between(int a, int b) const {
    int const low = std::min(a, b), high = std::max(a, b);
    Borders borders;
    auto at = std::partition_point(section_.lanes.begin(), section_.lanes.end(),
                                   [high](opendrive::Lane const& lane) { return lane.id > high; });
    for (; at != section_.lanes.end() && at->id >= low; ++at)
      if (at->id == 0 || at->id != (at->id > 0 ? high : low)) borders.push_back(&*at);
    return borders;
  }

  /// Whether the marks at `s` behind the section's start [m] let a vehicle change to the next higher (lower) lane.
  [[nodiscard]] static bool is_permitted(Borders const& borders, bool to_higher, double s) {
    using opendrive::LaneChange;
    for (auto const* border : borders) {
      auto const& marks = border->road_marks;
      auto const next = std::upper_bound(marks.begin(), marks.end(), s + 1e-9,
                                         [](double v, auto const& mark) { return v < mark.s_offset; });
      auto const change = next == marks.begin() ? LaneChange::unspecified : (next - 1)->lane_change;
      if (change == LaneChange::none || change == (to_higher ? LaneChange::decrease : LaneChange::increase))
        return false;
    }
    return true;
  }

  opendrive::LaneSection const& section_;
};

/// Fills `Lane::left_changes` and `right_changes` from the `laneChange` attributes of the road marks: a mark without
/// one permits both ways, as the standard says, and so does a border without a mark; what the mark looks like does not
/// count. Call it when neighbours and paths are final.
inline void set_lane_changes(OpenDriveDocument const& document, std::span<Lane> lanes) {
  for (auto& lane : lanes) {
    LaneChangeMarks const marks(document.roads[index_of(lane.road)].lane_sections[lane.section]);
    lane.left_changes = lane.right_changes = {};
    if (is_valid(lane.left_neighbor)) lane.left_changes = marks.permitted(lane, lanes[index_of(lane.left_neighbor)]);
    if (is_valid(lane.right_neighbor)) lane.right_changes = marks.permitted(lane, lanes[index_of(lane.right_neighbor)]);
  }
}

}  // namespace cambium::map::detail
