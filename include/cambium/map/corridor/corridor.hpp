#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/map/lanes/lane.hpp"

namespace cambium::inline v0_1::map {

/// A lane's stretch of a lane corridor.
struct CorridorPiece {
  LaneId lane = none<LaneId>;
  double begin{}, end{};               ///< corridor position [m]
  double index_offset{};               ///< lane coordinate = corridor position + index_offset
  CorridorId left = none<CorridorId>;  ///< number of the corridor that holds the lane's left neighbour
  CorridorId right = none<CorridorId>;
  LaneType type = LaneType::none;
  PieceId left_piece{}, right_piece{};        ///< number of the neighbour's piece there; only with `left`, `right`
  double lane_offset{};                       ///< position on the lane's path = corridor position + lane_offset [m]
  std::uint32_t first_segment{}, segments{};  ///< of the corridor's centre line: where its own begin, and how many
  /// Where a vehicle must have changed lanes at the latest: where the next merge into a neighbour begins or, if the
  /// corridor ends before the route does, where it ends; infinite where neither is ahead [m].
  double lane_end = std::numeric_limits<double>::infinity();

  /// Number of the corridor to the left or the right, and of its piece there.
  [[nodiscard]] CorridorId beside(bool leftwards) const { return leftwards ? left : right; }
  [[nodiscard]] PieceId piece_beside(bool leftwards) const { return leftwards ? left_piece : right_piece; }
};

/// A stretch of a lane outside of the corridor whose traffic counts in it: a lane that merges in (from `merge_view`
/// before the overlap on), one that has just split off and still overlaps, one that leads onto the corridor's first
/// lane, or one to which its last lane leads. Lane coordinates [index_begin, index_end] map linearly onto corridor
/// positions [begin, end].
struct Feeder {
  LaneId lane = none<LaneId>;
  double index_begin{}, index_end{};
  double begin{}, end{};
  /// Corridor position from which on the two lanes are one [m].
  double free_until = -std::numeric_limits<double>::infinity();
  bool by_rule = false;  ///< the two merge in a junction: who goes first is a matter of right of way, see `Conflict`

  /// Whether it lies before the merge.
  [[nodiscard]] bool is_still_to_merge() const { return end <= free_until; }
  /// Whether the right of way decides about a vehicle whose front end is at corridor position `front` [m].
  [[nodiscard]] bool is_up_to_rule(double front) const { return by_rule && front < free_until; }
  /// Corridor position of the lane coordinate `index`, and the reverse [m].
  [[nodiscard]] double image(double index) const {
    return begin + (index - index_begin) * (end - begin) / (index_end - index_begin);
  }
  [[nodiscard]] double index_at(double s) const {
    return index_begin + (s - begin) * (index_end - index_begin) / (end - begin);
  }
};

/// A stop sign or a light for the corridor's traffic.
struct CorridorSignal {
  double line{};  ///< where front ends stop: where the junction behind it begins, else the signal [m]
  SignalKind kind = SignalKind::stop;
  LightId light = none<LightId>;

  friend bool operator==(CorridorSignal const&, CorridorSignal const&) = default;
};

/// A stretch of the map-wide lane coordinate (see `Lane::index_begin`) on the way to, through and beyond a conflict.
struct ConflictWay {
  double index_begin{}, index_end{};
  double begin{};  ///< of the way where the stretch begins: position on the other lane's path, negative before it [m]
  /// Shortest time to the conflict, from the stretch's begin and from its end, that bends permit even the fastest [s];
  /// below 0 beyond the conflict.
  double time_from_begin{}, time_from_end{};

  /// The same from a position on the way [m], never more than it is: bends mostly come last.
  [[nodiscard]] double time_from(double at) const {
    double const length = index_end - index_begin,
                 share = length > 0.0 ? std::clamp((at - begin) / length, 0.0, 1.0) : 1.0;
    return std::max(0.0, time_from_begin + share * (time_from_end - time_from_begin));
  }
};

/// Where the reference points of two vehicles, of a size each, may be when these touch.
struct ConflictZone {
  double begin = std::numeric_limits<double>::infinity(), end = -begin;  ///< corridor position [m]
  double other_begin{}, other_end{};  ///< position along the other's way, as in `Conflict::ways` [m]
  double line{};        ///< corridor position where front ends enter: where the junction begins, else the zone [m]
  double other_line{};  ///< likewise on the other's way [m]

  /// Whether they never touch.
  [[nodiscard]] bool empty() const { return begin > end; }
};

/// Zones by the sizes of the own vehicle and the other: 0 where it is no larger than `MapOptions::conflict_shape`, 1 up
/// to `MapOptions::large_conflict_shape`.
using ConflictZones = std::array<std::array<ConflictZone, 2>, 2>;

/// Conflicts that a vehicle passes as a whole, see `Conflict`.
struct ConflictSection {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t number = none;  ///< along the corridor; none where nobody waits
  double hold{};                ///< up to where reference points are in no zone of the section [m]
  double line = std::numeric_limits<double>::infinity();  ///< up to where front ends wait: where a junction begins [m]
  double refuge = -std::numeric_limits<double>::infinity();  ///< up to where reference points wait at green [m]

