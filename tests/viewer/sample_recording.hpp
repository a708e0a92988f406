#pragma once

#include "cambium/viewer/recording.hpp"

/// A straight road of 300 m along x with two lanes, which an ego drives down from x = 10 m, 2 s at 10 m/s and 2 s at
/// 15 m/s, in frames of 0.2 s, past a standing obstacle.
inline cambium::Recording sample_recording() {
  using cambium::RecordedAgentKind;
  cambium::Recording recording{.title = "a short drive", .notes = {"mean speed 10 m/s"}};
  recording.lanes.push_back(
      {.left = {{0, 1.75}, {300, 1.75}}, .right = {{0, -1.75}, {150, -1.75}, {300, -1.75}}, .label = "one"});
  recording.lanes.push_back(
      {.left = {{0, 5.25}, {300, 5.25}}, .right = {{0, 1.75}, {70, 1.75}, {300, 1.75}}, .label = "two"});
  recording.agents.push_back({cambium::AgentId{7}, {3.6, 1.0, 0.9, 0.9}, "ego", RecordedAgentKind::ego});
  recording.agents.push_back({cambium::AgentId{9}, {1.0, 1.0, 1.0, 1.0}, "box", RecordedAgentKind::static_object});
  for (int k = 0; k <= 20; ++k) {
    double const time = 0.2 * k, speed = k < 10 ? 10.0 : 15.0, x = k < 10 ? 10.0 + 10.0 * time : 15.0 * time;
    recording.frames.push_back({time, {{x, 0.0, 0.0, speed, 0.0, true}, {30.0, 3.5, 0.0, 0.0, 0.0, true}}});
  }
  return recording;
}

/// The same with a truck that brakes, a pedestrian, a car that enters late and collides, a stop line and a light, which
/// turns from green to yellow to red.
inline cambium::Recording busy_recording() {
  using cambium::RecordedAgentKind;
  using cambium::map::LightColor;
  auto recording = sample_recording();
  recording.agents.push_back({cambium::AgentId{11}, {7.0, 3.0, 1.2, 1.2}, "truck", RecordedAgentKind::merging});
  recording.agents.push_back({cambium::AgentId{12}, {0.3, 0.3, 0.25, 0.25}, "walker", RecordedAgentKind::other});
  recording.agents.push_back({cambium::AgentId{13}, {3.6, 1.0, 0.9, 0.9}, "", RecordedAgentKind::collided});
  for (auto& frame : recording.frames) {
    double const t = frame.time;
    frame.poses.push_back({150.0 - 5.0 * t, 3.5, 3.125, 5.0, -3.0, true});
    frame.poses.push_back({70.0, -4.0 + t, 1.5, 1.0, 0.0, true});
    frame.poses.push_back({90.0, 0.0, 0.25, 5.0, -1.0, t > 1.0});
    frame.lights = {LightColor::off, t < 1.0 ? LightColor::green : t < 2.0 ? LightColor::yellow : LightColor::red};
  }
  recording.stop_lines = {{{100.0, 1.75}, {100.0, -1.75}, cambium::LightId{1}}, {{50.0, 1.75}, {50.0, -1.75}}};
  return recording;
}
