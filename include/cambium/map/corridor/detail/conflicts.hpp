#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/corridor/detail/conflict_ways.hpp"
#include "cambium/map/corridor/detail/conflict_zones.hpp"
#include "cambium/map/lanes/right_of_way.hpp"
#include "cambium/map/map.hpp"

/// Conflicts: where the traffic of a corridor and that of another lane need the same ground.
///
/// Overlaps tell which lanes come near each other, but by their paths, not by the bodies that drive there. So each
/// overlap is first widened to the range in which bodies could touch at all. `TouchingBodies` then tries the small and
/// the large body of `MapOptions` at places along that range, for each pair of sizes, and returns zones: an interval on
/// the corridor and one on the other way. Lanes of a junction whose paths keep apart are tried as well, for long
/// vehicles swing out in bends. The rest follows from the zones: `line`, where front ends enter; the sections, chains
/// of zones between which nobody can stand, and where to wait before each; and the ways by which the others come.
///
/// Drivers on the other lane see the same conflict from their corridor. Both sides must find the same zones, else two
/// drivers may wait for each other for ever. That is why zones of two lanes without room to wait between them become
/// one, also across the borders of lane sections (`unite`).
namespace cambium::inline v0_1::map::detail {

/// Finds the conflicts of a lane corridor whose centre line and pieces are known, see `Conflict`.
class ConflictFinder {
 public:
  ConflictFinder(Map const& map, LaneCorridor const& corridor) : map_(map), corridor_(corridor) {}

  [[nodiscard]] std::vector<Conflict> find() const {
    std::vector<Found> found;
    for (std::size_t i = 0; i < corridor_.pieces.size(); ++i) {
      auto const& lane = map_.lane(corridor_.pieces[i].lane);
      for (auto const& overlap : lane.overlaps) find_at(i, overlap, found);
      for (auto const& overlap : passings(lane)) find_at(i, overlap, found);
    }
    unite(found);
    std::vector<Conflict> conflicts;
    for (auto& [number, conflict] : found) {
      set_lines(number, conflict);
      conflicts.push_back(std::move(conflict));
    }
    for (std::size_t own : {0u, 1u})
      for (std::size_t others : {0u, 1u}) set_sections(conflicts, own, others);
    sort(conflicts);
    return conflicts;
  }

 private:
  /// A conflict and the number of the piece that it lies on.
  struct Found {
    std::size_t number;
    Conflict conflict;
  };

  static constexpr double shortest = 1.0;  // [m] of a lane on which a body swings out

  [[nodiscard]] geometry::Shape const& body(bool is_large) const {
    return is_large ? map_.options().large_conflict_shape : map_.options().conflict_shape;
  }
  /// How far before and after an overlap of paths the bodies may touch [m].
  [[nodiscard]] double before() const { return body(true).length() + 8.0; }
  [[nodiscard]] double behind() const { return body(true).rear + 8.0; }

  /// Adds the conflicts of piece `number` where its lane overlaps another: mostly one, more where there is room
  /// between.
  void find_at(std::size_t number, Overlap const& overlap, std::vector<Found>& found) const {
    auto const& piece = corridor_.pieces[number];
    if (overlap.kind == OverlapKind::merge && !is_valid(junction_of(piece.lane))) return;
    auto const position = [&](double s) { return std::clamp(s - piece.lane_offset, piece.begin, piece.end); };
    Conflict conflict;
    conflict.lane = piece.lane;
    conflict.other = overlap.other;
    conflict.kind = kind_of(map_.lane(piece.lane), overlap);
    conflict.right_of_way = right_of_way(map_, piece.lane, overlap);
    auto const by_sign = signed_right_of_way(map_, piece.lane, overlap);
    auto const signs = signs_before(map_, map_.lane(piece.lane));
    conflict.is_signed = by_sign.has_value() || signs.rank > 0;
    conflict.from_minor_road = by_sign == RightOfWay::yields && (signs.stops || comes_from_street(overlap.other));
    double const begin = position(overlap.begin), end = position(overlap.end);
    conflict.shift = conflict.kind == OverlapKind::split ? begin - overlap.other_begin : end - overlap.other_end;
    if (overlap.kind == OverlapKind::merge) conflict.meet = begin;
    conflict.lane_end = piece.end;
    conflict.other_lane_end = map_.lane(overlap.other).length();
    conflict.light = signs.light;
    conflict.other_light = signs_before(map_, map_.lane(overlap.other)).light;
    for (auto const& hull : zones_in(number, range_of(overlap, begin, end, conflict.kind), conflict, true, true))
      for (auto const& zones : zones_by_size(number, hull, conflict)) {
        conflict.zones = zones;
        found.push_back({number, conflict});
      }
  }

