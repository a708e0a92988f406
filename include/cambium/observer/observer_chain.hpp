#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>

#include "cambium/core/ids.hpp"
#include "cambium/observer/observer_model.hpp"

namespace cambium {

/// Applies several observers in sequence: each observes the result of the previous one. An agent is visible only if all
/// stages see it; delays add up.
template <ObserverModel... Observers>
struct ObserverChain {
  std::tuple<Observers...> stages{};

  static constexpr char const* name = "observer_chain";
  static constexpr char const* summary =
      "one observer after the other: errors and delays add up; an agent hidden from one is hidden";

  static constexpr bool perfect = (Observers::perfect && ...);
  static constexpr std::size_t past_steps = (past_steps_of<Observers> + ... + 0);

  [[nodiscard]] std::size_t steps_back(bool own) const {
    return std::apply([own](auto const&... stage) { return (cambium::steps_back(stage, own) + ... + std::size_t{0}); },
                      stages);
  }

  template <class Scene>
  [[nodiscard]] bool sees(Scene const& scene, Slot own, Slot other) const
      requires(LimitedSight<Observers, Scene> || ...) {
    auto const by = [&](auto const& stage) {
      if constexpr (LimitedSight<std::remove_cvref_t<decltype(stage)>, Scene>)
        return stage.sees(scene, own, other);
      else
        return true;
    };
    return std::apply([&](auto const&... stage) { return (by(stage) && ...); }, stages);
  }

  template <class Scene>
  [[nodiscard]] bool sees_object(Scene const& scene, Slot own, Slot object) const
      requires(LimitedSightOfObjects<Observers, Scene> || ...) {
    auto const by = [&](auto const& stage) {
      if constexpr (LimitedSightOfObjects<std::remove_cvref_t<decltype(stage)>, Scene>)
        return stage.sees_object(scene, own, object);
      else
        return true;
    };
    return std::apply([&](auto const&... stage) { return (by(stage) && ...); }, stages);
  }

  /// Returns a value, or a reference to the true state if all stages are perfect.
  template <MotionState S>
  [[nodiscard]] decltype(auto) observe(S const& truth, bool own, RandomStream const& random) const {
    if constexpr (perfect) {
      return (truth);
    } else {
      S seen = truth;
      std::uint32_t number = 0;
      std::apply([&](auto const&... stage) { ((seen = stage.observe(S(seen), own, random.part(number++))), ...); },
                 stages);
      return seen;
    }
  }
};

}  // namespace cambium
