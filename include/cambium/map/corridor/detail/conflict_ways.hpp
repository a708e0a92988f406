#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/map.hpp"

namespace cambium::map::detail {

/// Adds the lanes downstream (`ahead`) or upstream of `lane`, as far as way position `until` [m], each once, by the
/// shortest way.
inline void add_ways_beyond(Map const& map, Lane const& lane, bool ahead, double until,
                            std::vector<ConflictWay>& ways) {
  struct Way {
    LaneId lane;
    double far_end;  // [m]
  };
  std::vector<bool> seen(map.lanes().size());
  std::vector<Way> open{{lane.id, ahead ? lane.length() : 0.0}};
  for (std::size_t i = 0; i < open.size(); ++i) {
    auto const way = open[i];
    if (ahead ? way.far_end >= until : way.far_end <= until) continue;
    for (auto const id : ahead ? map.lane(way.lane).successors : map.lane(way.lane).predecessors) {
      auto const& next = map.lane(id);
      if (!next.drivable() || id == lane.id || seen[index_of(id)]) continue;
      seen[index_of(id)] = true;
      double const far_end = ahead ? way.far_end + next.length() : way.far_end - next.length();
      double const from = ahead ? 0.0 : std::max(0.0, until - far_end);  // on the lane
      double const to = ahead ? std::min(next.length(), until - way.far_end) : next.length();
      ways.push_back({next.index_begin + from, next.index_begin + to, ahead ? way.far_end : far_end + from});
      open.push_back({id, far_end});
    }
  }
}

/// The ways by which traffic comes to, and leaves, positions `from` to `to` [m] of `lane`, see `Conflict::ways`.
[[nodiscard]] inline std::vector<ConflictWay> ways_through(Map const& map, Lane const& lane, double from, double to) {
  double const begin = std::max(0.0, from);
  std::vector<ConflictWay> ways{{lane.index_begin + begin, lane.index_begin + lane.length(), begin}};
  add_ways_beyond(map, lane, true, to, ways);
  add_ways_beyond(map, lane, false, from, ways);
  return ways;
}

}  // namespace cambium::map::detail
