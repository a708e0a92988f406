// What each behaviour costs in traffic that suits it, beside kernels that do the same work with nothing around it.

#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/law/acc.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/wrap/idm_stochastic.hpp"
#include "cambium/behavior/actions/random_macro_actions.hpp"
#include "cambium/behavior/pedestrian/pedestrian.hpp"
#include "cambium/behavior/wrap/rss_conformant.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/corridor/free_corridor.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/world/world.hpp"

#include "yardstick/main.hpp"
#include "yardstick/register.hpp"
#include "yardstick/winding_road.hpp"

namespace cb = cambium;

namespace {

constexpr double dt = 0.2;         // [s]
constexpr int steps_per_run = 50;  // then the world is set back, so that traffic stays what it was

template <class... Behaviors>
using Sim = cb::World<cb::BehaviorSet<Behaviors...>, cb::InterpolateExecution, cb::SingleTrack>;

/// Vehicles of one behaviour on a three-lane highway; `driver` makes one with a desired speed [m/s].
template <class World, class Driver>
World highway(std::size_t agents, Driver const& driver) {
  double const length = 60.0 * static_cast<double>(agents) / 3.0 + 300.0;
  World world(yardstick::winding_road(length + 800.0), {.seed = 1});
  cb::RandomStream random(7, 0, 0);
  auto const& section = world.map().roads()[0].sections[0];
  std::size_t number = 0;
  while (world.size() < agents) {
    auto const& lane = world.map().lane(section.lanes[number % section.lanes.size()].id);
    double const row = static_cast<double>(number / section.lanes.size());
    ++number;
    if (!lane.drivable()) continue;
    auto const pose = lane.path.pose(10.0 + 60.0 * row + 20.0 * cb::uniform01(random));
    world.add({.position = pose.position(),
               .heading = pose.heading,
               .speed = 10.0 + 6.0 * cb::uniform01(random),
               .behavior = driver(11.0 + 11.0 * cb::uniform01(random))});
  }
  return world;
}

/// Vehicles on the lanes before the project's lane drop, the first ones 60 m before it.
Sim<cb::ZipMerge> lane_drop(std::size_t agents) {
  Sim<cb::ZipMerge> world(cb::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/lane_drop.xodr").map, {.seed = 1});
  cb::RandomStream random(7, 0, 0);
  for (double s = 380.0; world.size() < agents; s -= 25.0)
    for (auto const& entry : world.map().roads()[0].sections[0].lanes) {
      auto const& lane = world.map().lane(entry.id);
      if (!lane.drivable() || world.size() == agents) continue;
      auto const pose = lane.path.pose(s - 8.0 * cb::uniform01(random));
      world.add({.position = pose.position(),
                 .heading = pose.heading,
                 .speed = 10.0 + 4.0 * cb::uniform01(random),
                 .behavior = cb::ZipMerge{.law = {.desired_speed = 11.0 + 11.0 * cb::uniform01(random)}}});
    }
  return world;
}

/// Pedestrians in groups of 20 that meet on a way of their own, 4 m wide.
Sim<cb::Pedestrian> crowd(std::size_t agents) {
  Sim<cb::Pedestrian> world(yardstick::winding_road(300.0), {.seed = 1});
  cb::RandomStream random(8, 0, 0);
  for (double y = 1000.0; world.size() < agents; y += 10.0) {
    std::vector<cb::geometry::Point> const there{{0.0, y}, {100.0, y}}, back{{100.0, y}, {0.0, y}};
    auto const to = cb::map::build_free_corridor(world.map(), there, {.width = 4.0});
    auto const fro = cb::map::build_free_corridor(world.map(), back, {.width = 4.0});
    for (int k = 0; k < 20 && world.size() < agents; ++k)
      world.add({.position = {40.0 + 20.0 * cb::uniform01(random), y + 3.0 * cb::uniform01(random) - 1.5},
                 .speed = 1.3,
                 .shape = cb::geometry::pedestrian(),
                 .behavior = cb::Pedestrian{},
                 .road = k % 2 == 0 ? to : fro});
  }
  return world;
}

/// Vehicles on all arms of the project's four-way crossing, the first ones 30 m before it, by all its ways.
Sim<cb::Intersection> crossing(std::size_t agents) {
  Sim<cb::Intersection> world(cb::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/intersection_4way.xodr").map, {.seed = 1});
  cb::RandomStream random(7, 0, 0);
  for (double row = 0.0; world.size() < agents; row += 16.0)
    for (auto const& lane : world.map().lanes()) {
      if (!lane.drivable() || !lane.predecessors.empty() || world.size() == agents) continue;
      auto const next = cb::uniform_index(random, static_cast<std::uint32_t>(lane.successors.size()));
      auto const pose = lane.path.pose(lane.length() - 30.0 - row);
      cb::map::Route route{{lane.id, lane.successors[next]}, 0.0};
      route.lanes.push_back(world.map().lane(route.lanes.back()).successors.front());
      world.add({.position = pose.position(), .heading = pose.heading, .speed = 7.0, .route = route});
    }
  return world;
}

/// Judges nothing.
struct NoEvaluator {
  template <class World>
  int operator()(World const&) const {
    return 0;
  }
};

/// Steps, each judged by `evaluator`.
template <class World, class Make, class Evaluator = NoEvaluator>
void register_steps(std::string const& name, std::size_t agents, Make make, Evaluator evaluator = {}) {
  auto start = std::make_shared<std::unique_ptr<World>>();  // made when first measured
  yardstick::add("models/" + name + "/" + std::to_string(agents), [=](benchmark::State& state) {
    if (!*start) *start = std::make_unique<World>(make(agents));
    World world = **start;
    int k = 0;
    for (int i = 0; i < 2 * steps_per_run; ++i)  // until everything has its memory
      if (!world.step(dt)) return state.SkipWithError("a step failed");
    world = **start;
    yardstick::measure_step(state, (*start)->size(), [&] {
      if (++k % steps_per_run == 0) world = **start;
      benchmark::DoNotOptimize(world.step(dt));
      benchmark::DoNotOptimize(evaluator(world));
    });
  });
}

void print_ratios(yardstick::Results const& results) {
  yardstick::print_targets(
      results,
      {{"models/mobil/20", 120.0}, {"models/idm_lane_tracking/20", 125.0}, {"models/intersection/10", 2000.0}});
  std::printf("\nratios of the best\n");
  auto const row = [&](char const* a, char const* b, char const* target) {
    if (auto const r = yardstick::ratio(results, a, b)) std::printf("  %-26s / %-22s %6.2f   %s\n", a, b, *r, target);
  };
  row("models/mobil/20", "yardstick/mobil/20", "");
  row("models/mobil/20", "yardstick/full/20", "");
  row("models/idm_lane_tracking/20", "yardstick/full/20", "(target 1.5)");
  row("models/intersection/10", "yardstick/full/10", "");
  for (std::string const name :
       {"idm_classic", "mobil", "rss_conformant", "random_macro_actions", "idm_lane_tracking", "pedestrian"})
    row(("models/" + name + "/10000").c_str(), ("models/" + name + "/100").c_str(), "(linear: about 1)");
}

}  // namespace

int main(int argc, char** argv) {
  for (std::size_t const n : {std::size_t{20}, std::size_t{100}, std::size_t{10000}}) {
    register_steps<Sim<cb::IdmClassic>>("idm_classic", n, [](std::size_t agents) {
      return highway<Sim<cb::IdmClassic>>(agents, [](double v) { return cb::IdmClassic{.law = {.desired_speed = v}}; });
    });
    register_steps<Sim<cb::Mobil>>("mobil", n, [](std::size_t agents) {
      return highway<Sim<cb::Mobil>>(agents, [](double v) { return cb::Mobil{.law = {.desired_speed = v}}; });
    });
    using Acc = cb::AdaptiveCruiseControl;
    register_steps<Sim<Acc>>("adaptive_cruise_control", n, [](std::size_t agents) {
      return highway<Sim<Acc>>(agents, [](double v) { return Acc{.law = {.desired_speed = v}}; });
    });
    register_steps<Sim<cb::IdmStochastic>>("idm_stochastic", n, [](std::size_t agents) {
      return highway<Sim<cb::IdmStochastic>>(agents, [](double) { return cb::IdmStochastic{}; });
    });
    using RuleBased = cb::LaneChangeRuleBased;
    register_steps<Sim<RuleBased>>("lane_change_rule_based", n, [](std::size_t agents) {
      return highway<Sim<RuleBased>>(agents, [](double v) { return RuleBased{.law = {.desired_speed = v}}; });
    });
    using Rss = cb::RssConformant<cb::IdmClassic>;
    register_steps<Sim<Rss>>("rss_conformant", n, [](std::size_t agents) {
      return highway<Sim<Rss>>(agents, [](double v) { return Rss{.nominal = {.law = {.desired_speed = v}}}; });
    });
    register_steps<Sim<cb::RandomMacroActions>>("random_macro_actions", n, [](std::size_t agents) {
      return highway<Sim<cb::RandomMacroActions>>(agents, [](double) { return cb::RandomMacroActions{}; });
    });
  }
  for (std::size_t const n : {std::size_t{20}, std::size_t{100}, std::size_t{10000}}) {
    using World = Sim<cb::IdmLaneTracking>;
    auto const make = [](std::size_t agents) {
      return highway<World>(agents, [](double v) { return cb::IdmLaneTracking{.law = {.desired_speed = v}}; });
    };
    register_steps<World>("idm_lane_tracking", n, make, cb::AnyCollision{});
  }
  for (std::size_t const n : {std::size_t{20}, std::size_t{100}, std::size_t{10000}})
    register_steps<Sim<cb::Pedestrian>>("pedestrian", n, [](std::size_t agents) { return crowd(agents); });
  register_steps<Sim<cb::ZipMerge>>("zip_merge", 20, lane_drop);
  register_steps<Sim<cb::Intersection>>("intersection", 10, crossing);
  yardstick::register_yardsticks();
  return yardstick::run_benchmarks(argc, argv, "What each behaviour costs, beside kernels.", print_ratios);
}
