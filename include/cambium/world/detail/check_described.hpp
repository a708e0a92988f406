#pragma once

#include <string>
#include <tuple>
#include <variant>

#include "cambium/core/parameters.hpp"

namespace cambium::detail {

template <class... Alternatives>
void check_if_described(std::variant<Alternatives...> const& any, std::string const& where);

/// Throws `ParameterError` where a parameter of a described struct, or of the one that a set holds, is out of its
/// range.
template <class Parameters>
void check_if_described(Parameters const& parameters, std::string const& where) {
  if constexpr (Described<Parameters>) check_parameters(parameters, where);
  if constexpr (requires { parameters.any(); }) check_if_described(parameters.any(), where);
}
template <class... Alternatives>
void check_if_described(std::variant<Alternatives...> const& any, std::string const& where) {
  std::visit([&where](auto const& parameters) { check_if_described(parameters, where); }, any);
}

/// As above for an observer, or for those that it is made of.
template <class Observer>
void check_observer(Observer const& observer, std::string const& where) {
  if constexpr (requires { observer.stages; })
    std::apply([&where](auto const&... stage) { (check_observer(stage, where), ...); }, observer.stages);
  else if constexpr (requires { observer.any; })
    std::visit([&where](auto const& one) { check_observer(one, where); }, observer.any);
  else
    check_if_described(observer, where);
}

}  // namespace cambium::detail
