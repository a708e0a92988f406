#pragma once

#include <cstdint>
#include <limits>
#include <map>

#include "../world/fixtures.hpp"

namespace fixtures {

template <class Observer>
using Observed = cb::World<cb::BehaviorSet<cb::IdmClassic, cb::ConstantAcceleration>, cb::InterpolateExecution,
                           cb::SingleTrack, Observer>;

/// Eight cars, 25 m apart, by turns in two lanes; `traffic_ego` is in the middle of them.
template <class Observer>
Observed<Observer> traffic(Observer const& observer = {}, std::uint64_t seed = 1) {
  Observed<Observer> world(straight_road(2, 1000.0), {.seed = seed});
  for (int i = 0; i < 8; ++i)
    world.add({.position = {100 + 25.0 * i, i % 2 == 0 ? -1.75 : -5.25}, .speed = 8 + 0.5 * i, .observer = observer});
  return world;
}
inline constexpr cb::AgentId traffic_ego{2};

/// What an agent sees of the others.
template <class World>
std::map<cb::AgentId, cb::State> seen_by(World& world, cb::AgentId id) {
  std::map<cb::AgentId, cb::State> seen;
  auto const view = world.observe(id);
  view.around(std::numeric_limits<double>::infinity(),
              [&](auto const& other) { seen[other.agent] = view.state(other); });
  return seen;
}

}  // namespace fixtures
