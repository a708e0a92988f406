#pragma once

#include <type_traits>

#include "cambium/core/one_of.hpp"
#include "cambium/dynamics/dynamic_model.hpp"
#include "cambium/dynamics/integration.hpp"

namespace cambium::inline v0_1 {

/// One of a closed set of vehicle models with the same state, so that trucks and pedestrians can share a world. Each
/// agent holds one model, by default the first: `DynamicSet<SingleTrack, KinematicPoint>(KinematicPoint{})`. The input
/// is the driver's action.
template <class First, class... Others>
struct DynamicSet : OneOf<First, Others...> {
  static_assert(DynamicModel<First> && (DynamicModel<Others> && ...),
                "cambium::DynamicSet<Models...>: each must be a vehicle model (see DynamicModel)");
  static_assert((std::is_same_v<typename First::State, typename Others::State> && ...),
                "cambium::DynamicSet<Models...>: the models must have the same State");

  using OneOf<First, Others...>::OneOf;
  using State = typename First::State;
  using Input = Action;

  [[nodiscard]] State derivative(State const& x, Action const& u) const {
    return this->visit([&](auto const& model) { return model.derivative(x, model.input(u, x)); });
  }
  [[nodiscard]] Action limited(Action const& u, State const& x) const {
    return this->visit([&](auto const& model) { return action_of(model.input(u, x), u); });
  }
  [[nodiscard]] Action input(Action const& action, State const& x) const { return limited(action, x); }
  [[nodiscard]] double wheel_base() const {
    return this->visit([](auto const& model) { return wheel_base_of(model); });
  }
};

/// `drive` with the model that the set holds; the result is the same as without the set.
template <bool euler = false, class... Models>
[[nodiscard]] typename DynamicSet<Models...>::State drive(DynamicSet<Models...> const& set,
                                                          typename DynamicSet<Models...>::State const& x,
                                                          Action const& action, double dt) {
  return set.visit([&](auto const& model) { return cambium::drive<euler>(model, x, action, dt); });
}

}  // namespace cambium::inline v0_1
