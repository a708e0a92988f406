#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/road/lane_type.hpp"

namespace cambium::inline v0_1::map {

/// Distances from a lane's path to its two borders [m]; negative where the path runs outside of the lane.
struct SideWidths {
  double left{}, right{};
};

/// `widths` at the vertices of `line`, interpolated at arc length `s` within its `segment`.
[[nodiscard]] inline SideWidths interpolated(std::span<SideWidths const> widths, geometry::Line const& line, double s,
                                             std::uint32_t segment) {
  auto const& g = line.segments()[segment];
  double const u = std::clamp((s - g.s) / g.length, 0.0, 1.0);
  auto const &a = widths[segment], &b = widths[segment + 1];
  return {a.left + u * (b.left - a.left), a.right + u * (b.right - a.right)};
}

/// A stretch of a line, from arc length `begin` to `end` [m].
struct PathStretch {
  double begin{}, end{};

  [[nodiscard]] double middle() const { return 0.5 * (begin + end); }
  /// How far the two are apart; negative where they overlap.
  [[nodiscard]] double gap(PathStretch const& o) const { return std::max(begin, o.begin) - std::min(end, o.end); }
  /// Whether it includes all of the other.
  [[nodiscard]] bool has(PathStretch const& o) const { return begin <= o.begin && o.end <= end; }
  /// Grows to include the other.
  void add(PathStretch const& o) { *this = {std::min(begin, o.begin), std::max(end, o.end)}; }

  friend bool operator==(PathStretch const&, PathStretch const&) = default;
};

/// Whether a number is a speed limit for road traffic, 0.1 to 200 m/s; infinite: there is none.
[[nodiscard]] constexpr bool is_speed_limit(double limit) {
  return limit >= 0.1 && (limit <= 200.0 || limit == std::numeric_limits<double>::infinity());
}

/// A speed limit, in force from arc length `begin` [m] on up to the next step.
struct SpeedStep {
  double begin{};
  double limit = std::numeric_limits<double>::infinity();  ///< [m/s], infinite where there is none

  friend bool operator==(SpeedStep const&, SpeedStep const&) = default;
};

/// The limit in force at arc length `s` [m], the first one before its begin; infinite where `steps` is empty. [m/s],
/// O(log steps).
[[nodiscard]] inline double speed_limit_at(std::span<SpeedStep const> steps, double s) {
  if (steps.empty()) return std::numeric_limits<double>::infinity();
  auto const next = std::upper_bound(steps.begin(), steps.end(), s,
                                     [](double value, SpeedStep const& step) { return value < step.begin; });
  return (next == steps.begin() ? next : next - 1)->limit;
}

/// A place along a lane: `s` [m] along its path.
struct LaneStation {
  LaneId lane = none<LaneId>;
  double s{};

  friend bool operator==(LaneStation const&, LaneStation const&) = default;
};

/// How two lanes that overlap relate.
enum class OverlapKind : std::uint8_t {
  merge,     ///< they come together and go on as one, or side by side too close for two vehicles
  split,     ///< they start as one and part
  crossing,  ///< one passes over the other
};

/// Who goes first where the paths of two lanes meet.
enum class RightOfWay : std::uint8_t {
  equal,   ///< neither: whoever is there first
  first,   ///< this lane's traffic goes first
  yields,  ///< this lane's traffic lets the other's go first
};

/// A stretch on which a vehicle in this lane and one in another lane cannot be side by side: the lanes' paths are
/// closer than the map's overlap clearance. `begin`, `end` [m] on this lane's path, `other_begin`, `other_end` on the
/// other's.
struct Overlap {
  LaneId other = none<LaneId>;
  OverlapKind kind = OverlapKind::crossing;
  double begin{}, end{};
  double other_begin{}, other_end{};
};

/// One lane of one lane section, as it is driven: everything runs in the direction of travel.
///
/// The `path` is what a vehicle follows: the lane's centre line; but where the lane ends beside a neighbour that goes
/// on (`merges_into`: a lane drop, the end of an acceleration lane), it swings over onto the neighbour's centre line
/// before the end, and the neighbour's successors are this lane's successors too.
struct Lane {
  LaneId id = none<LaneId>;
  RoadId road = none<RoadId>;
  std::uint32_t section{};  ///< index of the lane section within the road
  int number{};             ///< the file's lane id: negative right of the reference line
  LaneType type = LaneType::none;
  bool along_road = true;               ///< travel direction is that of increasing road s
  double road_begin{}, road_end{};      ///< the section's range of road s [m], road_begin < road_end
  std::vector<SpeedStep> speed_limits;  ///< along the path, sorted; empty where nothing limits the speed

