#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/behavior/lateral/lane_change.hpp"

namespace cambium::inline v0_1 {

/// Brakes to a standstill and steers to the middle of its lane.
struct Safety {
  double deceleration = 4.0;
  LaneChangeCourse course{};

  static constexpr char const* name = "safety";
  static constexpr char const* summary = "brakes to a standstill in the middle of its lane";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    return parameter_list(parameter("deceleration", &Safety::deceleration, "m/s^2", Range{0.01, 50}, "of the braking"),
                          parameter("course", &Safety::course, "how it steers to the middle of its lane"));
  }

  using Memory = LaneChange;

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    double const speed = std::max(0.0, view.state().speed);
    auto const lane = view.place().corridor;
    if (memory.active() ? memory.target != lane : std::abs(view.place().lateral) > off_middle)
      memory = course.begin(lane, view.shape(), speed);
    course.renew(memory, view.shape(), speed);
    return plan_lane_change(view, memory, ConstantAcceleration{.acceleration = -deceleration}.motion(speed, dt), dt);
  }

 private:
  static constexpr double off_middle = 0.05;  // [m]
};
static_assert(BehaviorModel<Safety>);

}  // namespace cambium::inline v0_1
