#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <variant>

#include "cambium/core/parameters.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/world/roster.hpp"

namespace cambium::inline v0_1::detail {

template <class Choice>
[[nodiscard]] bool is_same_choice(Choice const& a, Choice const& b);

/// Whether two values are known to be equal: by their description, by ==, or because their type is empty.
template <class T>
[[nodiscard]] bool is_same_value(T const& a, T const& b) {
  if constexpr (Described<T>)
    return equal_parameters(a, b);
  else if constexpr (Variant<T>)
    return is_same_choice(a, b);
  else if constexpr (std::equality_comparable<T>)
    return a == b;
  else
    return std::is_empty_v<T>;
}

/// The same for variants: goals, behaviours, and sets of vehicle or execution models.
template <class Choice>
[[nodiscard]] bool is_same_choice(Choice const& a, Choice const& b) {
  auto const is_same_as_other = [&b]<class Model>(Model const& model) {
    auto const& other = *std::get_if<Model>(&b);
    if constexpr (requires { model.parts; })
      return std::equal(model.parts.begin(), model.parts.end(), other.parts.begin(), other.parts.end(),
                        is_same_choice<Choice>);
    else if constexpr (requires { model.area; })
      return model.area == other.area;
    else
      return is_same_value(model, other);
  };
  return a.index() == b.index() && std::visit(is_same_as_other, a);
}

/// Whether goals, lights and objects are the same.
[[nodiscard]] bool is_same_besides_agents(RosterBase const& a, RosterBase const& b);

/// Whether two worlds step alike from equal frames: they share map, agents with their roads and behaviours, goals,
/// lights and objects. Then frames of one world also fit the other. O(agents + lanes of their routes).
template <class World>
[[nodiscard]] bool is_same_scene(World const& a, World const& b) {
  auto const &p = a.roster(), &q = b.roster();
  auto const is_same_agent = [](auto const& one, auto const& other) {
    bool const is_same_road =
        one.road == other.road || (!one.road->route.empty() && one.road->route == other.road->route);
    return one.id == other.id && one.shape == other.shape && is_same_road &&
           is_same_choice(one.behavior, other.behavior) && is_same_value(one.dynamics, other.dynamics) &&
           is_same_value(one.execution, other.execution);
  };
  if (&a.map() != &b.map() || p.revision != q.revision || p.agents.size() != q.agents.size() ||
      !is_same_besides_agents(p, q))
    return false;
  for (std::size_t i = 0; i < p.agents.size(); ++i)
    if (!is_same_agent(p.agents[i], q.agents[i])) return false;
  return true;
}

}  // namespace cambium::inline v0_1::detail

#ifndef CAMBIUM_COMPILED
#include "cambium/planner/detail/same_scene_impl.hpp"
#endif
