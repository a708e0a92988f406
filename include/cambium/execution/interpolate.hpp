#pragma once

#include <cmath>

#include "cambium/core/constants.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/execution/execution_model.hpp"
#include "cambium/geometry/angle.hpp"

namespace cambium::inline v0_1 {

/// Perfect execution: returns the plan's state at the requested time. Between two samples, or between now and the first
/// sample, it interpolates every field linearly (with the vehicle model's `add_scaled`), the heading the short way
/// round. It never extrapolates: a plan that does not reach the requested time is invalid.
struct InterpolateExecution {
  static constexpr char const* name = "interpolate";
  static constexpr char const* summary =
      "the plan's state at the requested time, linear between samples; never extrapolates";
  static constexpr char const* source = "interpolation";
  static constexpr auto parameters() { return parameter_list(); }

  template <MotionState S, class Dynamics>
  [[nodiscard]] Executed<S> execute(BasicPlan<S> const& plan, S const& now, Dynamics const&, double time) const {
    auto const& states = plan.trajectory;
    if (states.empty()) return {};
    if (std::abs(states.back().time - time) <= same_time) return at_time(states.back(), time);
    S const* before = &now;
    for (auto const& after : states) {
      if (time >= before->time - same_time && time <= after.time + same_time && before->time < after.time)
        return after.time - time <= same_time ? at_time(after, time) : between(*before, after, time);
      before = &after;
    }
    return {};
  }

 private:
  template <MotionState S>
  [[nodiscard]] static Executed<S> between(S const& a, S const& b, double time) {
    double const u = (time - a.time) / (b.time - a.time);
    S change = add_scaled(b, a, -1.0);
    change.heading = std::remainder(change.heading, 2 * geometry::pi);
    return at_time(add_scaled(a, change, u), time);
  }

  template <MotionState S>
  [[nodiscard]] static Executed<S> at_time(S state, double time) {
    state.time = time;
    return {state, true};
  }
};
static_assert(ExecutionModel<InterpolateExecution>);

}  // namespace cambium::inline v0_1
