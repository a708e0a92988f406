// Lane changes and zip merges of drivers who see with errors, late, or not everybody; and on real roads.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "../behavior/lane_traffic_fixtures.hpp"
#include "../support/scale.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/presets.hpp"
#include "cambium/observer/delayed.hpp"
#include "cambium/observer/observer_set.hpp"
#include "cambium/observer/occluded.hpp"
#include "cambium/observer/parametric.hpp"
#include "cambium/scenario/highway_site.hpp"
#include "corpus_lanes.hpp"

using namespace lane_traffic;

namespace {

using Observer =
    cb::ObserverSet<cb::PerfectObserver, cb::ParametricObserver, cb::DelayedObserver<4>, cb::OccludedObserver>;
using World = cb::World<cb::BehaviorSet<cb::Mobil, cb::LaneChangeRuleBased, cb::ZipMerge>, cb::InterpolateExecution,
                        cb::SingleTrack, Observer>;

struct Sight {
  char const* name;
  Observer observer;
};

/// How drivers may perceive.
std::vector<Sight> sights() {
  cb::ParametricObserver noisy;
  noisy.others = {.along = 0.5, .across = 0.2, .heading = 0.01, .speed = 0.5};
  auto lasting = noisy, lost = noisy;
  lasting.lasting = 10;
  lost.own = {.along = 0.1, .across = 0.05, .heading = 0.005, .speed = 0.1};
  return {{"perfect", {cb::PerfectObserver{}}},
          {"noise", {noisy}},
          {"lasting noise", {lasting}},
          {"noise about itself, too", {lost}},
          {"0.2 s late", {cb::DelayedObserver<4>{.others = 1}}},
          {"0.4 s late", {cb::DelayedObserver<4>{.others = 2}}},
          {"line of sight", {cb::OccludedObserver{}}},
          {"60 m", {cb::OccludedObserver{.range = 60.0}}}};
}

struct Drive {
  int changes = 0;
  double worst_turn = 0.0;  ///< change of the heading against the lane's in one step [rad]
};

/// Steps without a failure or a collision.
Drive drive(World& world, int steps) {
  Drive result;
  for (int k = 0; k < steps; ++k) {
    auto const before = world.frame();
    REQUIRE(world.step(0.2));
    for (std::size_t i = 0; i < world.size(); ++i) {
      auto const &was = before.agents[i], &now = world.frame().agents[i];
      if (now.status != cb::AgentStatus::driving) continue;
      result.changes += was.lane.corridor != now.lane.corridor;
      result.worst_turn = std::max(result.worst_turn, std::abs(now.lane.heading_error - was.lane.heading_error));
    }
    REQUIRE(collisions(world) == 0);
  }
  return result;
}

World::Behavior driver(bool by_rule, double desired_speed) {
  if (by_rule) return cb::LaneChangeRuleBased{.law = {.desired_speed = desired_speed}};
  return cb::Mobil{.law = {.desired_speed = desired_speed}};
}

/// Traffic on these lanes from their begin on: speeds, gaps and sizes drawn, gaps so that nobody need brake hard.
void fill(World& world, std::vector<cb::LaneId> const& lanes, double end, std::uint64_t seed, bool by_rule,
          Observer const& observer) {
  cb::RandomStream random(seed, 0, 0);
  auto const between = [&random](double low, double high) { return low + (high - low) * cb::uniform01(random); };
  double const density = 1.0 + static_cast<double>(seed % 4);
  for (auto const id : lanes) {
    auto const& lane = world.map().lane(id);
    auto const widths = lane.widths[lane.widths.size() / 2];
    bool const is_wide = widths.left + widths.right > 3.3;  // in the bends of narrow lanes trucks swing out
    double speed = between(6.0, 14.0);
    for (double s = 5.0 + between(0.0, 30.0); s < std::min(end, lane.length() - 10.0);) {
      bool const is_truck = cb::uniform01(random) < 0.1 && is_wide;
      auto const shape = is_truck ? cb::geometry::truck() : cb::geometry::car();
      auto const pose = lane.path.pose(s + shape.rear);
      world.add({.position = pose.position(),
                 .heading = pose.heading,
                 .speed = speed,
                 .shape = shape,
                 .behavior = driver(by_rule, between(is_truck ? 8.0 : 9.0, is_truck ? 14.0 : 22.0)),
                 .observer = observer});
      double const next = between(6.0, 14.0);
      s += shape.length() + 4.0 + (1.0 + 3.0 * cb::uniform01(random) / density) * speed +
           std::max(0.0, speed - next) * 3.0;
      speed = next;
    }
  }
}

/// The drivable lanes of a section in one direction, left to right or the other way round.
std::vector<cb::LaneId> lanes_in_direction(cb::Map const& map, cb::map::RoadSection const& section, bool right) {
  std::vector<cb::LaneId> result;
  for (auto const& entry : section.lanes) {
    if (!is_valid(entry.id)) continue;
    auto const& lane = map.lane(entry.id);
    auto const widths = lane.widths[lane.widths.size() / 2];
    if (lane.drivable() && (lane.number < 0) == right && widths.left + widths.right > 2.5) result.push_back(entry.id);
  }
  return result;
}

}  // namespace

