#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/map/corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/right_of_way.hpp"

namespace cambium::map::detail {

/// Adds the lanes behind `lane`, back to way position `until` [m], each once by its shortest way.
inline void add_ways_behind(Map const& map, Lane const& lane, double until, std::vector<ConflictWay>& ways) {
  struct Way {
    LaneId lane;
    double begin;  // [m]
  };
  std::set<LaneId> seen;
  std::vector<Way> open{{lane.id, 0.0}};
  for (std::size_t i = 0; i < open.size(); ++i) {
    auto const way = open[i];
    if (way.begin <= until) continue;
    for (auto const before : map.lane(way.lane).predecessors) {
      auto const& previous = map.lane(before);
      if (!previous.drivable() || before == lane.id || !seen.insert(before).second) continue;
      double const begin = way.begin - previous.length(), from = std::max(0.0, until - begin);
      ways.push_back({previous.index_begin + from, previous.index_begin + previous.length(), begin + from});
      open.push_back({before, begin});
    }
  }
}

/// The ways by which traffic comes to, and leaves, positions `from` to `to` [m] of `lane`, see `Conflict::ways`.
[[nodiscard]] inline std::vector<ConflictWay> ways_through(Map const& map, Lane const& lane, double from, double to) {
  double const begin = std::max(0.0, from);
  std::vector<ConflictWay> ways{{lane.index_begin + begin, lane.index_begin + lane.length(), begin}};
  for (auto const id : lane.successors) {
    auto const& next = map.lane(id);
    if (to > lane.length())
      ways.push_back({next.index_begin, next.index_begin + std::min(next.length(), to - lane.length()), lane.length()});
  }
  add_ways_behind(map, lane, from, ways);
  return ways;
}

/// Finds the conflicts of a lane corridor whose centre line and pieces are there already, see `Conflict`.
class ConflictFinder {
 public:
  ConflictFinder(Map const& map, LaneCorridor const& corridor)
      : map_(map), corridor_(corridor), body_(map.options().large_conflict_shape) {}

  [[nodiscard]] std::vector<Conflict> find() const {
    std::vector<Conflict> conflicts;
    for (std::size_t i = 0; i < corridor_.pieces.size(); ++i) {
      auto const& lane = map_.lane(corridor_.pieces[i].lane);
      for (auto const& overlap : lane.overlaps)
        if (auto conflict = conflict_at(i, overlap)) conflicts.push_back(std::move(*conflict));
      for (auto const& overlap : passings(lane))
        if (auto conflict = conflict_at(i, overlap)) conflicts.push_back(std::move(*conflict));
    }
    for (auto& conflict : conflicts) unite(conflict, conflicts);
    set_holds(conflicts);
    std::sort(conflicts.begin(), conflicts.end(), [](Conflict const& a, Conflict const& b) {
      return std::tie(a.hull().begin, a.other, a.hull().other_begin) <
             std::tie(b.hull().begin, b.other, b.hull().other_begin);
    });
    return conflicts;
  }

 private:
  static constexpr double step = 0.5;      // [m] between two places of a body
  static constexpr double shortest = 1.0;  // [m] of a lane on which a body swings out
  /// How far before and behind an overlap of paths the bodies may touch [m].
  [[nodiscard]] double before() const { return body_.length() + 8.0; }
  [[nodiscard]] double behind() const { return body_.rear + 8.0; }

