#pragma once

#include <string>
#include <variant>

#include "cambium/core/one_of.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium::inline v0_1::detail {

/// Throws `ParameterError` if a parameter of a described struct, of the struct that a set holds, or of a described
/// stage in a chain with others, is out of range.
template <class Parameters>
void check_if_described(Parameters const& parameters, std::string const& where) {
  if constexpr (Described<Parameters>)
    check_parameters(parameters, where);
  else if constexpr (Variant<Parameters>)
    std::visit([&where](auto const& one) { check_if_described(one, where); }, parameters);
  else if constexpr (requires { parameters.with_stages([](auto const&...) {}); })
    parameters.with_stages([&where](auto const&... stage) { (check_if_described(stage, where), ...); });
}

/// The same of all models of an agent, or of what describes one.
template <class Agent>
void check_models(Agent const& agent, std::string const& where) {
  check_if_described(agent.behavior, where);
  check_if_described(agent.execution, where);
  check_if_described(agent.dynamics, where);
  check_if_described(agent.observer, where);
}

}  // namespace cambium::inline v0_1::detail
