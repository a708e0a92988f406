#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <tuple>
#include <utility>

#include "cambium/core/described.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/observer/observer_model.hpp"

namespace cambium::inline v0_1 {

namespace detail {

template <std::size_t number, class Observer>
struct ObserverStage {
  Observer observer{};
};

template <class Numbers, class... Observers>
struct ObserverStages;

template <std::size_t... i, class... Observers>
struct ObserverStages<std::index_sequence<i...>, Observers...> : ObserverStage<i, Observers>... {
  static constexpr char const* keys[] = {"first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth"};
  static_assert(sizeof...(Observers) <= std::size(keys), "cambium::ObserverChain: takes at most eight observers");

  static constexpr bool are_described = (Described<Observers> && ...);
  static constexpr auto parameters() requires are_described {
    return parameter_list(
        parameter(keys[i], &ObserverStage<i, Observers>::observer, "a stage, by its place in the sequence")...);
  }

  /// Calls `f(observer...)` with all stages in order.
  template <class F>
  decltype(auto) with_stages(F const& f) const {
    return f(ObserverStage<i, Observers>::observer...);
  }
};

}  // namespace detail

/// Applies several observers in sequence: each observes the result of the previous one. An agent is visible only if all
/// stages see it; delays add up.
template <ObserverModel... Observers>
struct ObserverChain : detail::ObserverStages<std::index_sequence_for<Observers...>, Observers...> {
  using Stages = detail::ObserverStages<std::index_sequence_for<Observers...>, Observers...>;
  template <std::size_t number>
  using Stage = detail::ObserverStage<number, std::tuple_element_t<number, std::tuple<Observers...>>>;

  ObserverChain() = default;
  explicit(sizeof...(Observers) == 1) constexpr ObserverChain(Observers... stages) requires(sizeof...(Observers) > 0)
      : Stages{{std::move(stages)}...} {}

  /// The stage of that number.
  template <std::size_t number>
  [[nodiscard]] constexpr auto& stage() {
    return Stage<number>::observer;
  }
  template <std::size_t number>
  [[nodiscard]] constexpr auto const& stage() const {
    return Stage<number>::observer;
  }

  static constexpr char const* name = "observer_chain";
  static constexpr char const* summary =
      "one observer after the other: errors and delays add up; an agent hidden from one is hidden";

  static constexpr bool perfect = (Observers::perfect && ...);
  static constexpr std::size_t past_steps = (past_steps_of<Observers> + ... + 0);

  [[nodiscard]] std::size_t steps_back(bool own) const {
    return this->with_stages(
        [own](auto const&... stage) { return (cambium::steps_back(stage, own) + ... + std::size_t{0}); });
  }

  template <class Scene>
  [[nodiscard]] bool sees(Scene const& scene, Slot own, Slot other) const
      requires(LimitedSight<Observers, Scene> || ...) {
    return this->with_stages([&](auto const&... stage) { return (sees_agent(stage, scene, own, other) && ...); });
  }

  template <class Scene>
  [[nodiscard]] bool sees_object(Scene const& scene, Slot own, Slot object) const
      requires(LimitedSightOfObjects<Observers, Scene> || ...) {
    return this->with_stages(
        [&](auto const&... stage) { return (cambium::sees_object(stage, scene, own, object) && ...); });
  }

  /// Returns a value, or a reference to the true state if all stages are perfect.
  template <MotionState S>
  [[nodiscard]] decltype(auto) observe(S const& truth, bool own, RandomStream const& random) const {
    if constexpr (perfect) {
      return (truth);
    } else {
      S seen = truth;
      std::uint32_t number = 0;
      this->with_stages(
          [&](auto const&... stage) { ((seen = stage.observe(S(seen), own, random.part(number++))), ...); });
      return seen;
    }
  }
};

}  // namespace cambium::inline v0_1
