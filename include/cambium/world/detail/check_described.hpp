#pragma once

#include <string>
#include <tuple>
#include <variant>

#include "cambium/core/one_of.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium::detail {

/// Throws `ParameterError` if a parameter of a described struct, or of the struct that a set holds, is out of range.
template <class Parameters>
void check_if_described(Parameters const& parameters, std::string const& where) {
  if constexpr (Described<Parameters>) check_parameters(parameters, where);
  if constexpr (Variant<Parameters>)
    std::visit([&where](auto const& one) { check_if_described(one, where); }, parameters);
}

/// The same for an observer, or for the stages of a chain.
template <class Observer>
void check_observer(Observer const& observer, std::string const& where) {
  if constexpr (requires { observer.stages; })
    std::apply([&where](auto const&... stage) { (check_observer(stage, where), ...); }, observer.stages);
  else if constexpr (Variant<Observer>)
    std::visit([&where](auto const& one) { check_observer(one, where); }, observer);
  else
    check_if_described(observer, where);
}

}  // namespace cambium::detail
