#pragma once

#include <concepts>
#include <cstdint>
#include <tuple>
#include <utility>

#include "cambium/behavior/behavior_set.hpp"

namespace cambium {

/// Judges a world: a copyable struct with a `Result` (a struct of named fields) and
///   `template <class World> Result evaluate(World const& world) const`.
/// Pure: what it judges is in the frame.
template <class E, class World>
concept EvaluatorFor = std::copyable<E> && requires(E const evaluator, World const world) {
  { evaluator.evaluate(world) } -> std::same_as<typename E::Result>;
};

namespace detail {
template <class E>
concept HasResult = requires {
  typename E::Result;
};
}  // namespace detail

/// The results of several evaluators in one struct: `result.ego_collision`, `result.goal_reached`, ... Each evaluator
/// may appear once.
template <class... Es>
struct EvaluationResult : Es::Result... {
  static_assert(detail::all_different<Es...>,
                "cambium::Evaluators<...>: each evaluator may appear once, for its results go by name; judge a second "
                "agent by Evaluators of its own");
};

/// Several evaluators as one, put together at compile time.
template <class... Es>
class Evaluators {
  static_assert((detail::HasResult<Es> && ...),
                "cambium::Evaluators<...>: each must have a Result and `template <class World> Result evaluate(World "
                "const&) const` (see EvaluatorFor)");

 public:
  using Result = EvaluationResult<Es...>;

  explicit Evaluators(Es... evaluators) : evaluators_(std::move(evaluators)...) {}

  /// Judges the world as it is now.
  template <class World>
  [[nodiscard]] Result evaluate(World const& world) const {
    static_assert((EvaluatorFor<Es, World> && ...),
                  "cambium::Evaluators<...>: each must have a Result and `template <class World> Result evaluate(World "
                  "const&) const` (see EvaluatorFor)");
    return std::apply([&world](Es const&... e) { return Result{e.evaluate(world)...}; }, evaluators_);
  }

 private:
  std::tuple<Es...> evaluators_;
};

/// Counts the world's steps since `from`, a prediction's with those of the world that it was made in; `timed_out` from
/// `limit` steps on.
struct StepCount {
  struct Result {
    std::uint64_t steps = 0;
    bool timed_out = false;
  };

  std::uint64_t limit = 0;  ///< 0: none
  std::uint64_t from = 0;   ///< `world.frame().step` where counting begins

  template <class World>
  [[nodiscard]] Result evaluate(World const& world) const {
    auto const steps = world.frame().step - from;
    return {steps, limit > 0 && steps >= limit};
  }
};

}  // namespace cambium
