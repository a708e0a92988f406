#pragma once

#include <concepts>

#include "cambium/core/plan.hpp"
#include "cambium/dynamics/single_track.hpp"

namespace cambium {

/// What became of a plan.
template <MotionState S>
struct Executed {
  S state{};
  bool valid = false;  ///< false: the plan does not say what happens at the time asked for
};

/// Turns a plan into the state at `time` [s], for vehicles of the model `Dynamics`: exactly, or with the errors of a
/// controller. Pure, no allocation.
template <class E, class Dynamics = SingleTrack>
concept ExecutionModel = std::copyable<E> &&
    requires(E const model, BasicPlan<typename Dynamics::State> const plan, typename Dynamics::State const x,
             Dynamics const dynamics, double time) {
  { model.execute(plan, x, dynamics, time) } -> std::same_as<Executed<typename Dynamics::State>>;
};

}  // namespace cambium
