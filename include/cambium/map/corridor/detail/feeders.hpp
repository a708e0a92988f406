#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/map.hpp"

/// Feeders: vehicles in other lanes that a driver on the corridor has to keep a gap to.
///
/// Car following needs one axis on which leader and follower have positions. A vehicle that is about to merge is not on
/// the corridor, so it gets an image there: its distance from the point where the two lanes become one, laid off on the
/// corridor, back from the same point. A feeder is a stretch of a lane with such images.
///
///     corridor  ----------[ image of the feeder ]+------------> s
///                                               /
///     ramp          =====[ feeder: merge_view ]'
///
/// There are four kinds: the overlaps with lanes that merge in or have just split off, the lanes upstream of the
/// corridor, the lanes that lead to a merge, and the lanes that lead on from its end, where a vehicle may reach back
/// into the corridor. A stretch of a lane has one image only: a kind named earlier wins.
namespace cambium::inline v0_1::map::detail {

/// Finds the feeders of a lane corridor whose `pieces` are known, see `build_road_corridor`.
class FeederFinder {
 public:
  FeederFinder(Map const& map, LaneCorridor& corridor) : map_(map), corridor_(corridor) {}

  void find() {
    constexpr double rear_view = 100.0;  // [m] before the corridor's begin
    constexpr double front_view = 30.0;  // [m] beyond its end: no two bodies across it reach as far
    constexpr double never = -std::numeric_limits<double>::infinity();
    corridor_.feeders.clear();
    for (auto const& piece : corridor_.pieces)
      for (auto const& overlap : map_.lane(piece.lane).overlaps) add_overlap(piece, overlap);
    auto const& first = corridor_.pieces.front();
    add_predecessors(first.lane, rear_view, first.begin, never, true);
    for (std::size_t i = 0; i < corridor_.pieces.size(); ++i) {
      auto const& piece = corridor_.pieces[i];
      auto const& lane = map_.lane(piece.lane);
      if (i > 0) add_predecessors(piece.lane, map_.options().merge_view, piece.begin, piece.begin, false);
      for (auto const& overlap : lane.overlaps)
        if (overlap.kind == OverlapKind::merge && !holds(overlap.other))
          add_upstream_of(overlap, position(piece, overlap.begin));
    }
    if (corridor_.continues) add_successors(front_view);
    cambium::detail::stable_sort(corridor_.feeders,
                                 [](Feeder const& f) { return std::tuple(f.begin, f.lane, f.index_begin); });
  }

 private:
  [[nodiscard]] bool holds(LaneId lane) const {
    return std::any_of(corridor_.pieces.begin(), corridor_.pieces.end(),
                       [lane](CorridorPiece const& p) { return p.lane == lane; });
  }

  /// Corridor position of path position `s` of the piece's lane.
  [[nodiscard]] double position(CorridorPiece const& piece, double s) const {
    return map_.lane(piece.lane).index_begin + s - piece.index_offset;
  }

  void add_overlap(CorridorPiece const& piece, Overlap const& overlap) {
    if (overlap.kind == OverlapKind::crossing || holds(overlap.other)) return;
    double const begin = position(piece, overlap.begin), end = position(piece, overlap.end);
    double const index = map_.lane(overlap.other).index_begin;
    double const free_until = overlap.kind == OverlapKind::merge ? begin : -std::numeric_limits<double>::infinity();
    add({overlap.other, index + overlap.other_begin, index + overlap.other_end, begin, end, free_until});
  }

  /// The merging lane upstream of the overlap, and the lanes that lead to it.
  void add_upstream_of(Overlap const& overlap, double begin) {
    double const view = map_.options().merge_view;
    auto const& other = map_.lane(overlap.other);
    double const length = std::min(view, overlap.other_begin);
    add({other.id, other.index_begin + overlap.other_begin - length, other.index_begin + overlap.other_begin,
         begin - length, begin, begin});
    if (length < view) add_predecessors(other.id, view - length, begin - length, begin, false);
  }

  /// Adds the predecessors of `lane` and those behind them, up to `view` [m] back; `end` is the image of the lane's
  /// begin.
  void add_predecessors(LaneId lane, double view, double end, double free_until, bool with_own) {
    auto const add_before = [&](Lane const& before, double length, double at) {
      double const index_end = before.index_begin + before.length();
      add({before.id, index_end - length, index_end, at - length, at, free_until});
      return at - length;
    };
    follow(lane, &Lane::predecessors, view, end, with_own, add_before);
  }

  /// Adds the lanes to which the corridor's last lane leads, up to `view` [m] beyond its end; its own lanes as well, to
  /// which a ring comes back.
  void add_successors(double view) {
    auto const add_next = [&](Lane const& next, double length, double at) {
      add({next.id, next.index_begin, next.index_begin + length, at, at + length});
      return at + length;
    };
    follow(corridor_.pieces.back().lane, &Lane::successors, view, corridor_.length(), true, add_next);
  }

  /// Calls `visit(lane, length, at)` for the lanes to which `links` lead from `lane`, and those farther along, up to
  /// `view` [m]: `length` of each is in view, `at` the image of its near end; it returns that of its far end. Each way
  /// is followed to its end before the next. A lane reached again contributes only its new part, so that lanes linked
  /// crosswise or in rings are not followed over and over.
  template <class Links, class Visit>
  void follow(LaneId lane, Links links, double view, double at, bool with_own, Visit const& visit) const {
    constexpr double worth_it = 0.01;  // [m]
    struct Way {
      LaneId lane;
      double view, at;
    };
    std::vector<Way> open;
    std::map<LaneId, double> seen;  // the largest view
    auto const open_from = [&](Way const& way) {
      auto const& linked = map_.lane(way.lane).*links;
      for (auto i = linked.rbegin(); i != linked.rend(); ++i)
        if (map_.lane(*i).drivable() && (with_own || !holds(*i))) open.push_back({*i, way.view, way.at});
    };
    for (open_from({lane, view, at}); !open.empty();) {
      auto const way = open.back();
      open.pop_back();
      auto const [mark, is_new] = seen.emplace(way.lane, way.view);
      if (!is_new && way.view < mark->second + worth_it) continue;
      mark->second = way.view;
      auto const& next = map_.lane(way.lane);
      double const length = std::min(way.view, next.length());
      double const far_end = visit(next, length, way.at);
      if (length < way.view) open_from({way.lane, way.view - length, far_end});
    }
  }

  /// Adds the parts of `f` that have no image yet.
  void add(Feeder const& f) {
    constexpr double shortest = 1e-6;  // [m]
    if (f.index_end - f.index_begin < shortest) return;
    std::vector<Feeder> taken;
    for (auto const& other : corridor_.feeders)
      if (other.lane == f.lane && other.index_begin < f.index_end - shortest &&
          other.index_end > f.index_begin + shortest)
        taken.push_back(other);
    cambium::detail::stable_sort(taken, &Feeder::index_begin);
    double from = f.index_begin;
    auto const add_part = [&](double to) {
      if (to - from > shortest)
        corridor_.feeders.push_back({f.lane, from, to, f.image(from), f.image(to), f.free_until});
    };
    for (auto const& other : taken) {
      add_part(other.index_begin);
      from = std::max(from, other.index_end);
    }
    add_part(f.index_end);
  }

  Map const& map_;
  LaneCorridor& corridor_;
};

}  // namespace cambium::inline v0_1::map::detail
