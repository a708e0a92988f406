// How many iterations a second tree searches do, beside a bare UCT over the flat kernel.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/planner/mcts/mcts.hpp"
#include "cambium/planner/search/parallel_tree_search.hpp"
#include "cambium/world/world.hpp"

#include "../tests/planner/games.hpp"
#include "yardstick/main.hpp"
#include "yardstick/uct.hpp"

namespace cb = cambium;

namespace {

using Kind = cb::MacroAction::Kind;
using Traffic = cb::World<cb::BehaviorSet<cb::MacroActions, cb::IdmClassic>, cb::InterpolateExecution, cb::SingleTrack>;
using Domain = cb::TrafficDomain<Traffic, cb::MacroActions, cb::TrafficReward>;
using Search = cb::TreeSearch<Domain>;

constexpr std::size_t iterations = 1000;

/// Ego in the right lane of maps/merging.xodr, which ends, wants to the left one, where the others drive: the paper's
/// five actions, steps of 0.2 s, goal, collision and leaving the road judged at each.
struct LaneChange {
  Domain domain;
  Domain::State root;

  explicit LaneChange(std::size_t agents) : domain(world_of(agents)) {
    auto const world = world_of(agents);
    cb::Slot const ego{};
    domain = Domain(world, {&ego, 1}, actions(), {}, 0.2);
    root = domain.root();
  }

  static cb::MacroActions actions() {
    return cb::MacroActions::of(
        {{Kind::stay, 0.0}, {Kind::stay, 1.0}, {Kind::stay, -1.0}, {Kind::change_left}, {Kind::change_right}});
  }

  static Traffic world_of(std::size_t agents) {
    static auto const map = cb::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/merging.xodr").map;
    Traffic world(map, {.seed = 1});
    auto const left = map->nearest_lane({100.0, -1.75, 0.0})->lane;
    world.add({.position = {90.0, -5.25},
               .speed = 12.0,
               .behavior = actions(),
               .goal = cb::LaneLimits{.lane = left, .left = 0.5, .right = 0.5, .heading_error = 0.08}});
    for (std::size_t i = 1; i < agents; ++i) {
      bool const beside = i % 3 != 0;
      double const x = (beside ? 30.0 : 60.0) + 24.0 * static_cast<double>(i);
      auto const hit = map->nearest_lane({x, beside ? -1.75 : -5.25, 0.0});
      auto const center = map->lane(hit->lane).path.pose(hit->s);
      world.add({.position = center.position(), .speed = 12.0, .behavior = cb::IdmClassic{}});
    }
    return world;
  }
};

void register_traffic(std::string const& name, std::size_t agents, int horizon) {
  auto bed = std::make_shared<std::unique_ptr<LaneChange>>();
  auto search = std::make_shared<std::unique_ptr<Search>>();
  yardstick::add(name, [=](benchmark::State& state) {
    if (!*bed) {
      *bed = std::make_unique<LaneChange>(agents);
      *search = std::make_unique<Search>((*bed)->domain, cb::TreeSearchParameters{.horizon = horizon}, cb::Ucb1{},
                                         cb::RandomRollout{}, cb::IterationBudget{iterations});
      cb::throw_if((*search)->run((*bed)->root, 1).problem);
    }
    std::uint64_t seed = 0;
    yardstick::measure_search(state, iterations,
                              [&] { benchmark::DoNotOptimize((*search)->run((*bed)->root, ++seed).nodes); });
  });
}

void register_crossing(std::size_t others) {
  auto search = std::make_shared<cb::TreeSearch<games::Crossing>>(
      games::Crossing{others}, cb::TreeSearchParameters{.horizon = 10}, cb::Ucb1{}, cb::RandomRollout{},
      cb::IterationBudget{10 * iterations});
  yardstick::add("search/crossing/" + std::to_string(others), [=](benchmark::State& state) {
    cb::throw_if(search->run({}, 1).problem);
    std::uint64_t seed = 0;
    yardstick::measure_search(state, 10 * iterations, [&] { benchmark::DoNotOptimize(search->run({}, ++seed).nodes); });
  });
}

/// Wall-clock time, trees of 4000 iterations each.
void register_threads(std::size_t trees) {
  auto const name = "search/threads/" + std::to_string(trees);
  auto search = std::make_shared<std::unique_ptr<cb::ParallelTreeSearch<Search>>>();
  auto bed = std::make_shared<std::unique_ptr<LaneChange>>();
  auto* benchmark = yardstick::add(name, [=](benchmark::State& state) {
    auto const each = 4 * iterations;
    if (!*bed) {
      *bed = std::make_unique<LaneChange>(5);
      *search = std::make_unique<cb::ParallelTreeSearch<Search>>(
          Search((*bed)->domain, {.horizon = 10}, {}, {}, {trees * each}), trees);
      cb::throw_if((*search)->run((*bed)->root, 1).problem);
    }
    std::uint64_t seed = 0;
    yardstick::measure_search(state, trees * each,
                              [&] { benchmark::DoNotOptimize((*search)->run((*bed)->root, ++seed).nodes); });
  });
  benchmark->UseRealTime();
}

void register_uct(std::size_t agents, int horizon) {
  auto road = std::make_shared<yardstick::Road>(
      yardstick::mean_spacing * static_cast<double>((agents + yardstick::lane_count - 1) / yardstick::lane_count));
  auto world = std::make_shared<yardstick::FullWorld>(*road, agents);
  for (int i = 0; i < 500; ++i) world->step();
  auto search = std::make_shared<yardstick::Uct>(*world, iterations + 1);
  auto const name = "yardstick/uct/" + std::to_string(agents) + "x" + std::to_string(horizon);
  yardstick::add(name, [=, road = road](benchmark::State& state) {
    std::uint64_t seed = 0;
    yardstick::measure_search(state, iterations,
                              [&] { benchmark::DoNotOptimize(search->run(*world, iterations, horizon, ++seed)); });
  });
}

void print_ratios(yardstick::Results const& results) {
  std::printf("\nratios of the best\n");
  auto const row = [&](char const* a, char const* b, char const* target) {
    if (auto const r = yardstick::ratio(results, a, b)) std::printf("  %-26s / %-22s %6.2f   %s\n", a, b, *r, target);
  };
  row("search/5x10", "yardstick/uct/5x10", "(at least 0.5)");
  row("search/10x30", "yardstick/uct/10x30", "");
  row("search/threads/2", "search/threads/1", "(at least 1.9 on an idle machine)");
  yardstick::print_targets(results, {{"search/5x10", 200e3}, {"search/10x30", 80e3}, {"search/crossing/2", 2e6}});
}

}  // namespace

int main(int argc, char** argv) {
  register_traffic("search/5x10", 5, 10);
  register_traffic("search/10x30", 10, 30);
  register_crossing(2);
  register_crossing(4);
  register_threads(1);
  register_threads(2);
  register_uct(5, 10);
  register_uct(10, 30);
  return yardstick::run_benchmarks(argc, argv, "How many iterations a second tree searches do, beside a bare UCT.",
                                   print_ratios);
}
