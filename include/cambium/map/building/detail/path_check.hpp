#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "cambium/core/error.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/road.hpp"

namespace cambium::inline v0_1::map::detail {

/// How much a path turns within a metre where it turns most [rad], and where that begins [m].
struct SharpestTurn {
  double turn = 0.0, s = 0.0;
};

[[nodiscard]] inline SharpestTurn sharpest_turn(geometry::Line const& path) {
  auto const segments = path.segments();
  auto const turn = [&](std::size_t i) { return std::abs(segments[i].curvature) * segments[i].length; };
  SharpestTurn sharpest;
  double sum = 0.0;
  std::size_t first = 0;
  for (std::size_t last = 0; last < segments.size(); ++last) {
    sum += turn(last);
    while (first < last &&
           segments[last].s + segments[last].length - (segments[first].s + segments[first].length) > 1.0)
      sum -= turn(first++);
    if (sum > sharpest.turn) sharpest = {sum, segments[first].s};
  }
  return sharpest;
}

/// Whether a lane's path runs against its own direction along the road somewhere, as a lane beyond the centre of a bend
/// does.
[[nodiscard]] inline bool runs_back(Lane const& lane, Road const& road) {
  auto const segments = lane.path.segments();
  return std::any_of(segments.begin(), segments.end(), [&](auto const& segment) {
    double const along =
        road.reference_line.at(lane.station_at(segment.s)).heading + (lane.along_road ? 0.0 : geometry::pi);
    return std::abs(geometry::angle_difference(segment.heading, along)) > 0.75 * geometry::pi;
  });
}

/// Where a path first moves by more than 0.5 rad off its own heading [m]; nothing where it never does.
[[nodiscard]] inline std::optional<double> moves_sideways(geometry::Line const& path) {
  constexpr double most = 0.5, shortest = 0.2;  // [rad], [m] of a step
  for (auto const& segment : path.segments()) {
    double const middle = segment.heading + 0.5 * segment.curvature * segment.length;
    if (segment.length >= shortest &&
        std::abs(geometry::angle_difference(portable::atan2(segment.uy, segment.ux), middle)) > most)
      return segment.s;
  }
  return std::nullopt;
}

[[nodiscard]] inline bool has_no_width(SideWidths const& widths) { return widths.left + widths.right < 0.1; }

/// Where a lane that has a width before and behind has none [m]; nothing where that is nowhere. Lanes may open and
/// close at their ends.
[[nodiscard]] inline std::optional<double> pinched_at(Lane const& lane) {
  auto const& widths = lane.widths;
  auto const first = std::find_if_not(widths.begin(), widths.end(), has_no_width);
  auto const none = std::find_if(first, widths.end(), has_no_width);
  if (std::find_if_not(none, widths.end(), has_no_width) == widths.end()) return std::nullopt;
  auto const i = static_cast<std::size_t>(none - widths.begin());
  return i < lane.path.segments().size() ? lane.path.segments()[i].s : lane.length();
}

/// Adds findings about lanes, with their names and lines in the file.
struct LaneFindings {
  std::span<Road const> roads;
  OpenDriveDocument const& document;
  Findings& findings;
  bool roads_are_lanelets = false;

  void add(Lane const& lane, Severity severity, std::string sentence) const {
    auto const& road = roads[index_of(lane.road)];
    auto const* const written = document.roads[index_of(lane.road)].lane_sections[lane.section].find(lane.number);
    int const line = written != nullptr ? static_cast<int>(written->line) : 0;
    if (roads_are_lanelets)
      findings.add(severity, line, "lanelet", "lanelet " + road.name, std::move(sentence));
    else
      findings.add(
          severity, line, "lane",
          "road " + road.name + ", section " + std::to_string(lane.section) + ", lane " + std::to_string(lane.number),
          std::move(sentence));
  }
};

/// Reports drivable lanes that no vehicle can follow: their paths turn by more than 1 rad within a metre, run back, as
/// on the inner side of a bend that is tighter than the lane is far from it, or move sideways; or they have no width.
inline void report_paths(std::span<Lane const> lanes, LaneFindings const& findings) {
  constexpr double sharpest = 1.0;  // [rad], a radius of a metre
  using cambium::detail::rounded_text;
  auto const place = [](double s) { return rounded_text(std::round(s * 100) / 100) + " m from its begin"; };
  for (auto const& lane : lanes) {
    if (!lane.drivable()) continue;
    auto const report = [&](std::string sentence) { findings.add(lane, Severity::warning, std::move(sentence)); };
    auto const found = sharpest_turn(lane.path);
    if (found.turn > sharpest)
      report("its path turns by " + rounded_text(std::round(found.turn * 100) / 100) + " rad within a metre, " +
             place(found.s) + ": no vehicle can follow it");
    else if (runs_back(lane, findings.roads[index_of(lane.road)]))
      report("its path runs backwards: the road bends more tightly than the lane lies from its reference line");
    else if (auto const s = moves_sideways(lane.path))
      report("its path moves sideways, " + place(*s) + ": no vehicle can follow it");
    if (std::all_of(lane.widths.begin(), lane.widths.end(), has_no_width))
      report("the lane is drivable but has no width");
    else if (auto const s = pinched_at(lane))
      report("the lane has no width, " + place(*s));
  }
}

}  // namespace cambium::inline v0_1::map::detail
