#pragma once

#include <variant>

#include "cambium/core/one_of.hpp"
#include "cambium/execution/execution_model.hpp"

namespace cambium::inline v0_1 {

/// One of a closed set of execution models, so that the agents of one world may use different ones:
/// `ExecutionSet<InterpolateExecution, StanleyExecution>(StanleyExecution{})`. The default is the first.
template <class... Models>
struct ExecutionSet : OneOf<Models...> {
  using OneOf<Models...>::OneOf;

  template <MotionState S>
  using Memory = std::variant<ExecutionMemoryOf<Models, S>...>;

  template <MotionState S, class Dynamics>
  [[nodiscard]] Executed<S> execute(BasicPlan<S> const& plan, S const& now, Dynamics const& dynamics, double time,
                                    Memory<S>& memory, RandomStream& random) const {
    return this->visit([&](auto const& model, auto number) {
      if (memory.index() != number) memory.template emplace<number>();
      return cambium::execute(model, plan, now, dynamics, time, *std::get_if<number>(&memory),
                              [&random] { return random; });
    });
  }
};

}  // namespace cambium::inline v0_1
