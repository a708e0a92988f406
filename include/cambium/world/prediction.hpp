#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/core/random.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/observer/perfect.hpp"
#include "cambium/world/detail/entering.hpp"
#include "cambium/world/detail/on_lanes.hpp"
#include "cambium/world/detail/seen.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

/// A planner's assumptions: the behaviours of its own agent and of all others, from one behaviour set.
template <class Set>
struct Prediction {
  static_assert(is_behavior_set<Set>, "cambium::Prediction<Set>: Set must be cambium::BehaviorSet<Models...>");
  typename Set::Any ego;
  typename Set::Any others;
  /// Seed of the predicted world. By default drawn from (world, observer, step), so that it differs from the true seed.
  std::optional<std::uint64_t> seed{};
};

/// The purpose of the execution models' random streams: the one for observing no agent.
inline constexpr std::uint32_t execution_purpose = observation_purpose(none<AgentId>);

/// Assumes that the agent itself behaves as `ego` and all others as `others`, both from `Set`.
template <class Set, class Ego, class Others>
[[nodiscard]] Prediction<Set> predict_as(Ego const& ego, Others const& others) {
  if constexpr (is_behavior_set<Set>)
    static_assert(std::convertible_to<Ego, typename Set::Any> && std::convertible_to<Others, typename Set::Any>,
                  "cambium::Prediction<Set>: the assumed behaviour must be one of the Models of Set");
  return {ego, others, {}};
}

/// Assumes that all agents, the predicting one included, behave as `behavior`, from `Set`.
template <class Set, class Behavior>
[[nodiscard]] Prediction<Set> predict_all_as(Behavior const& behavior) {
  return predict_as<Set>(behavior, behavior);
}

/// The world that the agent at `slot` expects: states as it observes them, behaviours as `prediction` says. The other
/// agents keep their routes, as if they signalled them, but lose their goals. Agents out of traffic and hidden agents
/// are missing; a delayed observation counts as the present state. An agent that is larger than the map's conflicts
/// allow for is predicted all the same, with the zones of `MapOptions::large_conflict_shape` and what it is longer. As
/// `World::add`, throws `ParameterError` if a parameter of an assumed behaviour is out of range.
template <class Set, class World>
[[nodiscard]] typename World::template WithBehaviors<Set> predicted_world(World const& world, Slot slot,
                                                                          Prediction<Set> const& prediction) {
  using Predicted = typename World::template WithBehaviors<Set>;
  static_assert(
      std::is_trivially_copyable_v<typename Predicted::Record> || !std::is_trivially_copyable_v<typename Set::Memory>,
      "a prediction's records must be trivially copyable if the memories of its behaviours are");
  auto const& roster = world.roster();
  auto const& frame = world.frame();
  auto const& observer = roster.agents[slot];
  auto assumed = std::make_shared<typename Predicted::RosterType>();
  constexpr std::uint32_t seed_purpose = 0x7fffffffu;
  auto const stream = [&](std::uint32_t purpose) {
    return RandomStream(roster.seed, static_cast<std::uint32_t>(observer.id), static_cast<std::uint32_t>(frame.step),
                        purpose);
  };
  static_cast<RosterFacts&>(*assumed) = roster;
  assumed->revision = 0;
  detail::check_if_described(prediction.ego, "prediction: ego");
  detail::check_if_described(prediction.others, "prediction: others");
  assumed->seed = prediction.seed ? *prediction.seed : stream(seed_purpose)();
  assumed->has_sequences = roster.has_sequences;
  IdVector<std::uint8_t, Slot> seen_objects(roster.objects.size());
  for (Slot i{}; index_of(i) < roster.objects.size(); ++i) seen_objects[i] = detail::is_object_seen(world, slot, i);
  assumed->assume_objects(roster, seen_objects);
  assumed->free_roads = roster.free_roads;
  typename Predicted::FrameType seen{frame.time, frame.step, {}};
  for (Slot i{}; index_of(i) < roster.agents.size(); ++i) {
    auto const& agent = roster.agents[i];
    auto const& record = frame.agents[i];
    if (record.status != AgentStatus::driving || !detail::is_seen(world, slot, i)) continue;
    auto const& behavior = i == slot ? prediction.ego : prediction.others;
    assumed->agents.push_back(
        {agent.id, agent.shape, agent.road, behavior, agent.execution, agent.dynamics, PerfectObserver{}});
    assumed->assume_goal(i == slot ? &roster : nullptr, i);
    typename World::State state = detail::seen_state(world, slot, i);
    state.time = frame.time;
    auto lane = record.lane;
    if constexpr (!World::Observer::perfect)
      lane = detail::seen_place(world.map(), *agent.road, lane, {state.x, state.y, state.heading}, i != slot);
    double const acceleration = detail::seen_acceleration(world, slot, i);
    Action const action = i == slot ? record.action : Action{acceleration, 0.0};
    seen.agents.push_back({state,
                           lane,
                           action,
                           Set::initial_memory(behavior),
                           AgentStatus::driving,
                           i == slot ? record.goals_passed : std::uint8_t{0},
                           static_cast<float>(acceleration),
                           {},
                           {}});
    if (i == slot) seen.agents.back().execution = record.execution;
  }
  return Predicted(world.shared_map(), std::move(assumed), std::move(seen));
}

}  // namespace cambium::inline v0_1