TEST_CASE("drivers that see with errors, late or only in part change lanes without collisions") {
  for (bool const by_rule : {false, true})
    for (auto const& sight : sights()) {
      int changes = 0;
      bool const is_slow = std::holds_alternative<cb::OccludedObserver>(sight.observer);
      for (std::uint64_t seed = 1; seed <= support::runs(is_slow ? 1 : 4); ++seed) {
        int const lanes = seed % 2 == 0 ? 3 : 4;
        World world(support::straight_road(lanes, 1500.0, seed % 3 == 0 ? 0.002 : 0.0), {.seed = seed});
        fill(world, lanes_in_direction(world.map(), world.map().roads()[0].sections[0], true), 400.0, seed, by_rule,
             sight.observer);
        CAPTURE(by_rule);
        CAPTURE(std::string(sight.name));
        CAPTURE(seed);
        auto const result = drive(world, 250);
        CHECK(result.worst_turn < 0.16);
        changes += result.changes;
      }
      CHECK(changes > 5);
    }
}

TEST_CASE("nobody collides in slow traffic with many trucks and buses") {
  auto const idm = [](bool is_long) {
    return is_long ? cb::presets::kesting_2010_truck() : cb::presets::kesting_2010_car();
  };
  int changes = 0;
  for (std::uint64_t seed = 1; seed <= support::runs(10); ++seed)
    for (bool const by_rule : {false, true}) {
      int const lanes = seed % 2 == 0 ? 3 : 4;
      World world(support::straight_road(lanes, 1500.0, seed % 3 == 0 ? 0.002 : 0.0), {.seed = seed});
      if (by_rule)
        fill_slow(world, lanes, seed, [&](bool is_long) { return cb::LaneChangeRuleBased{.law = idm(is_long)}; });
      else
        fill_slow(world, lanes, seed, [&](bool is_long) { return cb::Mobil{.law = idm(is_long)}; });
      CAPTURE(by_rule);
      CAPTURE(seed);
      changes += drive(world, 450).changes;
    }
  CHECK(changes > 50 * static_cast<int>(support::runs(10)));
}

TEST_CASE("nobody collides on the corpus' roads of several lanes, whatever they lead to") {
  int roads = 0, changes = 0, agents = 0;
  bool const is_there = corpus::for_each_map([&](std::string const& name, std::shared_ptr<cb::Map const> const& map) {
    std::uint64_t seed = 0, most = support::runs(3);
    for (auto const& road : map->roads())
      for (auto const& section : road.sections)
        for (bool const right : {true, false}) {
          auto const lanes = lanes_in_direction(*map, section, right);
          if (lanes.size() < 2 || map->lane(lanes[0]).length() < 60.0 || seed >= most) continue;
          World world(map, {.seed = ++seed});
          fill(world, lanes, 300.0, seed, seed % 2 == 0, sights()[seed % 3].observer);
          CAPTURE(name);
          CAPTURE(seed);
          CAPTURE(road.name);
          changes += drive(world, 200).changes;
          ++roads;
          agents += static_cast<int>(world.size());
        }
  });
  if (!is_there) return;
  MESSAGE(agents << " vehicles on " << roads << " roads changed lanes " << changes << " times");
  CHECK(roads > 7 * static_cast<int>(std::min(support::runs(3), 3u)));
  CHECK(changes > 30 * static_cast<int>(std::min(support::runs(3), 3u)));
}

