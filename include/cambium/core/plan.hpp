#pragma once

#include <cstddef>
#include <cstdint>

#include <boost/container/small_vector.hpp>

#include "cambium/core/state.hpp"

namespace cambium {

/// What an agent does over a step: recorded, and seen by nobody but the agent itself and evaluators.
struct Action {
  double acceleration{};  ///< along the heading [m/s^2]
  double steering{};      ///< steering angle at the front axle, left positive [rad]; 0 where the model has none

  friend bool operator==(Action const&, Action const&) = default;
};

/// States that a trajectory holds without heap.
inline constexpr std::size_t inline_states = 12;

/// States in order of time. The first `inline_states` need no heap: the models that need no search never ask for more.
template <MotionState S>
using Trajectory = boost::container::small_vector<S, inline_states>;

/// How a behaviour's plan is to be taken.
enum class PlanStatus : std::uint8_t {
  valid,        ///< covers the time asked for
  not_started,  ///< the agent is not there yet
  expired,      ///< the agent has nothing more to do and leaves
  failed,       ///< the behaviour found no plan
};

/// What a behaviour wants: states over at least the next `dt`, in order of time (the current state need not be among
/// them), and the action that begins them.
template <MotionState S>
struct BasicPlan {
  Trajectory<S> trajectory;
  Action action;
  PlanStatus status = PlanStatus::valid;
  /// The states are places on the map whatever the agent believes of itself, as recorded ones. Others go on from where
  /// it believes to be: they are carried out from where it is.
  bool is_absolute = false;
};

/// The plan type that goes with a view.
template <class View>
using Plan = BasicPlan<typename View::State>;

}  // namespace cambium
