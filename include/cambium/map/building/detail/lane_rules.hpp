#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/opendrive/document.hpp"

/// What a document says about driving in lanes: speed limits, lane changes, signs and lights.
namespace cambium::inline v0_1::map::detail {

/// The limit of the last of `records` that begins at or before `s` [m/s]; nothing where that one has none that is one.
template <class Record>
[[nodiscard]] std::optional<double> limit_in_force(std::vector<Record> const& records, double s) {
  auto const next =
      std::upper_bound(records.begin(), records.end(), s + 1e-9, [](double v, Record const& r) { return v < r.s; });
  auto const limit = next == records.begin() ? std::nullopt : (next - 1)->limit;
  return limit && is_speed_limit(*limit) ? limit : std::nullopt;
}

/// Reports limits that are none: how many, and the first.
inline void report_speed_limits(OpenDriveDocument const& document, Findings& findings) {
  int count = 0;
  std::string first;
  auto const look = [&](opendrive::RoadElement const& road, std::optional<double> limit) {
    if (!limit || is_speed_limit(*limit)) return;
    if (count++ == 0) first = "road " + road.id + ": " + cambium::detail::rounded_text(*limit) + " m/s";
  };
  for (auto const& road : document.roads) {
    for (auto const& type : road.types) look(road, type.limit);
    for (auto const& section : road.lane_sections)
      for (auto const& lane : section.lanes)
        for (auto const& speed : lane.speeds) look(road, speed.limit);
  }
  if (count > 0)
    findings.add(
        Severity::warning, 0, "speed", {},
        std::to_string(count) + " speed limits are not between 0.1 and 200 m/s and count as none; the first: " + first);
}

/// Fills `Lane::speed_limits`: the lane's own records where one gives a limit ("no limit" is one), else the road's. Of
/// roads, a type record without a speed ends the limit before it. Call it when the paths are final.
inline void set_speed_limits(OpenDriveDocument const& document, std::span<Lane> lanes) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (auto& lane : lanes) {
    auto const& source = document.roads[index_of(lane.road)];
    auto const& section = source.lane_sections[lane.section];
    auto const& written = *section.find(lane.number);
    std::vector<double> stations{lane.road_begin};
    auto const add = [&](double s) {
      if (std::isfinite(s)) stations.push_back(s);
    };
    auto type = std::partition_point(source.types.begin(), source.types.end(),
                                     [&](auto const& t) { return t.s < lane.road_begin; });
    for (; type != source.types.end() && type->s < lane.road_end; ++type) add(type->s);
    for (auto const& speed : written.speeds) add(lane.road_begin + speed.s);
    std::sort(stations.begin(), stations.end());
    std::vector<SpeedStep> steps;
    for (std::size_t i = 0; i < stations.size(); ++i) {
      double const from = stations[i],
                   to = i + 1 < stations.size() ? std::min(stations[i + 1], lane.road_end) : lane.road_end;
      if (!(from >= lane.road_begin && to - from > 1e-6)) continue;
      auto const own = limit_in_force(written.speeds, from - lane.road_begin);
      double const limit = own ? *own : limit_in_force(source.types, from).value_or(infinity);
      steps.push_back({lane.stretch_between(from, to).begin, limit});
    }
    if (!lane.along_road) std::reverse(steps.begin(), steps.end());
    auto const same = [](SpeedStep const& a, SpeedStep const& b) { return a.limit == b.limit; };
    steps.erase(std::unique(steps.begin(), steps.end(), same), steps.end());
    if (steps.size() == 1 && steps[0].limit == infinity) steps.clear();
    lane.speed_limits = std::move(steps);
  }
}

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
  using Borders = std::vector<opendrive::LaneElement const*>;

  /// The lanes whose marks are those of the borders between the lanes `a` and `b`: of each border the lane nearer to
  /// lane 0. Ids may be any distance apart.
  [[nodiscard]] Borders borders_between(int a, int b) const {
    int const low = std::min(a, b), high = std::max(a, b);
    Borders borders;
    auto at = std::partition_point(section_.lanes.begin(), section_.lanes.end(),
                                   [high](opendrive::LaneElement const& lane) { return lane.id > high; });
    for (; at != section_.lanes.end() && at->id >= low; ++at)
      if (at->id == 0 || at->id != (at->id > 0 ? high : low)) borders.push_back(&*at);
    return borders;
  }

  /// Whether the marks at `s` [m] from the section's start let a vehicle change to the next higher (lower) lane.
  [[nodiscard]] static bool is_permitted(Borders const& borders, bool to_higher, double s) {
    using opendrive::LaneChangePermission;
    for (auto const* border : borders) {
      auto const& marks = border->road_marks;
      auto const next = std::upper_bound(marks.begin(), marks.end(), s + 1e-9,
                                         [](double v, auto const& mark) { return v < mark.s_offset; });
      auto const change = next == marks.begin() ? LaneChangePermission::unspecified : (next - 1)->lane_change;
      if (change == LaneChangePermission::none ||
          change == (to_higher ? LaneChangePermission::decrease : LaneChangePermission::increase))
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

}  // namespace cambium::inline v0_1::map::detail