  geometry::Line path;             ///< what a vehicle follows (see above)
  std::vector<SideWidths> widths;  ///< at the path's vertices
  std::vector<double> stations;    ///< road s at the path's vertices [m]
  geometry::Line left, right;      ///< borders in travel direction; empty where they have no length

  LaneId left_neighbor = none<LaneId>;   ///< next lane to the left with the same travel direction, drivable
  LaneId right_neighbor = none<LaneId>;  ///< next lane to the right with the same travel direction, drivable
  /// The same strip driven the other way: a lane for both directions is two lanes. They are oncoming to each other:
  /// neither is a neighbour of any lane, and their lying on each other is no overlap.
  LaneId opposite = none<LaneId>;
  /// Where the road marks permit a change to the left and right neighbour: stretches of the path, sorted, apart. Empty
  /// without a neighbour there.
  std::vector<PathStretch> left_changes, right_changes;
  LaneId merges_into = none<LaneId>;  ///< the neighbour that this lane's path joins at its end
  double merge_begin{};               ///< where the path leaves the centre line [m]; only with `merges_into`
  std::vector<LaneId> successors, predecessors;
  std::vector<Overlap> overlaps;    ///< sorted by `begin`
  std::vector<LaneSignal> signals;  ///< signs and lights for it, sorted by place

  /// First of this lane's values of the map-wide lane coordinate: the lane owns [index_begin, index_begin + length].
  double index_begin{};

  [[nodiscard]] double length() const { return path.length(); }
  [[nodiscard]] bool drivable() const { return is_drivable(type); }

  /// The speed limit at path position `s` [m]; infinite where there is none. [m/s], O(log steps).
  [[nodiscard]] double speed_limit_at(double s) const { return map::speed_limit_at(speed_limits, s); }

  /// Whether the road marks permit a change to the left (right) neighbour at path position `s` [m]; false without a
  /// neighbour there. O(stretches).
  [[nodiscard]] bool may_change_left(double s) const { return holds(left_changes, s); }
  [[nodiscard]] bool may_change_right(double s) const { return holds(right_changes, s); }

  /// Distances from the path to the borders at path position `s` [m], interpolated between the vertices. O(log n).
  [[nodiscard]] SideWidths widths_at(double s) const { return widths_at(s, path.find(s)); }
  /// As above, within `segment` of the path. O(1).
  [[nodiscard]] SideWidths widths_at(double s, std::uint32_t segment) const {
    return interpolated(widths, path, s, segment);
  }

  /// Road station beside path position `s` [m], interpolated between the vertices (`project` onto the road's reference
  /// line makes it exact). O(log n).
  [[nodiscard]] double station_at(double s) const { return station_at(s, path.find(s)); }
  /// As above, within `segment` of the path. O(1).
  [[nodiscard]] double station_at(double s, std::uint32_t segment) const {
    auto const& g = path.segments()[segment];
    return stations[segment] + std::clamp((s - g.s) / g.length, 0.0, 1.0) * (stations[segment + 1] - stations[segment]);
  }
  /// Path position beside road station `station`, interpolated between the vertices; an end of the path for what lies
  /// beyond it. [m], O(log n).
  [[nodiscard]] double position_at(double station) const {
    double const sign = along_road ? 1.0 : -1.0;
    auto const next =
        std::partition_point(stations.begin(), stations.end(), [&](double at) { return sign * at <= sign * station; });
    if (next == stations.begin()) return 0.0;
    if (next == stations.end()) return length();
    auto const i = static_cast<std::size_t>(next - stations.begin()) - 1;
    auto const& segment = path.segments()[i];
    return segment.s + segment.length * (station - stations[i]) / (stations[i + 1] - stations[i]);
  }
  /// The stretch of the path between two road stations, in any order [m]. O(log n).
  [[nodiscard]] PathStretch stretch_between(double station, double other) const {
    double const a = position_at(station), b = position_at(other);
    return {std::min(a, b), std::max(a, b)};
  }

 private:
  [[nodiscard]] static bool holds(std::vector<PathStretch> const& stretches, double s) {
    return std::any_of(stretches.begin(), stretches.end(),
                       [s](PathStretch const& stretch) { return s >= stretch.begin && s <= stretch.end; });
  }
};

}  // namespace cambium::inline v0_1::map
