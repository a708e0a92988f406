#pragma once

#include <tuple>

#include "cambium/core/parameters.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/execution_model.hpp"

namespace cambium {

/// Perfect execution: the plan's own state at the time asked for, between its samples linearly. Never extrapolates: a plan
/// that does not reach that time is invalid.
struct InterpolateExecution {
  static constexpr char const* name = "interpolate";
  static constexpr auto parameters() { return std::make_tuple(); }

  template <MotionState S, class Dynamics>
  [[nodiscard]] Executed<S> execute(BasicPlan<S> const& plan, S const&, Dynamics const&, double time) const {
    auto const& states = plan.trajectory;
    if (states.empty()) return {};
    constexpr double exact = 1e-9;  // [s] times closer than this are the same
    auto const& back = states.back();
    if (std::abs(back.time - time) <= exact) return at_time(back, time);
    for (std::size_t i = 1; i < states.size(); ++i) {
      auto const &a = states[i - 1], &b = states[i];
      if (time < a.time - exact || time > b.time || !(a.time < b.time)) continue;
      double const u = (time - a.time) / (b.time - a.time);
      S between = a;
      between.x += u * (b.x - a.x);
      between.y += u * (b.y - a.y);
      between.heading += u * std::remainder(b.heading - a.heading, 6.283185307179586);
      between.speed += u * (b.speed - a.speed);
      return at_time(between, time);
    }
    return {};
  }

 private:
  template <MotionState S>
  [[nodiscard]] static Executed<S> at_time(S state, double time) {
    state.time = time;
    return {state, true};
  }
};
static_assert(ExecutionModelFor<InterpolateExecution, SingleTrack>);

}  // namespace cambium
