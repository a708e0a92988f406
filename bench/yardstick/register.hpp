#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>

#include "full.hpp"
#include "idm.hpp"
#include "measure.hpp"
#include "memcpy.hpp"
#include "mobil.hpp"

// Registers the yardsticks in the process that wants to compare itself with them.

namespace yardstick {

inline constexpr std::size_t world_sizes[] = {5, 10, 20, 50, 100, 1000, 10000};

namespace detail {

// A world and the road it may need, made on the first run and driven on by all later ones.
template <class World>
struct Bed {
  Road road;
  World world;

  explicit Bed(std::size_t agents) : road(road_length(agents)), world(make(road, agents)) {
    std::size_t const settling = agents > 1000 ? 300 : 2000;
    for (std::size_t i = 0; i < settling; ++i) world.step();
  }

  Bed(Bed const&) = delete;  // the world points to the road
  Bed& operator=(Bed const&) = delete;

 private:
  [[nodiscard]] static double road_length(std::size_t agents) {
    return mean_spacing * static_cast<double>((agents + lane_count - 1) / lane_count);
  }

  [[nodiscard]] static World make(Road const& road, std::size_t agents) {
    if constexpr (std::is_constructible_v<World, Road const&, std::size_t>) {
      return World(road, agents);
    } else {
      return World(agents);
    }
  }
};

// A number of a traffic that has gone astray would be worth nothing.
template <class World>
void check_traffic(benchmark::State& state, World const& world) {
  double const speed = world.mean_speed();
  state.counters["mean_speed"] = speed;
  if (speed > 5.0 && speed < 20.0) return;
  state.SetLabel("the traffic has left the range of sensible speeds");
  state.SkipWithError("the traffic has left the range of sensible speeds");
}

template <class World>
void register_world(std::string const& kernel, std::size_t agents) {
  auto bed = std::make_shared<std::unique_ptr<Bed<World>>>();
  add("yardstick/" + kernel + "/" + std::to_string(agents), [bed, agents](benchmark::State& state) {
    if (*bed == nullptr) *bed = std::make_unique<Bed<World>>(agents);
    World& world = (*bed)->world;
    benchmark::DoNotOptimize(&world);
    if constexpr (std::is_same_v<World, FullWorld>) {
      std::size_t overlaps = 0;
      measure_step(state, agents, [&] { overlaps += world.step(); });
      state.counters["overlaps"] = static_cast<double>(overlaps);
    } else {
      measure_step(state, agents, [&] { world.step(); });
    }
    check_traffic(state, world);
  });
}

inline void register_memcpy(std::size_t agents) {
  add("yardstick/memcpy/" + std::to_string(agents), [agents](benchmark::State& state) {
    FlatCopy buffers(agents);
    benchmark::DoNotOptimize(buffers.source());
    benchmark::DoNotOptimize(buffers.target());
    measure_copy(state, [&] { buffers.copy(); });
  });
}

// Flat roll-out: copy a world of 5 into a warm one, then 10 steps with collision check.
inline void register_rollout() {
  auto bed = std::make_shared<std::unique_ptr<Bed<FullWorld>>>();
  add("yardstick/rollout/5x10", [bed](benchmark::State& state) {
    if (*bed == nullptr) *bed = std::make_unique<Bed<FullWorld>>(5);
    FullWorld const& start = (*bed)->world;
    FullWorld scratch = start;
    std::size_t overlaps = 0;
    measure_rate(state, [&] {
      scratch = start;
      for (int i = 0; i < 10; ++i) overlaps += scratch.step();
    });
    benchmark::DoNotOptimize(overlaps);
    check_traffic(state, scratch);
  });
}

}  // namespace detail

/// Registers yardstick/{idm, mobil, full, memcpy}/N for all `world_sizes`, and yardstick/rollout/5x10.
inline void register_yardsticks() {
  for (std::size_t const agents : world_sizes) detail::register_world<IdmRing>("idm", agents);
  for (std::size_t const agents : world_sizes) detail::register_world<MobilRing>("mobil", agents);
  for (std::size_t const agents : world_sizes) detail::register_world<FullWorld>("full", agents);
  for (std::size_t const agents : world_sizes) detail::register_memcpy(agents);
  detail::register_rollout();
}

}  // namespace yardstick
