#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/portable_math.hpp"

namespace cambium::inline v0_1 {

/// Goes on as measured, whatever the lanes and the others: constant turn rate and acceleration, which fade. For what is
/// on no lane, or drives against its lane. It stops rather than reverses, and turns no more once it stands.
struct ConstantTurn {
  double turn_fade = 3.0;
  double acceleration_fade = 1.0;
  double highest_speed = 50.0;

  static constexpr char const* name = "constant_turn";
  static constexpr char const* summary = "goes on as measured: turn rate and acceleration, which fade exponentially";
  static constexpr char const* source = "after Schubert, Richter, Wanielik 2008 (CTRA)";
  static constexpr auto parameters() {
    using P = ConstantTurn;
    return parameter_list(
        parameter("turn_fade", &P::turn_fade, "s", Range{0.01, 1e6}, "time in which the turn rate falls to a third"),
        parameter("acceleration_fade", &P::acceleration_fade, "s", Range{0.01, 1e6}, "likewise, of the acceleration"),
        parameter("highest_speed", &P::highest_speed, "m/s", Range{0, 200}, "limit when accelerating"));
  }

  struct Memory {
    double curvature = 0.0;  ///< of its way, left positive [1/m]

    static constexpr char const* name = "constant_turn_memory";
    static constexpr auto parameters() {
      return parameter_list(parameter("curvature", &Memory::curvature, "1/m", any_finite, "of its way, left positive"));
    }
    friend bool operator==(Memory const&, Memory const&) = default;
  };

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    auto next = view.state();
    double const speed = std::max(0.0, next.speed), acceleration = view.last_acceleration();
    double const held = portable::exp(-dt / acceleration_fade);
    double const limit = acceleration < 0.0 ? 0.0 : std::max(highest_speed, speed);
    double const gain = acceleration * acceleration_fade * (1.0 - held);
    double const free = speed + gain, end = acceleration < 0.0 ? std::max(0.0, free) : std::min(limit, free);
    double way = speed * dt + acceleration * acceleration_fade * (dt - acceleration_fade * (1.0 - held));
    if (end != free)
      way = acceleration < 0.0 ? std::min(speed * dt, -0.5 * speed * speed / acceleration) : 0.5 * (speed + end) * dt;
    double const turn = memory.curvature * way;
    auto const [sin, cos] = portable::sin_cos(next.heading + 0.5 * turn);
    double const chord = std::abs(turn) < 1e-6 ? way : way * portable::sin(0.5 * turn) / (0.5 * turn);
    next.time = view.time() + dt;
    next.x += chord * cos;
    next.y += chord * sin;
    next.heading += turn;
    next.speed = end;
    memory.curvature *= portable::exp(-dt / turn_fade);
    Plan<View> plan;
    plan.trajectory.push_back(next);
    plan.action.acceleration = acceleration * held;
    return plan;
  }
};
static_assert(BehaviorModel<ConstantTurn>);

}  // namespace cambium::inline v0_1
