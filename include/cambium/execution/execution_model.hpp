#pragma once

#include <concepts>
#include <type_traits>

#include "cambium/core/plan.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/single_track.hpp"

namespace cambium::inline v0_1 {

/// The result of executing a plan.
template <MotionState S>
struct Executed {
  S state{};
  bool valid = false;  ///< false: the plan does not reach the requested time
};

namespace detail {
template <class E, class State>
struct ExecutionMemoryOf {
  using type = NoMemory;
};
template <class E, class State>
requires requires { typename E::template Memory<State>; }
struct ExecutionMemoryOf<E, State> {
  using type = typename E::template Memory<State>;
};
}  // namespace detail

/// The memory of execution model `E` between steps, for vehicles with `State`: its `Memory<State>`, or `NoMemory`.
template <class E, class State>
using ExecutionMemoryOf = typename detail::ExecutionMemoryOf<E, State>::type;

/// An execution model: turns a plan into the state at `time` [s] of a vehicle with the model `Dynamics`, exactly or
/// with the errors of a controller. `execute` is pure and does not allocate. A model that keeps something between steps
/// (such as waiting commands) or draws random numbers has a member template `Memory<State>`. The memory starts as `{}`,
/// lives in the frame and is copied with it. `execute` then also takes the agent's memory and its random stream for the
/// step.
template <class E, class Dynamics = SingleTrack>
concept ExecutionModel = std::copyable<E> &&(
    requires(E const model, BasicPlan<typename Dynamics::State> const plan, typename Dynamics::State const x,
             Dynamics const dynamics, double time) {
      { model.execute(plan, x, dynamics, time) } -> std::same_as<Executed<typename Dynamics::State>>;
    } ||
    requires(E const model, BasicPlan<typename Dynamics::State> const plan, typename Dynamics::State const x,
             Dynamics const dynamics, double time, ExecutionMemoryOf<E, typename Dynamics::State> memory,
             RandomStream random) {
      requires std::is_trivially_copyable_v<decltype(memory)>;
      { model.execute(plan, x, dynamics, time, memory, random) } -> std::same_as<Executed<typename Dynamics::State>>;
    });

/// Calls `model.execute`, with memory and random stream if the model takes them; `random()` makes the stream.
template <class E, MotionState S, class Dynamics, class Memory, class Random>
[[nodiscard]] Executed<S> execute(E const& model, BasicPlan<S> const& plan, S const& now, Dynamics const& dynamics,
                                  double time, Memory& memory, Random const& random) {
  if constexpr (requires { model.execute(plan, now, dynamics, time); }) {
    return model.execute(plan, now, dynamics, time);
  } else {
    RandomStream stream = random();
    return model.execute(plan, now, dynamics, time, memory, stream);
  }
}

}  // namespace cambium::inline v0_1
