#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/map.hpp"

namespace cambium::map::detail {

/// Adds the lanes behind `lane`, back to way position `until` [m], each once by its shortest way.
inline void add_ways_behind(Map const& map, Lane const& lane, double until, std::vector<ConflictWay>& ways) {
  struct Way {
    LaneId lane;
    double begin;  // [m]
  };
  std::vector<bool> seen(map.lanes().size());
  std::vector<Way> open{{lane.id, 0.0}};
  for (std::size_t i = 0; i < open.size(); ++i) {
    auto const way = open[i];
    if (way.begin <= until) continue;
    for (auto const before : map.lane(way.lane).predecessors) {
      auto const& previous = map.lane(before);
      if (!previous.drivable() || before == lane.id || seen[index_of(before)]) continue;
      seen[index_of(before)] = true;
      double const begin = way.begin - previous.length(), from = std::max(0.0, until - begin);
      ways.push_back({previous.index_begin + from, previous.index_begin + previous.length(), begin + from});
      open.push_back({before, begin});
    }
  }
}

/// Adds the lanes ahead of `lane`, up to way position `until` [m], each once by its shortest way.
inline void add_ways_ahead(Map const& map, Lane const& lane, double until, std::vector<ConflictWay>& ways) {
  struct Way {
    LaneId lane;
    double end;  // [m]
  };
  std::vector<bool> seen(map.lanes().size());
  std::vector<Way> open{{lane.id, lane.length()}};
  for (std::size_t i = 0; i < open.size(); ++i) {
    auto const way = open[i];
    if (way.end >= until) continue;
    for (auto const after : map.lane(way.lane).successors) {
      auto const& next = map.lane(after);
      if (!next.drivable() || after == lane.id || seen[index_of(after)]) continue;
      seen[index_of(after)] = true;
      ways.push_back({next.index_begin, next.index_begin + std::min(next.length(), until - way.end), way.end});
      open.push_back({after, way.end + next.length()});
    }
  }
}

/// The ways by which traffic comes to, and leaves, positions `from` to `to` [m] of `lane`, see `Conflict::ways`.
[[nodiscard]] inline std::vector<ConflictWay> ways_through(Map const& map, Lane const& lane, double from, double to) {
  double const begin = std::max(0.0, from);
  std::vector<ConflictWay> ways{{lane.index_begin + begin, lane.index_begin + lane.length(), begin}};
  add_ways_ahead(map, lane, to, ways);
  add_ways_behind(map, lane, from, ways);
  return ways;
}

}  // namespace cambium::map::detail