  [[nodiscard]] std::optional<Conflict> conflict_at(std::size_t number, Overlap const& overlap) const {
    auto const& piece = corridor_.pieces[number];
    bool const in_junction = is_valid(junction_of(piece.lane));
    if (overlap.kind == OverlapKind::merge && !in_junction) return std::nullopt;
    auto const position = [&](double s) { return std::clamp(s - piece.lane_offset, piece.begin, piece.end); };
    Conflict conflict;
    conflict.other = overlap.other;
    conflict.kind = kind_of(map_.lane(piece.lane), overlap);
    conflict.right_of_way = right_of_way(map_, piece.lane, overlap);
    double const begin = position(overlap.begin), end = position(overlap.end);
    conflict.shift = conflict.kind == OverlapKind::split ? begin - overlap.other_begin : end - overlap.other_end;
    if (overlap.kind == OverlapKind::merge) conflict.meet = begin;
    if (!find_zones(range_of(overlap, begin, end, conflict.kind), number, conflict)) return std::nullopt;
    conflict.hold.fill(junction_begin(number));
    conflict.lane_end = piece.end;
    conflict.other_lane_end = map_.lane(overlap.other).length();
    conflict.other_light = signs_before(map_, map_.lane(overlap.other)).light;
    add_ways(conflict);
    return conflict;
  }

  /// The lanes outside of a lane's junction from which one comes to it (`ahead`: to which it leads); outside of
  /// junctions those next to it.
  [[nodiscard]] std::vector<LaneId> ends_of(Lane const& lane, bool ahead) const {
    auto const junction = junction_of(lane.id);
    std::vector<LaneId> ends, open{lane.id};
    for (std::size_t i = 0; i < open.size() && i < 64; ++i)
      for (auto const id : ahead ? map_.lane(open[i]).successors : map_.lane(open[i]).predecessors) {
        bool const outside = !is_valid(junction) || junction_of(id) != junction;
        auto& list = outside ? ends : open;
        if (std::find(list.begin(), list.end(), id) == list.end()) list.push_back(id);
      }
    return ends;
  }
  [[nodiscard]] bool share_ends(Lane const& a, Lane const& b, bool ahead) const {
    auto const of_a = ends_of(a, ahead), of_b = ends_of(b, ahead);
    return std::any_of(of_a.begin(), of_a.end(),
                       [&](LaneId id) { return std::find(of_b.begin(), of_b.end(), id) != of_b.end(); });
  }

  /// Lanes that come from, or lead into, lanes side by side are near each other there too, and may cross.
  [[nodiscard]] OverlapKind kind_of(Lane const& lane, Overlap const& overlap) const {
    auto const& other = map_.lane(overlap.other);
    if (overlap.kind == OverlapKind::merge && share_ends(lane, other, true)) return OverlapKind::merge;
    if (overlap.kind == OverlapKind::split && share_ends(lane, other, false)) return OverlapKind::split;
    return OverlapKind::crossing;
  }

  /// Whether bodies on the two paths may touch, by circles around the paths.
  [[nodiscard]] bool is_near(Lane const& a, Lane const& b) const {
    auto const p = a.path.pose(0.5 * a.length()), q = b.path.pose(0.5 * b.length());
    return std::hypot(p.x - q.x, p.y - q.y) < 0.5 * (a.length() + b.length()) + before();
  }

  /// The lanes of its junction whose paths keep apart from the lane's: bodies that swing out in bends may touch there.
  [[nodiscard]] std::vector<Overlap> passings(Lane const& lane) const {
    std::vector<Overlap> list;
    auto const junction = junction_of(lane.id);
    if (!is_valid(junction) || lane.length() <= shortest) return list;
    for (auto const id : map_.junction(junction).lanes) {
      auto const& other = map_.lane(id);
      bool const overlaps = std::any_of(lane.overlaps.begin(), lane.overlaps.end(),
                                        [id](Overlap const& overlap) { return overlap.other == id; });
      if (other.drivable() && other.length() > shortest && !overlaps && is_near(lane, other) &&
          !share_ends(lane, other, false) && !share_ends(lane, other, true))
        list.push_back({id, OverlapKind::crossing, 0.0, lane.length(), 0.0, other.length()});
    }
    return list;
  }

  [[nodiscard]] JunctionId junction_of(LaneId lane) const { return map_.road(map_.lane(lane).road).junction; }