  /// The zones within that of the largest bodies; again with that one where those of smaller bodies lie apart in it.
  [[nodiscard]] std::vector<ConflictZones> zones_by_size(std::size_t number, ConflictZone const& hull,
                                                         Conflict const& conflict) const {
    std::vector<ConflictZones> all(1);
    for (auto const& [own, other] : {std::pair(0u, 0u), {0u, 1u}, {1u, 0u}}) {
      auto const zones = zones_in(number, hull, conflict, own != 0, other != 0);
      all.resize(std::max(all.size(), zones.size()));
      for (std::size_t i = 0; i < zones.size(); ++i) all[i][own][other] = zones[i];
    }
    for (auto& zones : all) zones[1][1] = hull;
    return all;
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

  /// Whether the lanes start as one and part. Their ways may be cut into pieces; then the pieces overlap from the fork
  /// up to this overlap without a break. O(pieces), at most 16.
  [[nodiscard]] bool parts(Lane const& lane, Overlap const& overlap, int pieces = 16) const {
    constexpr double close = 0.5;  // [m]
    auto const& other = map_.lane(overlap.other);
    if (share_ends(lane, other, false)) return true;
    bool const at_begin = overlap.begin < close, at_other_begin = overlap.other_begin < close;
    if (pieces == 0 || !(at_begin || at_other_begin)) return false;
    auto const before = at_begin ? lane.predecessors : std::vector{lane.id},
               other_before = at_other_begin ? other.predecessors : std::vector{other.id};
    for (auto const id : before)
      for (auto const& earlier : map_.lane(id).overlaps) {
        if (std::find(other_before.begin(), other_before.end(), earlier.other) == other_before.end()) continue;
        double const end = at_begin ? map_.lane(id).length() : overlap.begin,
                     other_end = at_other_begin ? map_.lane(earlier.other).length() : overlap.other_begin;
        if (earlier.kind == OverlapKind::split && std::abs(earlier.end - end) < close &&
            std::abs(earlier.other_end - other_end) < close && parts(map_.lane(id), earlier, pieces - 1))
          return true;
      }
    return false;
  }

  /// Lanes that come from, or lead into, lanes side by side are near each other there too, and may cross.
  [[nodiscard]] OverlapKind kind_of(Lane const& lane, Overlap const& overlap) const {
    auto const& other = map_.lane(overlap.other);
    if (overlap.kind == OverlapKind::merge && share_ends(lane, other, true)) return OverlapKind::merge;
    if (overlap.kind == OverlapKind::split && parts(lane, overlap)) return OverlapKind::split;
    return OverlapKind::crossing;
  }

  /// Whether bodies on the two paths may touch, by circles around the paths.
  [[nodiscard]] bool is_near(Lane const& a, Lane const& b) const {
    auto const p = a.path.pose(0.5 * a.length()), q = b.path.pose(0.5 * b.length());
    return portable::hypot(p.x - q.x, p.y - q.y) < 0.5 * (a.length() + b.length()) + before();
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

  /// The parts of `range` where two bodies of such sizes touch. Where lanes merge the only one ends, and where they
  /// part it begins, with the range: there the two are one lane.
  [[nodiscard]] std::vector<ConflictZone> zones_in(std::size_t number, ConflictZone const& range,
                                                   Conflict const& conflict, bool own, bool other) const {
    TouchingBodies const bodies{map_, corridor_, corridor_.pieces[number], conflict.other, body(own), body(other)};
    auto zones = bodies.zones(range);
    if (conflict.kind == OverlapKind::crossing || zones.empty()) return zones;
    ConflictZone zone;
    for (auto const& part : zones) zone = joined(zone, part);
    if (conflict.kind == OverlapKind::split) zone.begin = range.begin, zone.other_begin = range.other_begin;
    if (conflict.kind == OverlapKind::merge) zone.end = range.end, zone.other_end = range.other_end;
    return {zone};
  }

  /// A road's lane from section to section: the first of its lanes, and the way from there to one of them [m].
  struct Chain {
    LaneId first;
    double way;
  };
  [[nodiscard]] Chain chain_of(LaneId lane) const {
    Chain chain{lane, 0.0};
    for (int lanes = 0; lanes < 64; ++lanes) {
      auto const& before = map_.lane(chain.first).predecessors;
      auto const same = std::find_if(before.begin(), before.end(),
                                     [&](LaneId id) { return map_.lane(id).road == map_.lane(lane).road; });
      if (same == before.end() || *same == lane) break;
      chain.first = *same;
      chain.way += map_.lane(chain.first).length();
    }
    return chain;
  }

  /// Merges zones across lane-section borders, so both corridors agree.
  void unite(std::vector<Found>& found) const {
    struct Member {
      Conflict* conflict;
      double way;
    };
    std::map<std::pair<LaneId, LaneId>, std::vector<Member>> roads;
    for (auto& [number, conflict] : found) {
      if (conflict.kind != OverlapKind::crossing) continue;
      auto const chain = chain_of(conflict.other);
      roads[{chain_of(corridor_.pieces[number].lane).first, chain.first}].push_back({&conflict, chain.way});
    }
    for (auto const& [chains, members] : roads)
      for (std::size_t sizes = 0; sizes < 4; ++sizes) {
        std::vector<ConflictZone> zones;
        auto const zone_of = [sizes](Member const& member) -> ConflictZone& {
          return member.conflict->zones[sizes / 2][sizes % 2];
        };
        for (auto const& member : members)
          if (auto const& zone = zone_of(member); !zone.empty()) add_zone(zones, moved(zone, member.way));
        for (auto const& member : members)
          for (auto const& whole : zones)
            if (auto& zone = zone_of(member); !zone.empty() && zone.begin >= whole.begin && zone.end <= whole.end)
              zone = moved(whole, -member.way);
      }
  }
  [[nodiscard]] static ConflictZone moved(ConflictZone zone, double way) {
    zone.other_begin += way;
    zone.other_end += way;
    return zone;
  }

  void set_lines(std::size_t number, Conflict& conflict) const {
    double const begin = junction_begin(number), other_begin = junction_begin(conflict.other);
    for (std::size_t own : {0u, 1u})
      for (std::size_t other : {0u, 1u}) {
        auto& zone = conflict.zones[own][other];
        zone.line = std::min(zone.begin + body(own).front, begin);
        zone.other_line = std::min(zone.other_begin + body(other).front, other_begin);
      }
    for (auto& sections : conflict.section)
      for (auto& section : sections) section.line = begin;
    auto const& other = map_.lane(conflict.other);
    auto const& hull = conflict.hull();
    double const view = conflict.kind == OverlapKind::split ? 0.0 : view_along(other);
    conflict.ways = ways_through(map_, other, hull.other_begin - view, hull.other_begin, hull.other_end);
  }

  /// Whether a lane's traffic comes from a road with traffic both ways, unlike in a roundabout.
  [[nodiscard]] bool comes_from_street(LaneId id) const {
    auto const ends = ends_of(map_.lane(id), false);
    return std::any_of(ends.begin(), ends.end(), [&](LaneId end) {
      auto const& one = map_.lane(end);
      auto const& lanes = map_.road(one.road).sections[one.section].lanes;
      return std::any_of(lanes.begin(), lanes.end(), [&](RoadLane const& lane) {
        return is_valid(lane.id) && map_.lane(lane.id).drivable() && map_.lane(lane.id).along_road != one.along_road;
      });
    });
  }

  /// How far before a conflict traffic on a lane counts [m]: `MapOptions::merge_view`, and on fast roads as far as one
  /// drives in the longest gap that people wait for.
  [[nodiscard]] double view_along(Lane const& lane) const {
    constexpr double longest_gap = 9.0, farthest = 300.0;  // [s], [m]
    double highest = 0.0;
    auto const note = [&](Lane const& one) {
      for (auto const& step : one.speed_limits)
        if (std::isfinite(step.limit)) highest = std::max(highest, step.limit);
    };
    note(lane);
    for (auto const id : ends_of(lane, false)) note(map_.lane(id));
    return std::max(map_.options().merge_view, std::min(farthest, longest_gap * highest));
  }

  static void sort(std::vector<Conflict>& conflicts) {
    cambium::detail::stable_sort(conflicts, [](Conflict const& c) {
      return std::tuple(c.first_hold(), c.hull().begin, c.other, c.hull().other_begin, c.lane_end, c.zones[0][0].begin,
                        c.zones[0][1].begin, c.zones[1][0].begin);
    });
    double end = -std::numeric_limits<double>::infinity();
    for (auto& conflict : conflicts) conflict.farthest_end = end = std::max(end, conflict.hull().end);
  }

  /// Whether the corridor's traffic, where lights let both go, waits for traffic that comes towards it.
  [[nodiscard]] bool waits_for_oncoming(Conflict const& conflict) const {
    if (conflict.right_of_way != RightOfWay::yields || !is_valid(conflict.light) || !is_valid(conflict.other_light))
      return false;
    auto const heading = [&](LaneId lane) { return map_.lane(lane).path.pose(0.0).heading; };
    return std::abs(geometry::angle_difference(heading(conflict.other), heading(conflict.lane))) > 0.75 * geometry::pi;
  }

  /// Sets the sections, by size of the own vehicle and the others; `line` says where the junction begins.
  void set_sections(std::vector<Conflict>& conflicts, std::size_t own, std::size_t others) const {
    constexpr double room = 2.0;  // [m] to stand between two zones
    constexpr double nowhere = std::numeric_limits<double>::infinity();
    struct Member {
      double begin, end;  // of its zones
      Conflict* conflict;
    };
    std::vector<Member> members;
    for (auto& conflict : conflicts) {
      auto const& zones = conflict.zones[own];
      Member member{zones[0].begin, zones[0].end, &conflict};
      if (others != 0) {
        member.begin = std::min(member.begin, zones[1].begin);
        member.end = std::max(member.end, zones[1].end);
      }
      auto& section = conflict.section[own][others];
      if (conflict.kind != OverlapKind::split && member.begin <= member.end)
        members.push_back(member);
      else
        section = {ConflictSection::none, conflict.hull().begin};
    }
    cambium::detail::stable_sort(members, &Member::begin);
    double before = -nowhere;  // where the section before ends
    std::uint32_t number = 0;
    for (auto first = members.begin(); first != members.end();) {
      double end = first->end, line = nowhere, refuge = nowhere;
      auto last = first;
      for (; last != members.end() && last->begin < end + room; ++last) {
        end = std::max(end, last->end);
        line = std::min(line, last->conflict->section[own][others].line);
        if (waits_for_oncoming(*last->conflict)) refuge = std::min(refuge, last->begin);
      }
      double const hold = first->begin;
      if (line - body(own).front < before + room) line = nowhere;
      bool const has_refuge = refuge < nowhere && refuge > std::min(hold, line - body(own).front) + room;
      for (; first != last; ++first) {
        bool const beyond = has_refuge && first->begin >= refuge;
        first->conflict->section[own][others] = {number + (beyond ? 1u : 0u), hold, line, beyond ? refuge : -nowhere};
      }
      number += has_refuge ? 2 : 1;
      before = end;
    }
  }

  Map const& map_;
  LaneCorridor const& corridor_;
};

}  // namespace cambium::inline v0_1::map::detail
