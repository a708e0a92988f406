// What a step of the world, a copy and a roll-out cost, beside kernels that do the same work with nothing around it.

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/scenario/lane_traffic.hpp"
#include "cambium/world/world.hpp"

#include "yardstick/main.hpp"
#include "yardstick/register.hpp"
#include "yardstick/winding_road.hpp"

namespace cb = cambium;

namespace {

using Sim =
    cb::World<cb::BehaviorSet<cb::IdmClassic, cb::ConstantAcceleration>, cb::InterpolateExecution, cb::SingleTrack>;

constexpr double dt = 0.2;         // [s]
constexpr int steps_per_run = 50;  // then the world is set back, so that traffic stays what it was

/// Puts `agents` vehicles on the lane corridors of the map's entrances, densely, the first ones first.
void fill(Sim& world, std::size_t agents, double end) {
  cb::RandomStream random(7, 0, 0);
  auto const& map = world.map();
  struct Entrance {
    cb::map::Route route;
    std::shared_ptr<cb::map::RoadCorridor const> road;
    std::vector<cb::LaneVehicle> vehicles;
  };
  std::vector<Entrance> entrances;
  for (auto const& lane : map.lanes()) {
    if (!lane.drivable() || !lane.predecessors.empty()) continue;
    cb::LaneTraffic traffic;
    auto const route = cb::map::straight_route(map, lane.id, 1e9);
    auto const road = cb::map::build_road_corridor(map, route);
    traffic.end = std::min(end, road->corridors[road->main].length() - 20.0);
    entrances.push_back({route, road, traffic.sample(random)});
  }
  for (std::size_t i = 0; world.size() < agents; ++i) {
    auto const& [route, road, vehicles] = entrances[i % entrances.size()];
    if (i / entrances.size() >= vehicles.size()) {
      if (i > 100 * agents)
        throw cb::WorldError("bench", "the road is too short for " + std::to_string(agents) + " agents");
      continue;
    }
    auto const& v = vehicles[i / entrances.size()];
    auto const pose = road->corridors[road->main].center.pose(v.s);
    world.add({.position = pose.position(),
               .heading = pose.heading,
               .speed = v.speed,
               .shape = v.shape,
               .behavior = v.driver,
               .route = route});
  }
}

std::shared_ptr<cb::Map const> merging_map() {
  static auto const map = cb::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/merging.xodr").map;
  return map;
}

Sim highway_world(std::size_t agents) {
  double const length = 60.0 * static_cast<double>(agents) / 3.0 + 300.0;
  Sim world(yardstick::winding_road(length + 800.0), {.seed = 1});
  fill(world, agents, length);
  return world;
}

/// Vehicles before the merge of maps/merging.xodr.
Sim merging_world(std::size_t agents) {
  Sim world(merging_map(), {.seed = 1});
  fill(world, agents, 280.0);
  return world;
}

void measure_steps(benchmark::State& state, Sim const& start) {
  Sim world = start;
  int k = 0;
  for (int i = 0; i < 2 * steps_per_run; ++i)  // until everything has its memory
    if (!world.step(dt)) return state.SkipWithError("a step failed");
  world = start;
  yardstick::measure_step(state, start.size(), [&] {
    if (++k % steps_per_run == 0) world = start;
    benchmark::DoNotOptimize(world.step(dt));
  });
}

template <class Make>
void register_steps(std::string const& name, std::size_t agents, Make make) {
  auto start = std::make_shared<std::unique_ptr<Sim>>();  // made when first measured
  yardstick::add(name + "/" + std::to_string(agents), [=](benchmark::State& state) {
    if (!*start) *start = std::make_unique<Sim>(make(agents));
    measure_steps(state, **start);
  });
}

void register_copies(std::size_t agents) {
  auto const name = std::to_string(agents);
  auto world = std::make_shared<std::unique_ptr<Sim const>>();  // made when first measured
  auto const first = [=]() -> Sim const& {
    if (!*world) *world = std::make_unique<Sim const>(highway_world(agents));
    return **world;
  };
  yardstick::add("copy/fresh/" + name, [=](benchmark::State& state) {
    Sim const& start = first();
    yardstick::measure_copy(state, [&] {
      Sim copy = start;
      benchmark::DoNotOptimize(copy.frame().agents.data());
    });
  });
  yardstick::add("copy/warm/" + name, [=](benchmark::State& state) {
    Sim const& start = first();
    Sim copy = start;
    yardstick::measure_copy(state, [&] {
      copy = start;
      benchmark::DoNotOptimize(copy.frame().agents.data());
    });
  });
}

void register_rollout() {
  yardstick::add("rollout/5x10", [](benchmark::State& state) {
    Sim const start = merging_world(5);
    Sim world = start;
    yardstick::measure_rate(state, [&] {
      world = start;
      bool collision = false;
      for (int i = 0; i < 10; ++i) {
        benchmark::DoNotOptimize(world.step(dt));
        collision = collision || cb::AnyCollision{}(world);
      }
      benchmark::DoNotOptimize(collision);
    });
  });
}

/// What a planner does in each cycle: a world of its own objects, along routes of their own, on a map that has met
/// them.
void register_filling() {
  yardstick::add("fill/20", [](benchmark::State& state) {
    Sim const start = merging_world(20);
    yardstick::measure_duration(state, [&] {
      Sim world(start.shared_map(), {.seed = 1});
      for (std::size_t i = 0; i < start.size(); ++i) {
        auto const& agent = start.roster().agents[i];
        auto const& now = start.frame().agents[i].state;
        world.add({.position = {now.x, now.y},
                   .heading = now.heading,
                   .speed = now.speed,
                   .shape = agent.shape,
                   .behavior = agent.behavior,
                   .route = cb::map::Route{.lanes = agent.road->route}});
      }
      benchmark::DoNotOptimize(world.frame().agents.data());
    });
  });
}

void register_load() {
  yardstick::add("load/merging", [](benchmark::State& state) {
    yardstick::measure_duration(
        state, [] { benchmark::DoNotOptimize(cb::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/merging.xodr").map.get()); });
  });
}

void print_ratios(yardstick::Results const& results) {
  std::printf("\nratios of the best\n");
  auto const row = [&](char const* a, char const* b, char const* target) {
    if (auto const r = yardstick::ratio(results, a, b)) std::printf("  %-26s / %-22s %6.2f   %s\n", a, b, *r, target);
  };
  row("step/idm_classic/20", "yardstick/full/20", "(at most 1.0)");
  row("step/merging/20", "yardstick/full/20", "(at most 1.0)");
  row("step/idm_classic/10000", "step/idm_classic/100", "(at most 1.3)");
  for (char const* n : {"5", "10", "20", "50", "100", "1000", "10000"})
    row((std::string("copy/warm/") + n).c_str(), (std::string("yardstick/memcpy/") + n).c_str(), "(at most 2)");
  row("rollout/5x10", "yardstick/rollout/5x10", "(rates: larger is better)");
}

}  // namespace

int main(int argc, char** argv) {
  for (std::size_t const n : yardstick::world_sizes) register_steps("step/idm_classic", n, highway_world);
  for (std::size_t const n : {std::size_t{5}, std::size_t{10}, std::size_t{20}})
    register_steps("step/merging", n, merging_world);
  for (std::size_t const n : yardstick::world_sizes) register_copies(n);
  register_rollout();
  register_filling();
  register_load();
  yardstick::register_yardsticks();
  return yardstick::run_benchmarks(argc, argv, "What steps, copies, roll-outs and loading cost, beside kernels.",
                                   print_ratios);
}