  /// Where the corridor enters the junction in which piece `number` lies; infinite where that lies in none.
  [[nodiscard]] double junction_begin(std::size_t number) const {
    auto const junction = junction_of(corridor_.pieces[number].lane);
    if (!is_valid(junction)) return std::numeric_limits<double>::infinity();
    while (number > 0 && junction_of(corridor_.pieces[number - 1].lane) == junction) --number;
    return corridor_.pieces[number].begin;
  }
  [[nodiscard]] double junction_begin(LaneId lane) const {
    auto const junction = junction_of(lane);
    if (!is_valid(junction)) return std::numeric_limits<double>::infinity();
    double begin = 0.0;
    for (int lanes = 0; lanes < 8; ++lanes) {
      auto const& predecessors = map_.lane(lane).predecessors;
      if (predecessors.empty() || junction_of(predecessors.front()) != junction) break;
      lane = predecessors.front();
      begin -= map_.lane(lane).length();
    }
    return begin;
  }

  /// The other's path, straight on beyond its ends where no lane goes on there.
  [[nodiscard]] geometry::Pose pose_on_way(LaneId id, double s) const {
    auto const* lane = &map_.lane(id);
    for (int lanes = 0; lanes < 16 && s < 0.0 && !lane->predecessors.empty(); ++lanes) {
      lane = &map_.lane(lane->predecessors.front());
      s += lane->length();
    }
    for (int lanes = 0; lanes < 16 && s > lane->length() && !lane->successors.empty(); ++lanes) {
      s -= lane->length();
      lane = &map_.lane(lane->successors.front());
    }
    double const on_path = std::clamp(s, 0.0, lane->length());
    auto const pose = lane->path.pose(on_path);
    return {pose.x + (s - on_path) * std::cos(pose.heading), pose.y + (s - on_path) * std::sin(pose.heading),
            pose.heading};
  }

  /// Where bodies on the two lanes may touch at all.
  [[nodiscard]] ConflictZone range_of(Overlap const& overlap, double begin, double end, OverlapKind kind) const {
    bool const merges = kind == OverlapKind::merge, splits = kind == OverlapKind::split;
    ConflictZone range;
    range.begin = splits ? begin : std::max(0.0, begin - before());
    range.end = merges ? end : std::min(corridor_.length(), end + behind());
    range.other_begin = splits ? overlap.other_begin : overlap.other_begin - before();
    range.other_end = merges ? overlap.other_end : overlap.other_end + behind();
    return range;
  }

  /// Sets the zones of piece `number`'s lane; false where even the largest bodies do not touch.
  [[nodiscard]] bool find_zones(ConflictZone const& range, std::size_t number, Conflict& conflict) const {
    std::array const bodies{map_.options().conflict_shape, body_};
    for (bool const own : {true, false})
      for (bool const other : {true, false}) {
        auto& zone = conflict.zones[own][other];
        zone = zone_of(bodies[own], bodies[other], conflict, own && other ? range : conflict.hull());
        zone.line = std::min(zone.begin + bodies[own].front, junction_begin(number));
        zone.other_line = std::min(zone.other_begin + bodies[other].front, junction_begin(conflict.other));
        if (conflict.hull().empty()) return false;
      }
    return true;
  }

  /// Lanes of one road that cross the corridor's in one place, as of its sections, are one to it: who is in the zone of
  /// one is in those of all. Else two may each be in a zone that the other waits for.
  void unite(Conflict& conflict, std::vector<Conflict> const& all) const {
    if (conflict.kind != OverlapKind::crossing) return;
    auto const road = map_.lane(conflict.other).road;
    for (auto const& next : all) {
      if (next.kind != OverlapKind::crossing || map_.lane(next.other).road != road) continue;
      for (std::size_t own = 0; own < 2; ++own)
        for (std::size_t other = 0; other < 2; ++other) {
          auto& zone = conflict.zones[own][other];
          auto const& with = next.zones[own][other];
          if (zone.empty() || with.empty() || with.begin > zone.end || with.end < zone.begin) continue;
          zone.begin = std::min(zone.begin, with.begin);
          zone.end = std::max(zone.end, with.end);
        }
    }
  }

