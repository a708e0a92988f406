#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "cambium/map/lane.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive_document.hpp"

namespace cambium::map::detail {

/// What the marks of a section say about changing lanes.
class LaneChangeMarks {
 public:
  explicit LaneChangeMarks(opendrive::LaneSection const& section) : section_(section) {}

  /// The stretches of the path of `lane` from which the marks permit a change to its neighbour `to`.
  [[nodiscard]] std::vector<PathStretch> permitted(Lane const& lane, Lane const& to) const {
    std::vector<double> stations{lane.road_begin, lane.road_end};
    int const low = std::min(lane.number, to.number), high = std::max(lane.number, to.number);
    for (int number = low; number < high; ++number)
      if (auto const* border = border_above(number))
        for (auto const& mark : border->road_marks)
          if (std::isfinite(mark.s_offset))
            stations.push_back(std::min(lane.road_begin + std::max(mark.s_offset, 0.0), lane.road_end));
    std::sort(stations.begin(), stations.end());
    std::vector<PathStretch> stretches;
    double end_of_last = -1.0;
    for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
      double const from = stations[i], until = stations[i + 1];
      if (until - from < 1e-6 || !is_permitted(lane.number, to.number, from - lane.road_begin)) continue;
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
  /// Whose marks are those of the border between the lanes `number` and `number` + 1: of the one nearer to lane 0.
  [[nodiscard]] opendrive::Lane const* border_above(int number) const {
    return section_.find(number >= 0 ? number : number + 1);
  }

  /// Whether the marks at `s` behind the section's start [m] let a vehicle from lane `from` into lane `to`.
  [[nodiscard]] bool is_permitted(int from, int to, double s) const {
    using opendrive::LaneChange;
    for (int number = std::min(from, to); number < std::max(from, to); ++number) {
      auto const* border = border_above(number);
      auto change = LaneChange::unspecified;
      if (border)
        for (auto const& mark : border->road_marks)
          if (mark.s_offset <= s + 1e-9) change = mark.lane_change;
      if (change == LaneChange::none || change == (to > from ? LaneChange::decrease : LaneChange::increase))
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