  /// Where the reference point of a vehicle waits whose front end is `front` [m] ahead of it; `at_green`: its own light
  /// says go.
  [[nodiscard]] double place_to_wait(double front, bool at_green) const {
    double const outside = std::min(hold, line - front);
    return at_green ? std::max(outside, refuge) : outside;
  }
};

/// Where a lane outside of the corridor crosses it, merges with it or parts from it.
///
/// Conflicts between which nobody can stand form a section: a vehicle passes it as a whole, and waits before it.
///
///        hold            refuge
///     ->  |  //zone//   /zone/  |  //zone//  /zone/   ->
///          \_______ section 0 _/ \___ section 1 ___/
///
/// A section may have a refuge: a place within it where one who turns at green waits for oncoming traffic. From there
/// on it counts as a section of its own, before which one waits at the refuge while one's own light says go, and
/// otherwise where the whole begins.
struct Conflict {
  LaneId lane = none<LaneId>, other = none<LaneId>;  ///< of the corridor, and the one outside of it
  OverlapKind kind = OverlapKind::crossing;
  RightOfWay right_of_way = RightOfWay::equal;  ///< of this corridor's traffic
  bool is_signed = false;                       ///< priorities or signs say who goes first, or both have priority
  bool from_minor_road = false;                 ///< this corridor's traffic yields to a street, by priorities or signs
  ConflictZones zones;                          ///< that of two large ones holds all others and is not empty
  /// The section that it is in, by the size of the corridor's vehicle and whether large vehicles are among the others.
  std::array<std::array<ConflictSection, 2>, 2> section;
  double lane_end{}, other_lane_end{};  ///< where the two lanes end: corridor position, and on the other's way [m]

  /// The zone of two large vehicles, which holds all others.
  [[nodiscard]] ConflictZone const& hull() const { return zones[1][1]; }
  /// Nobody waits so that its front end is before this [m].
  [[nodiscard]] double first_hold() const { return std::min(section[1][1].hold, section[1][1].line); }
  double farthest_end{};                ///< of the hulls of this one and those before it in the corridor [m]
  LightId light = none<LightId>;        ///< that stops the corridor's traffic
  LightId other_light = none<LightId>;  ///< that stops the other's traffic
  double shift{};  ///< where they merge or part: corridor position = position on the way + shift [m]
  double meet = std::numeric_limits<double>::infinity();  ///< where lanes that merge come together [m]
  /// The way: the other lane, the lanes that lead to it, from `MapOptions::merge_view` before the conflict on, and the
  /// lanes after it up to where a vehicle's rear has left the conflict.
  std::vector<ConflictWay> ways;
};

/// A stretch of a corridor on which it bends about evenly.
struct Bend {
  double begin{}, end{};  ///< corridor position [m]
  double curvature{};     ///< the sharpest there, positive [1/m]
};

/// A drivable lane that a free corridor crosses, from border to border (see `build_free_corridor`).
struct LaneCrossing {
  LaneId lane = none<LaneId>;
  double begin{}, end{};            ///< corridor position [m]
  double lane_begin{}, lane_end{};  ///< of the stretch that the corridor covers: position on the lane's path [m]
  std::vector<ConflictWay> ways;    ///< by which traffic comes to that stretch, positions counted from the lane's begin
};

/// A chain of lanes along which a vehicle drives: what behaviours follow. Immutable, shared.
struct LaneCorridor {
  geometry::Line center;                    ///< the lanes' paths, joined
  std::vector<SideWidths> widths;           ///< at the centre line's vertices
  geometry::Line left, right;               ///< borders
  IdVector<CorridorPiece, PieceId> pieces;  ///< sorted by `begin`, gapless
  std::vector<Feeder> feeders;              ///< sorted by `begin`
  std::vector<Conflict> conflicts;          ///< sorted by `first_hold`
  std::vector<Bend> bends;                  ///< sharper than 1 km of radius, sorted by `begin`
  double sharpest_bend = 0.0;               ///< the curvature of the sharpest of them [1/m]
  std::vector<CorridorSignal> signals;      ///< sorted by `line`
  std::vector<SpeedStep> speed_limits;      ///< along the corridor, sorted; empty where nothing limits the speed
  bool continues = false;               ///< the road goes on beyond the end: the corridor ends because the route does
  bool reaches_destination = false;     ///< it holds the route's last lane
  std::vector<LaneCrossing> crossings;  ///< of a free corridor: the lanes that it crosses, sorted by `begin`

  [[nodiscard]] double length() const { return center.length(); }

