#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/state.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/lanelet/lanelet.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/map.hpp"

/// Recorded traffic, whatever data set or file it comes from.
namespace cambium::inline v0_1 {

/// The kind of road user of a track.
enum class TrackType : std::uint8_t { car, truck, bus, motorcycle, bicycle, pedestrian, other };

/// The type as a word: "car".
[[nodiscard]] constexpr char const* to_string(TrackType type) {
  constexpr char const* words[] = {"car", "truck", "bus", "motorcycle", "bicycle", "pedestrian", "other"};
  auto const number = static_cast<std::size_t>(type);
  return number < std::size(words) ? words[number] : "unknown";
}

/// One recorded road user or obstacle. Its states are those of the middle of its body, as data sets give them; the
/// worlds of this library move another point, see `reference_shape`.
struct Track {
  std::int64_t id = 0;
  TrackType type = TrackType::car;
  double length = 4.5;          ///< [m]
  double width = 1.8;           ///< [m]
  bool stands = false;          ///< an obstacle that stands for good, with one state
  std::vector<State> states{};  ///< of the middle, by rising time; speeds below 0 are backwards
  /// The outline, from its middle, along and left of its heading [m]; empty: a rectangle. In worlds those that move are
  /// the rectangle of `length` and `width` all the same.
  std::vector<geometry::Point> outline{};

  [[nodiscard]] double begin() const { return states.front().time; }  ///< [s]
  [[nodiscard]] double end() const { return states.back().time; }     ///< [s]

  /// The state at `time` [s], between two recorded ones by linear interpolation (of the heading along the shorter arc);
  /// the first or last one beyond the ends. Precondition: there is a state. O(log states).
  [[nodiscard]] State at(double time) const {
    auto const after = std::lower_bound(states.begin(), states.end(), time,
                                        [](State const& state, double t) { return state.time < t; });
    if (after == states.end()) return states.back();
    if (after == states.begin() || after->time == time) return *after;
    State const &a = *(after - 1), &b = *after;
    double const u = (time - a.time) / (b.time - a.time);
    return {time, a.x + u * (b.x - a.x), a.y + u * (b.y - a.y),
            a.heading + u * geometry::angle_difference(b.heading, a.heading), a.speed + u * (b.speed - a.speed)};
  }

  friend bool operator==(Track const&, Track const&) = default;
};

/// The track's body about the reference point of its kind, as `AgentSpec` wants it: for vehicles the rear axle, which
/// no data set records. It is put where the presets of `geometry::Shape` have it, in shares of the length.
[[nodiscard]] constexpr geometry::Shape reference_shape(Track const& track) {
  constexpr double rear_shares[] = {0.2, 0.28, 0.28, 0.16, 0.19, 0.5, 0.5};  // by `TrackType`
  double const rear = rear_shares[static_cast<std::size_t>(track.type)] * track.length, half = 0.5 * track.width;
  return {track.length - rear, rear, half, half};
}

/// The state of a body's reference point where that of its middle is known.
[[nodiscard]] inline State reference_state(State middle, geometry::Shape const& shape) {
  middle.x -= shape.center_offset() * portable::cos(middle.heading);
  middle.y -= shape.center_offset() * portable::sin(middle.heading);
  return middle;
}

/// The state of a body's middle where that of its reference point is known.
[[nodiscard]] inline State middle_state(State reference, geometry::Shape const& shape) {
  reference.x += shape.center_offset() * portable::cos(reference.heading);
  reference.y += shape.center_offset() * portable::sin(reference.heading);
  return reference;
}

/// A goal of a planning problem: the middle of the body in one of `areas` (anywhere without one), heading
/// and speed within limits, at a time. As a goal of an agent it leaves the time out, which goals do not see.
struct GoalState {
  std::vector<geometry::Polygon> areas{};                        ///< map frame
  StateLimits limits{};                                          ///< heading and speed
  double first_time = -std::numeric_limits<double>::infinity();  ///< [s]
  double last_time = std::numeric_limits<double>::infinity();    ///< [s]

  /// Whether everything but the time is met.
  [[nodiscard]] bool at_goal(GoalSituation const& at) const {
    double const ahead = at.shape.center_offset();
    geometry::Point const middle{at.pose.x + ahead * portable::cos(at.pose.heading),
                                 at.pose.y + ahead * portable::sin(at.pose.heading)};
    return limits.at_goal(at) && (areas.empty() || std::any_of(areas.begin(), areas.end(), [&](auto const& area) {
                                    return area.contains(middle);
                                  }));
  }
  /// As above, and `time` [s] is within the goal's.
  [[nodiscard]] bool holds(GoalSituation const& at, double time) const {
    constexpr double rounding = 1e-6;  // [s]
    return time >= first_time - rounding && time <= last_time + rounding && at_goal(at);
  }

  /// The drivable lanes whose paths pass an area, the longest stretch first.
  [[nodiscard]] std::vector<LaneId> lanes(Map const& map) const;

  void check(std::string const& where) const { limits.check(where); }

  friend bool operator==(GoalState const& a, GoalState const& b) {
    auto const same = [](geometry::Polygon const& p, geometry::Polygon const& q) {
      return std::equal(p.points().begin(), p.points().end(), q.points().begin(), q.points().end());
    };
    return std::equal(a.areas.begin(), a.areas.end(), b.areas.begin(), b.areas.end(), same) &&
           equal_parameters(a.limits, b.limits) && a.first_time == b.first_time && a.last_time == b.last_time;
  }
};
static_assert(GoalModel<GoalState>);

/// A task for a planner: where it starts, and what reaches its goal.
struct PlanningProblem {
  std::int64_t id = 0;
  State initial{};                 ///< of the middle of the body
  std::vector<GoalState> goals{};  ///< one of them suffices

  /// The goals as the goal of an agent; `NoGoal` without goals.
  [[nodiscard]] Goal goal() const;

  friend bool operator==(PlanningProblem const&, PlanningProblem const&) = default;
};

/// Tracks and the other contents of their file.
struct RecordedTraffic {
  std::string name{};
  double time_step = 0.1;  ///< between two states [s]
  std::vector<Track> tracks{};
  std::vector<PlanningProblem> problems{};
  std::shared_ptr<Map const> map{};        ///< null where the file has none: set it
  std::map<std::int64_t, LaneId> lanes{};  ///< by lanelet, of that map
  std::vector<map::LightPlan> lights{};    ///< of the map's first traffic lights
  std::vector<map::Lanelet> lanelets{};    ///< that the map was made of
  std::vector<Diagnostic> diagnostics{};   ///< oddities of the file

  /// The track of that id. Throws `Error` where there is none. O(tracks).
  [[nodiscard]] Track const& track(std::int64_t id) const;

  /// When the first track that moves begins, and the last one ends [s]; 0 without any.
  [[nodiscard]] double begin() const;
  [[nodiscard]] double end() const;
};

/// Adds the tracks of another file of the same place and time, such as INTERACTION's of pedestrians. An id that is
/// taken becomes the next one that is free above all others. O(tracks log tracks).
void add_tracks(RecordedTraffic& traffic, RecordedTraffic const& more);

/// Throws `Error` where a track has no states, times that do not rise, a number that is not finite, or no size; or
/// where two have the same id.
void check_recorded_traffic(RecordedTraffic const& traffic);

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/scenario/dataset/recorded_traffic_impl.hpp"
#endif
