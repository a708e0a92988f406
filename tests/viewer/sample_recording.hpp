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
