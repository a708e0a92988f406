#pragma once

#include <algorithm>
#include <cstdint>

#include "cambium/core/portable_math.hpp"
#include "cambium/core/random.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/observer/observer_model.hpp"
#include "cambium/world/frame.hpp"
#include "cambium/world/static_object.hpp"

namespace cambium::inline v0_1 {

/// The random stream's purpose for observing `agent`; distinct from the purposes that behaviours use.
[[nodiscard]] constexpr std::uint32_t observation_purpose(AgentId agent) {
  return 0x80000000u | static_cast<std::uint32_t>(agent);
}

/// The parts of a world that observers with limited sight read; agents by slot.
template <class World>
class ObserverScene {
 public:
  explicit ObserverScene(World const& world) : world_(&world) {}

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(world_->size()); }
  [[nodiscard]] bool in_traffic(Slot slot) const { return world_->frame().agents[slot].status == AgentStatus::driving; }
  [[nodiscard]] typename World::State const& state(Slot slot) const { return world_->frame().agents[slot].state; }
  [[nodiscard]] geometry::Shape const& shape(Slot slot) const { return world_->roster().agents[slot].shape; }
  [[nodiscard]] IdVector<StaticObject, Slot> const& objects() const { return world_->roster().objects; }

 private:
  World const* world_;
};

namespace detail {

/// The past states that records keep for observers of type `Observer`.
template <class State, class Observer>
struct PastFor {
  using type = NoPast;
};
template <class State, class Observer>
requires(past_steps_of<Observer> > 0) struct PastFor<State, Observer> {
  using type = PastStates<State, past_steps_of<Observer>>;
};
template <class State, class Observer>
using PastOf = typename PastFor<State, Observer>::type;

/// Resets the past of an agent that appears, as if it had always been there.
template <class Record>
void forget_past(Record& record) {
  if constexpr (requires { record.past.fill(record.state); }) record.past.fill(record.state);
}

/// Whether agents may be hidden from the observers of `World`.
template <class World>
inline constexpr bool hides = requires(typename World::Observer const observer, ObserverScene<World> const scene,
                                       Slot slot) {
  observer.sees(scene, slot, slot);
};

/// Whether the agent in slot `own` perceives the agent in slot `other`.
template <class World>
[[nodiscard]] bool is_seen(World const& world, Slot own, Slot other) {
  if constexpr (hides<World>)
    return own == other || world.roster().agents[own].observer.sees(ObserverScene<World>(world), own, other);
  else
    return true;
}

/// Whether static objects may be hidden from the observers of `World`.
template <class World>
inline constexpr bool hides_objects = LimitedSightOfObjects<typename World::Observer, ObserverScene<World>>;

/// Whether the agent in slot `own` perceives the static object with index `object`.
template <class World>
[[nodiscard]] bool is_object_seen(World const& world, Slot own, Slot object) {
  if constexpr (hides_objects<World>)
    return world.roster().agents[own].observer.sees_object(ObserverScene<World>(world), own, object);
  else
    return true;
}

/// The state of the agent in slot `other` as the agent in slot `own` observes it, with the errors of a step. A perfect
/// observer returns the true state.
template <class World>
[[nodiscard]] decltype(auto) seen_state_of_step(World const& world, Slot own, Slot other, std::uint32_t step) {
  auto const& observer = world.roster().agents[own].observer;
  auto const& record = world.frame().agents[other];
  auto const random = [&] {
    return RandomStream(world.roster().seed, static_cast<std::uint32_t>(world.roster().agents[own].id), step,
                        observation_purpose(world.roster().agents[other].id));
  };
  if constexpr (past_steps_of < typename World::Observer >> 0) {
    auto const back = steps_back(observer, own == other);
    return observer.observe(back > 0 ? record.past.states[back - 1] : record.state, own == other, random());
  } else {
    return observer.observe(record.state, own == other, random());
  }
}
template <class World>
[[nodiscard]] decltype(auto) seen_state(World const& world, Slot own, Slot other) {
  return seen_state_of_step(world, own, other, static_cast<std::uint32_t>(world.frame().step));
}

/// Moves a plan that starts in the agent's believed state so that it starts in the true state: rotates and shifts the
/// whole trajectory, and corrects its speeds by the error of the believed speed.
template <class Plan, class State>
void carry_over(Plan& plan, State const& believed, State const& truth) {
  if (believed == truth) return;  // bit-equal to the result with a perfect observer
  double const turn = truth.heading - believed.heading, faster = truth.speed - believed.speed;
  auto const [sin, cos] = portable::sin_cos(turn);
  for (auto& state : plan.trajectory) {
    double const dx = state.x - believed.x, dy = state.y - believed.y;
    double const speed = std::max(0.0, state.speed + faster), gained = speed - state.speed;
    double const further = 0.5 * (faster + gained) * (state.time - truth.time);
    state.heading += turn;
    auto const along = portable::sin_cos(state.heading);
    state.x = truth.x + cos * dx - sin * dy + further * along.cos;
    state.y = truth.y + sin * dx + cos * dy + further * along.sin;
    state.speed = speed;
  }
}

/// The other agent's acceleration as observed [m/s^2]: who sees speeds with errors sees accelerations with errors, as
/// if by the difference of the speeds of two steps, averaged over a second.
template <class World>
[[nodiscard]] double seen_acceleration(World const& world, Slot own, Slot other) {
  constexpr double averaged = 1.0;  // [s]
  auto const& record = world.frame().agents[other];
  auto const step = static_cast<std::uint32_t>(world.frame().step);
  auto const speed_at = [&](std::uint32_t of) { return seen_state_of_step(world, own, other, of).speed; };
  double const error = (speed_at(step) - speed_at(step - 1)) / averaged;
  if constexpr (past_steps_of < typename World::Observer >> 0) {
    auto const back = steps_back(world.roster().agents[own].observer, own == other);
    if (back > 0) return record.past.accelerations[back - 1] + error;
  }
  return static_cast<double>(record.acceleration) + error;
}

}  // namespace detail

}  // namespace cambium::inline v0_1
