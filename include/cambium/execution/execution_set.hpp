#pragma once

#include <concepts>
#include <cstddef>
#include <type_traits>
#include <variant>

#include "cambium/execution/execution_model.hpp"

namespace cambium {

/// One of a closed set of execution models, so that agents of one world differ in it: as in
/// `ExecutionSet<InterpolateExecution, StanleyExecution>(StanleyExecution{})`.
template <class First, class... Others>
class ExecutionSet {
 public:
  using Any = std::variant<First, Others...>;

  template <MotionState S>
  using Memory = std::variant<ExecutionMemoryOf<First, S>, ExecutionMemoryOf<Others, S>...>;

  /// The first of the models with its defaults.
  ExecutionSet() = default;

  template <class Model>
  requires(std::same_as<Model, First> || (std::same_as<Model, Others> || ...)) ExecutionSet(Model const& model)
      : any_(model) {}  // NOLINT: any of the models is a set's value

  [[nodiscard]] Any const& any() const { return any_; }

  template <MotionState S, class Dynamics>
  [[nodiscard]] Executed<S> execute(BasicPlan<S> const& plan, S const& now, Dynamics const& dynamics, double time,
                                    Memory<S>& memory, RandomStream& random) const {
    return from<0>(plan, now, dynamics, time, memory, random);
  }

 private:
  template <std::size_t i, class S, class Dynamics>
  [[nodiscard]] Executed<S> from(BasicPlan<S> const& plan, S const& now, Dynamics const& dynamics, double time,
                                 Memory<S>& memory, RandomStream& random) const {
    if constexpr (i < sizeof...(Others))
      if (any_.index() != i) return from<i + 1>(plan, now, dynamics, time, memory, random);
    if (memory.index() != i) memory.template emplace<i>();
    return cambium::execute(*std::get_if<i>(&any_), plan, now, dynamics, time, *std::get_if<i>(&memory),
                            [&random] { return random; });
  }

  Any any_;
};

}  // namespace cambium