  /// Index of the piece that holds `s`, searched from `hint`.
  [[nodiscard]] PieceId piece_at(double s, PieceId hint) const {
    auto i = index_of(hint);
    while (i + 1 < pieces.size() && s >= pieces[i + 1].begin) ++i;
    while (i > 0 && s < pieces[i].begin) --i;
    return static_cast<PieceId>(i);
  }

  /// The piece that holds `s`, the first or last one beyond the ends. O(log pieces).
  [[nodiscard]] CorridorPiece const& piece_at(double s) const {
    auto const next = std::upper_bound(pieces.begin(), pieces.end(), s,
                                       [](double value, CorridorPiece const& piece) { return value < piece.begin; });
    return next == pieces.begin() ? pieces.front() : *(next - 1);
  }

  /// The place on a lane's path that is at `s`, which counts as that of the nearer end beyond the ends. O(log pieces).
  [[nodiscard]] LaneStation lane_at(double s) const {
    auto const& piece = piece_at(s);
    return {piece.lane, std::max(0.0, std::clamp(s, piece.begin, piece.end) + piece.lane_offset)};
  }

  /// Where the corridor passes `station`; the first time, where its lane comes more than once; nothing where the lane
  /// is not in it. A station beyond the lane's ends counts as the end. [m], O(pieces).
  [[nodiscard]] std::optional<double> position_of(LaneStation const& station) const {
    for (auto const& piece : pieces)
      if (piece.lane == station.lane) return std::clamp(station.s - piece.lane_offset, piece.begin, piece.end);
    return std::nullopt;
  }

  /// The length of the corridor ahead of `s` [m]; 0 beyond its end.
  [[nodiscard]] double length_until_end(double s) const { return std::max(0.0, length() - s); }

  /// The speed limit at `s`; infinite where there is none. [m/s], O(log steps).
  [[nodiscard]] double speed_limit_at(double s) const { return map::speed_limit_at(speed_limits, s); }

  /// The section of this corridor's traffic that holds `conflict` of another corridor, for vehicles of the size
  /// `is_large` before one of that corridor of the size `other_large`; `any_large`: see `Conflict::section`. Its
  /// positions are on the path of the conflict's other lane, negative before it. Nothing where this corridor does not
  /// pass it, or where nobody waits. O(pieces + conflicts).
  [[nodiscard]] std::optional<ConflictSection> section_of(Conflict const& conflict, bool is_large, bool other_large,
                                                          bool any_large) const {
    std::optional<ConflictSection> found;
    double least = std::numeric_limits<double>::infinity();
    for (auto const& piece : pieces) {
      if (piece.lane != conflict.other) continue;
      for (auto const& own : conflicts) {
        if (own.other != conflict.lane || own.lane_end != piece.end) continue;
        auto const& section = own.section[is_large][any_large];
        double const apart = std::abs(own.zones[is_large][other_large].begin + piece.lane_offset -
                                      conflict.zones[other_large][is_large].other_begin);
        if (section.number == ConflictSection::none || !(apart < least)) continue;
        least = apart;
        found = section;
        found->hold += piece.lane_offset;
        found->line += piece.lane_offset;
        found->refuge += piece.lane_offset;
      }
    }
    return found;
  }

  /// Distances from the centre line to the lane's borders at `s` [m]. O(log n).
  [[nodiscard]] SideWidths widths_at(double s) const { return widths_at(s, center.find(s)); }

  /// The lane's width at `s` [m]. O(log n).
  [[nodiscard]] double width_at(double s) const {
    auto const sides = widths_at(s);
    return sides.left + sides.right;
  }

  /// Distances from the centre line to the lane's borders at `s` within `segment` of the centre line [m].
  [[nodiscard]] SideWidths widths_at(double s, std::uint32_t segment) const {
    return interpolated(widths, center, s, segment);
  }
};

/// The lanes of a route and those beside them, as lane corridors. Immutable, built once per route and shared.
struct RoadCorridor {
  std::vector<LaneId> route;  ///< the lanes from start to destination, lane changes included
  IdVector<LaneCorridor, CorridorId> corridors;
  CorridorId main{};                 ///< the corridor that holds the route's last lane
  std::vector<geometry::Point> way;  ///< of a free corridor: the points that it was built through
  double view{};                     ///< likewise: `FreeCorridorOptions::view` [m]

  /// Number of the first corridor that holds `lane`, `none<CorridorId>` if none does. O(lanes).
  [[nodiscard]] CorridorId corridor_of(LaneId lane) const {
    CorridorId number{};
    for (auto const& corridor : corridors) {
      for (auto const& piece : corridor.pieces)
        if (piece.lane == lane) return number;
      ++number;
    }
    return none<CorridorId>;
  }

  /// All lanes, by id, each once. O(n log n).
  [[nodiscard]] std::vector<LaneId> lanes() const {
    std::vector<LaneId> result;
    for (auto const& corridor : corridors)
      for (auto const& piece : corridor.pieces) result.push_back(piece.lane);
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }
};

}  // namespace cambium::inline v0_1::map
