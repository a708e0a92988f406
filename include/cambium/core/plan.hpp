#pragma once

#include <cstddef>
#include <cstdint>

#include <boost/container/small_vector.hpp>

#include "cambium/core/described.hpp"
#include "cambium/core/state.hpp"

namespace cambium::inline v0_1 {

/// What an agent does over a step. It is recorded; only the agent itself and evaluators see it.
struct Action {
  double acceleration{};  ///< along the heading [m/s^2]
  double steering{};      ///< steering angle at the front axle, left positive [rad]; 0 where the model has none

  static constexpr char const* name = "action";
  static constexpr auto parameters() {
    using P = Action;
    return parameter_list(parameter("acceleration", &P::acceleration, "m/s^2", any_finite, "along the heading"),
                          parameter("steering", &P::steering, "rad", any_finite, "steering angle, left positive"));
  }

  friend bool operator==(Action const&, Action const&) = default;
};

/// Number of states that a trajectory holds without heap memory.
inline constexpr std::size_t inline_states = 12;

/// States in order of time. It allocates only beyond `inline_states`, which models without a search never exceed.
template <MotionState S>
using Trajectory = boost::container::small_vector<S, inline_states>;

/// Whether a behaviour's plan can be executed, and if not, why.
enum class PlanStatus : std::uint8_t {
  valid,        ///< covers the requested time
  not_started,  ///< the agent has not entered yet
  expired,      ///< the agent has nothing more to do and leaves
  failed,       ///< the behaviour found no plan
};

/// A behaviour's plan: states in order of time that cover at least the next `dt` (the current state may be left out),
/// and the first action. If the action's acceleration is 0, that of the executed motion is recorded.
template <MotionState S>
struct BasicPlan {
  Trajectory<S> trajectory;
  Action action;
  PlanStatus status = PlanStatus::valid;
  /// True if the states are fixed places on the map, such as recorded ones. Otherwise they continue from where the
  /// agent believes it is, and are shifted to start from its true state.
  bool is_absolute = false;
};

/// The plan type of a view.
template <class View>
using Plan = BasicPlan<typename View::State>;

}  // namespace cambium::inline v0_1
