#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/map/lane.hpp"

namespace cambium::map {

/// Names no corridor.
inline constexpr std::uint16_t no_corridor = std::numeric_limits<std::uint16_t>::max();

/// A lane's stretch of a lane corridor.
struct CorridorPiece {
  LaneId lane = none<LaneId>;
  double begin{}, end{};             ///< corridor position [m]
  double index_offset{};             ///< lane coordinate = corridor position + index_offset
  std::uint16_t left = no_corridor;  ///< number of the corridor that holds the lane's left neighbour
  std::uint16_t right = no_corridor;
};

/// A stretch of a lane outside of the corridor whose traffic counts in it: a lane that merges in (from `merge_view`
/// before the overlap on), one that has just split off and still overlaps, or one that leads onto the corridor's first
/// lane. Lane coordinates [index_begin, index_end] map linearly onto corridor positions [begin, end].
struct Feeder {
  LaneId lane = none<LaneId>;
  double index_begin{}, index_end{};
  double begin{}, end{};
  /// Corridor position from which on the two lanes are one [m].
  double free_until = -std::numeric_limits<double>::infinity();

  [[nodiscard]] double image(double index) const {
    return begin + (index - index_begin) * (end - begin) / (index_end - index_begin);
  }
  [[nodiscard]] double index_at(double s) const {
    return index_begin + (s - begin) * (index_end - index_begin) / (end - begin);
  }
};

/// A chain of lanes along which a vehicle drives: what behaviours follow. Immutable, shared.
struct LaneCorridor {
  geometry::Line center;              ///< the lanes' paths, joined
  std::vector<SideWidths> widths;     ///< at the centre line's vertices
  geometry::Line left, right;         ///< borders
  std::vector<CorridorPiece> pieces;  ///< sorted by `begin`, gapless
  std::vector<Feeder> feeders;        ///< sorted by `begin`
  bool continues = false;             ///< the road goes on beyond the end: the corridor ends because the route does
  bool reaches_destination = false;   ///< it holds the route's last lane

  [[nodiscard]] double length() const { return center.length(); }

  /// Index of the piece that holds `s`, searched from `hint`.
  [[nodiscard]] std::uint16_t piece_at(double s, std::uint16_t hint) const {
    auto i = static_cast<std::size_t>(hint);
    while (i + 1 < pieces.size() && s >= pieces[i + 1].begin) ++i;
    while (i > 0 && s < pieces[i].begin) --i;
    return static_cast<std::uint16_t>(i);
  }

  /// Distances from the centre line to the lane's borders at `s` within `segment` of the centre line [m].
  [[nodiscard]] SideWidths widths_at(double s, std::uint32_t segment) const {
    auto const& g = center.segments()[segment];
    double const u = std::clamp((s - g.s) / g.length, 0.0, 1.0);
    auto const &a = widths[segment], &b = widths[segment + 1];
    return {a.left + u * (b.left - a.left), a.right + u * (b.right - a.right)};
  }
};

/// The lanes of a route and those beside them, as lane corridors. Immutable, built once per route and shared.
struct RoadCorridor {
  std::vector<LaneId> route;  ///< the lanes from start to destination, lane changes included
  std::vector<LaneCorridor> corridors;
  std::uint16_t main = 0;  ///< the corridor that holds the route's last lane

  /// Number of the first corridor that holds `lane`, `no_corridor` if none does. O(lanes).
  [[nodiscard]] std::uint16_t corridor_of(LaneId lane) const {
    for (std::size_t i = 0; i < corridors.size(); ++i)
      for (auto const& piece : corridors[i].pieces)
        if (piece.lane == lane) return static_cast<std::uint16_t>(i);
    return no_corridor;
  }
};

}  // namespace cambium::map
