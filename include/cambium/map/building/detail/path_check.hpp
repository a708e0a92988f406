#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "cambium/core/error.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/road.hpp"

namespace cambium::map::detail {

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

/// Reports drivable lanes that no vehicle can follow: their paths turn by more than 1 rad within a metre or run back,
/// as on the inner side of a bend that is tighter than the lane is far from it; or they have no width.
inline void report_paths(std::span<Lane const> lanes, std::span<Road const> roads, OpenDriveDocument const& document,
                         Findings& findings) {
  constexpr double sharpest = 1.0;  // [rad], a radius of a metre
  using cambium::detail::rounded_text;
  for (auto const& lane : lanes) {
    if (!lane.drivable()) continue;
    auto const& road = roads[index_of(lane.road)];
    auto const report = [&](std::string sentence) {
      auto const* const written = document.roads[index_of(lane.road)].lane_sections[lane.section].find(lane.number);
      findings.add(
          Severity::warning, written != nullptr ? static_cast<int>(written->line) : 0, "lane",
          "road " + road.name + ", section " + std::to_string(lane.section) + ", lane " + std::to_string(lane.number),
          std::move(sentence));
    };
    auto const found = sharpest_turn(lane.path);
    if (found.turn > sharpest)
      report("its path turns by " + rounded_text(std::round(found.turn * 100) / 100) + " rad within a metre, " +
             rounded_text(std::round(found.s * 100) / 100) + " m from its begin: no vehicle can follow it");
    else if (runs_back(lane, road))
      report("its path runs backwards: the road bends more tightly than the lane lies from its reference line");
    if (std::all_of(lane.widths.begin(), lane.widths.end(), [](SideWidths const& w) { return w.left + w.right < 0.1; }))
      report("it is driven on, but has no width");
  }
}

}  // namespace cambium::map::detail
