#pragma once

#include <cmath>

#include "cambium/core/parameters.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/execution_model.hpp"
#include "cambium/geometry/angle.hpp"

namespace cambium {

/// Perfect execution: the plan's own state at the time asked for; between its samples, or between now and the first of
/// them, every field linearly (by the `add_scaled` of the vehicle model), the heading the short way. Never
/// extrapolates: a plan that does not reach that time is invalid.
struct InterpolateExecution {
  static constexpr char const* name = "interpolate";
  static constexpr char const* summary =
      "the plan's own state at the time asked for, between two of them linearly; never beyond the plan";
  static constexpr char const* source = "interpolation";
  static constexpr auto parameters() { return parameter_list(); }

  template <MotionState S, class Dynamics>
  [[nodiscard]] Executed<S> execute(BasicPlan<S> const& plan, S const& now, Dynamics const&, double time) const {
    auto const& states = plan.trajectory;
    if (states.empty()) return {};
    if (std::abs(states.back().time - time) <= exact) return at_time(states.back(), time);
    S const* before = &now;
    for (auto const& after : states) {
      if (time >= before->time - exact && time <= after.time + exact && before->time < after.time)
        return after.time - time <= exact ? at_time(after, time) : between(*before, after, time);
      before = &after;
    }
    return {};
  }

 private:
  static constexpr double exact = 1e-9;  // [s] times closer than this are the same

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

}  // namespace cambium