TEST_CASE("zip merges come off without collisions where drivers see with errors, late or not everybody") {
  auto const map = support::own_map("lane_drop.xodr");
  std::vector<cb::LaneId> last(5, cb::none<cb::LaneId>);  // by number, of whatever type
  for (auto const& entry : map->roads()[0].sections[0].lanes)
    if (entry.number < 0 && entry.number > -5) last[static_cast<std::size_t>(-entry.number)] = entry.id;
  for (auto const& sight : sights())
    for (std::uint64_t seed = 1; seed <= support::runs(2); ++seed) {
      cb::RandomStream random(seed, 0, 0);
      World world(map, {.seed = seed});
      double s = 380.0;
      for (int i = 0; i < 30; ++i) {
        auto const pose = map->lane(last[i % 2 == 0 ? 2 : 3]).path.pose(s);
        world.add({.position = pose.position(),
                   .heading = pose.heading,
                   .speed = 4.0,
                   .behavior = cb::ZipMerge{.law = {.desired_speed = 12.0 + 4.0 * cb::uniform01(random)}},
                   .observer = sight.observer});
        s -= 7.0 + cb::uniform01(random);
      }
      CAPTURE(std::string(sight.name));
      CAPTURE(seed);
      drive(world, 600);
      int stuck = 0;
      for (auto const& record : world.frame().agents)
        stuck += record.status == cb::AgentStatus::driving && record.state.x < 600.0;
      CHECK(stuck == 0);
    }
}

TEST_CASE("nobody without a goal passes the slow in an exit lane, and then stands at its end") {
  auto const site = cb::find_highway_site(support::own_map("highway_exit.xodr"));
  REQUIRE(site.exits.size() == 1);
  int passed = 0;
  for (bool const keeps_right : {true, false})
    for (std::uint64_t number = 20; number < 20 + support::runs(14); ++number) {
      auto scenario = site.sample(771, static_cast<std::uint32_t>(number));
      for (auto& spec : scenario.agents) {
        auto driver = *std::get_if<cb::Mobil>(&spec.behavior.given());
        driver.lateral.rule.keep_right = keeps_right;
        if (!keeps_right) driver.lateral.rule.bias = 0.0;
        if (spec.shape.length() > 7.0 || number % 3 == index_of(*spec.id) % 3) driver.law.desired_speed *= 0.4;
        spec.speed = std::min(spec.speed, driver.law.desired_speed);
        spec.behavior = driver;
        if (number % 2 == 0) spec.goal = cb::NoGoal{};
      }
      auto world = scenario.make_world();
      for (int k = 0; k < 400; ++k) {
        REQUIRE(world.step(0.2));
        for (cb::Slot slot{}; index_of(slot) < world.size(); ++slot) {
          auto const& record = world.frame().agents[slot];
          if (record.status != cb::AgentStatus::driving) continue;
          auto const view = world.observe(slot);
          if (view.has_goal()) continue;
          double const end = cb::lane_end(view, record.lane.corridor, record.lane.piece);
          INFO("scenario ", number, ", keeps right: ", keeps_right, ", agent ", index_of(view.id()), ", step ", k);
          CHECK_FALSE(cb::is_way_out(view, record.lane.corridor, end));
        }
      }
      for (auto const& record : world.frame().agents) passed += record.status == cb::AgentStatus::left_map;
    }
  CHECK(passed > 100);
}