  /// Sets the places to wait from where, as yet, the junctions begin: before the first zone of the same junction, or of
  /// one before it that reaches so far.
  static void set_holds(std::vector<Conflict>& conflicts) {
    constexpr double near = 2.0;  // [m] one may wait so much earlier
    std::map<double, std::array<double, 2>> holds;
    auto const first_zone = [](Conflict const& conflict, std::size_t own) {
      return std::min(conflict.zones[own][0].begin, conflict.zones[own][1].begin);
    };
    for (auto const& conflict : conflicts)
      for (std::size_t own : {0u, 1u}) {
        auto& hold = holds.emplace(conflict.hold[own], conflict.hold).first->second[own];
        hold = std::min(hold, first_zone(conflict, own));
      }
    for (auto& [begin, hold] : holds)
      for (auto const& before : conflicts)
        for (std::size_t own : {0u, 1u})
          if (before.hold[own] < begin && before.kind == OverlapKind::crossing &&
              std::max(before.zones[own][0].end, before.zones[own][1].end) > hold[own] - near)
            hold[own] = std::min(hold[own], holds.at(before.hold[own])[own]);
    for (auto& conflict : conflicts)
      for (std::size_t own : {0u, 1u})
        conflict.hold[own] =
            std::isfinite(conflict.hold[own]) ? holds.at(conflict.hold[own])[own] : first_zone(conflict, own);
  }

  /// The part of `range` where two such bodies touch. Where lanes merge it ends, and where they part it begins, with
  /// the range: there the two are one lane. O(places on one times places on the other).
  [[nodiscard]] ConflictZone zone_of(geometry::Shape const& shape, geometry::Shape const& other,
                                     Conflict const& conflict, ConflictZone const& range) const {
    bool const merges = conflict.kind == OverlapKind::merge, splits = conflict.kind == OverlapKind::split;
    std::vector<geometry::OrientedBox> others;
    for (double s = range.other_begin; s <= range.other_end; s += step)
      others.push_back(geometry::box_of(other, pose_on_way(conflict.other, s)));
    ConflictZone zone;
    std::size_t first_other = others.size(), last_other = 0;
    double const radii = shape.radius() + other.radius();
    for (double s = range.begin; s <= range.end; s += step) {
      auto const body = geometry::box_of(shape, corridor_.center.pose(s));
      for (std::size_t k = 0; k < others.size();) {
        double const dx = others[k].x - body.x, dy = others[k].y - body.y;
        double const apart = std::sqrt(dx * dx + dy * dy) - radii;
        if (apart > 2.0 * step) {  // none of the next ones is near, for bodies go no more than 2 m along 1 m of path
          k += static_cast<std::size_t>(apart / (2.0 * step));
          continue;
        }
        std::size_t const at = k++;
        if (!geometry::intersects(body, others[at])) continue;
        zone.begin = std::min(zone.begin, s - step);
        zone.end = s + step;
        first_other = std::min(first_other, at);
        last_other = std::max(last_other, at);
      }
    }
    if (zone.empty()) return zone;
    zone.other_begin = range.other_begin + (static_cast<double>(first_other) - 1.0) * step;
    zone.other_end = range.other_begin + (static_cast<double>(last_other) + 1.0) * step;
    if (splits) zone.begin = range.begin, zone.other_begin = range.other_begin;
    if (merges) zone.end = range.end, zone.other_end = range.other_end;
    return zone;
  }

  void add_ways(Conflict& conflict) const {
    double const view = conflict.kind == OverlapKind::split ? 0.0 : map_.options().merge_view;
    conflict.ways =
        ways_through(map_, map_.lane(conflict.other), conflict.hull().other_begin - view, conflict.hull().other_end);
  }

  Map const& map_;
  LaneCorridor const& corridor_;
  geometry::Shape body_;
};

}  // namespace cambium::map::detail
