#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "cambium/core/ids.hpp"
#include "cambium/core/one_of.hpp"
#include "cambium/observer/observer_model.hpp"

namespace cambium::inline v0_1 {

/// One of several observer models, for worlds whose agents perceive differently.
template <ObserverModel... Observers>
struct ObserverSet : OneOf<Observers...> {
  using OneOf<Observers...>::OneOf;

  static constexpr bool perfect = (Observers::perfect && ...);
  static constexpr std::size_t past_steps = std::max({std::size_t{0}, past_steps_of<Observers>...});

  [[nodiscard]] std::size_t steps_back(bool own) const {
    return this->visit([own](auto const& one) { return cambium::steps_back(one, own); });
  }

  template <class Scene>
  [[nodiscard]] bool sees(Scene const& scene, Slot own, Slot other) const
      requires(LimitedSight<Observers, Scene> || ...) {
    return this->visit([&](auto const& one) { return sees_agent(one, scene, own, other); });
  }

  template <class Scene>
  [[nodiscard]] bool sees_object(Scene const& scene, Slot own, Slot object) const
      requires(LimitedSightOfObjects<Observers, Scene> || ...) {
    return this->visit([&](auto const& one) { return cambium::sees_object(one, scene, own, object); });
  }

  template <MotionState S>
  [[nodiscard]] S observe(S const& truth, bool own, RandomStream const& random) const {
    return this->visit([&](auto const& one) { return S(one.observe(truth, own, random)); });
  }
};

}  // namespace cambium::inline v0_1
