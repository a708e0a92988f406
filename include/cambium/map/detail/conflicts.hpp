#pragma once

#include <algorithm>
#include <map>
#include <tuple>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/map/corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/right_of_way.hpp"

namespace cambium::map::detail {

/// The ways that lead to path position `at` of `lane`, `view` [m] back: the lane itself, then those behind it, each
/// lane once by its shortest way.
[[nodiscard]] inline std::vector<ApproachStretch> approaches_to(Map const& map, LaneId id, double at, double view) {
  struct Way {
    LaneId lane;
    double end, to_conflict;  // [m]: path position where the stretch ends, and from there
  };
  std::map<LaneId, double> seen;  // shortest way from its end
  std::vector<Way> open{{id, at, 0.0}};
  std::vector<ApproachStretch> approaches;
  for (std::size_t i = 0; i < open.size(); ++i) {
    auto const way = open[i];
    auto const& lane = map.lane(way.lane);
    double const length = std::min(way.end, view - way.to_conflict);
    if (length > 0.0)
      approaches.push_back({lane.index_begin + way.end - length, lane.index_begin + way.end, way.to_conflict});
    double const behind = way.to_conflict + way.end;
    if (behind >= view) continue;
    for (auto const before : lane.predecessors) {
      auto const& previous = map.lane(before);
      if (!previous.drivable() || before == id || !seen.emplace(before, behind).second) continue;
      open.push_back({before, previous.length(), behind});
    }
  }
  return approaches;
}

/// Where lanes outside of the corridor cross it or merge with it in a junction, see `build_road_corridor`.
[[nodiscard]] inline std::vector<Conflict> find_conflicts(Map const& map, LaneCorridor const& corridor) {
  std::vector<Conflict> conflicts;
  auto const holds = [&corridor](LaneId lane) {
    return std::any_of(corridor.pieces.begin(), corridor.pieces.end(),
                       [lane](CorridorPiece const& p) { return p.lane == lane; });
  };
  for (auto const& piece : corridor.pieces) {
    auto const& lane = map.lane(piece.lane);
    for (auto const& overlap : lane.overlaps) {
      bool const in_junction = is_valid(map.road(lane.road).junction);
      if (overlap.kind == OverlapKind::split || (overlap.kind == OverlapKind::merge && !in_junction)) continue;
      if (holds(overlap.other)) continue;
      auto const& other = map.lane(overlap.other);
      auto const position = [&](double s) { return std::clamp(s - piece.lane_offset, piece.begin, piece.end); };
      conflicts.push_back({overlap.other, overlap.kind, right_of_way(map, piece.lane, overlap), position(overlap.begin),
                           position(overlap.end), other.index_begin + overlap.other_begin,
                           other.index_begin + overlap.other_end,
                           approaches_to(map, overlap.other, overlap.other_begin, map.options().merge_view)});
    }
  }
  std::sort(conflicts.begin(), conflicts.end(), [](Conflict const& a, Conflict const& b) {
    return std::tie(a.begin, a.other, a.index_begin) < std::tie(b.begin, b.other, b.index_begin);
  });
  return conflicts;
}

}  // namespace cambium::map::detail
