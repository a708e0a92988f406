#pragma once

#include <concepts>
#include <type_traits>

#include "cambium/core/one_of.hpp"
#include "cambium/core/plan.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/single_track.hpp"

namespace cambium {

/// What became of a plan.
template <MotionState S>
struct Executed {
  S state{};
  bool valid = false;  ///< false: the plan does not say what happens at the time asked for
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

/// What execution model `E` remembers between steps of vehicles of `State`: its `Memory<State>`, or
/// `NoMemory`.
template <class E, class State>
using ExecutionMemoryOf = typename detail::ExecutionMemoryOf<E, State>::type;

/// Turns a plan into the state at `time` [s], for vehicles of the model `Dynamics`: exactly, or with the errors of a
/// controller. Pure, no allocation. One that remembers something (a delay, what it tracked last) or draws random
/// numbers has a template `Memory<State>`, which begins as `{}`, lives in the frame and is copied with it; `execute`
/// then takes the agent's memory and a stream of its own for this step too.
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

/// Executes with the memory and the random numbers (`random()` makes the stream) that the model takes, if it does.
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

}  // namespace cambium
