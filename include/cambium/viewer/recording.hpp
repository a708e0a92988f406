#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/lanes/signals.hpp"

namespace cambium::inline v0_1 {

/// An agent's colour class in the viewers.
enum class RecordedAgentKind : std::uint32_t {
  other = 0,          ///< ordinary traffic
  ego = 1,            ///< the agent under study; viewers follow it
  merging = 2,        ///< an agent that changes or joins a lane
  static_object = 3,  ///< an obstacle
  collided = 4,       ///< an agent that collided; viewers follow the first one instead of the ego
};

/// How a lane is filled and marked in the viewers.
enum class RecordedLaneKind : std::uint32_t {
  driving = 0,   ///< a lane for vehicles
  other = 1,     ///< shoulder, border, parking: paved, but not driven on
  junction = 2,  ///< a lane within a junction; may overlap others
  way = 3,       ///< a path outside the lanes, such as that of a pedestrian: drawn below the lanes, without marks
};

/// The part of a recorded agent that does not change over time.
struct RecordedAgent {
  AgentId id = none<AgentId>;
  geometry::Shape shape{};                            ///< distances from the reference point to the sides [m]
  std::string label{};                                ///< any UTF-8 text, may be empty
  RecordedAgentKind kind = RecordedAgentKind::other;  ///< colour class
};

/// An agent in one frame: pose of its reference point in the map frame, speed and acceleration.
struct RecordedPose {
  double x = 0.0;             ///< [m]
  double y = 0.0;             ///< [m]
  double heading = 0.0;       ///< counter-clockwise from +x [rad]
  double speed = 0.0;         ///< [m/s]
  double acceleration = 0.0;  ///< along the heading [m/s^2]
  bool present = false;       ///< false: not in the world at this time; the other fields mean nothing
};

/// One instant of a recording.
struct RecordedFrame {
  double time = 0.0;                      ///< [s]
  std::vector<RecordedPose> poses{};      ///< one for each of `Recording::agents`, in the same order
  std::vector<map::LightColor> lights{};  ///< state of each traffic light, by `LightId`; lights beyond the end are off
};

/// One lane as the area between two borders. Left and right refer to the order of the points.
struct RecordedLane {
  std::vector<geometry::Point> left{};   ///< [m]
  std::vector<geometry::Point> right{};  ///< [m], in the same direction as `left`; may have another number of points
  std::string label{};                   ///< any UTF-8 text, may be empty
  RecordedLaneKind kind = RecordedLaneKind::driving;  ///< how it is drawn
  bool forward = true;                                ///< traffic follows the order of the points (false: opposes it)
};

/// The line at which the traffic of a lane stops, for a stop sign or a traffic light.
struct RecordedStopLine {
  geometry::Point left{0.0, 0.0};   ///< [m], as seen by approaching traffic
  geometry::Point right{0.0, 0.0};  ///< [m]
  LightId light = none<LightId>;    ///< the traffic light it belongs to; none: a stop sign
};

/// What a viewer shows: lanes, agents, and the agents' poses over time. Plain data that does not depend on a world, so
/// that any program can fill it.
struct Recording {
  std::string title{};
  std::vector<RecordedLane> lanes{};
  std::vector<RecordedStopLine> stop_lines{};
  std::vector<RecordedAgent> agents{};
  std::vector<RecordedFrame> frames{};
  std::vector<std::string> notes{};  ///< one line each, shown below the title
};

/// Throws `Error` unless every frame has a pose for each agent, and the times are finite and strictly ascending.
void check_recording(Recording const& recording);

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/viewer/recording_impl.hpp"
#endif
