#pragma once

#include <concepts>
#include <type_traits>
#include <variant>

#include "cambium/core/detail/visit.hpp"
#include "cambium/dynamics/dynamic_model.hpp"
#include "cambium/dynamics/integration.hpp"

namespace cambium {

/// One of a closed set of vehicle models with the same state, so that trucks and pedestrians are in one world: each
/// agent has the one that it is given, as in `DynamicSet<SingleTrack, KinematicPoint>(KinematicPoint{})`. Its input is
/// the driver's action.
template <class First, class... Others>
class DynamicSet {
  static_assert(DynamicModel<First> && (DynamicModel<Others> && ...),
                "cambium::DynamicSet<Models...>: each must be a vehicle model (see DynamicModel)");
  static_assert((std::is_same_v<typename First::State, typename Others::State> && ...),
                "cambium::DynamicSet<Models...>: the models must have the same State");

 public:
  using State = typename First::State;
  using Input = Action;
  using Any = std::variant<First, Others...>;

  /// The first of the models with its defaults.
  DynamicSet() = default;

  template <class Model>
  requires(std::same_as<Model, First> || (std::same_as<Model, Others> || ...)) DynamicSet(Model const& model)
      : any_(model) {}  // NOLINT: any of the models is a set's value

  [[nodiscard]] Any const& any() const { return any_; }

  [[nodiscard]] State derivative(State const& x, Action const& u) const {
    return detail::visit([&](auto const& model) { return model.derivative(x, model.input(u, x)); }, any_);
  }
  [[nodiscard]] Action limited(Action const& u, State const& x) const {
    return detail::visit([&](auto const& model) { return action_of(model.input(u, x), u); }, any_);
  }
  [[nodiscard]] Action input(Action const& action, State const& x) const { return limited(action, x); }
  [[nodiscard]] double wheel_base() const {
    return detail::visit([](auto const& model) { return wheel_base_of(model); }, any_);
  }

 private:
  Any any_;
};

/// As above, of the model that the set holds: it moves as it does alone.
template <bool euler = false, class... Models>
[[nodiscard]] typename DynamicSet<Models...>::State drive(DynamicSet<Models...> const& set,
                                                          typename DynamicSet<Models...>::State const& x,
                                                          Action const& action, double dt) {
  return detail::visit([&](auto const& model) { return cambium::drive<euler>(model, x, action, dt); }, set.any());
}

}  // namespace cambium
