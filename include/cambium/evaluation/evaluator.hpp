#pragma once

#include <concepts>

#include "cambium/core/ids.hpp"

namespace cambium::inline v0_1 {

/// Judges one agent of a world: a copyable struct with
///   `template <class World> auto operator()(World const& world, Slot slot) const`
/// that returns a bool (whether ...) or a number (how much ...). Pure: it reads only the frame and the roster, or with
/// `static constexpr bool needs_history = true` the frames before, `World::history`; where a world keeps none, it has
/// to return 0, and predictions keep none, so that it cannot be a term of a planner. An evaluator that needs neighbours
/// takes a `World&` and looks through the view `world.truth(slot)`, which shows the world as it is
/// (`world.observe(slot)` shows what the agent perceives). The same evaluator serves as a metric, as a terminal
/// criterion and as a term by which planners judge, see `Terms`.
template <class E, class World>
concept EvaluatorFor = std::copyable<E> && requires(E const evaluator, World& world) {
  { evaluator(world, Slot{}) } -> std::convertible_to<double>;
};

}  // namespace cambium::inline v0_1
