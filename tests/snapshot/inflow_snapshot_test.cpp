// Traffic without end goes through a snapshot: who waits, and who comes next.
#include "cambium/snapshot.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cambium/cambium.hpp"
#include "cambium/map/corridor/free_corridor.hpp"
#include "cambium/scenario/traffic_inflow.hpp"
#include "snapshot/fixtures.hpp"
#include "support/maps.hpp"

using namespace cambium;
using namespace fixtures;

namespace {

using Sim = World<BehaviorSet<IdmClassic, Pedestrian>, InterpolateExecution, SingleTrack>;

/// Lanes with two demands, one of which fills up, and people who cross.
std::vector<TrafficSource> sources_on(Map const& map) {
  auto sources = find_sources(map);
  REQUIRE(sources.size() >= 2);
  sources.resize(2);
  sources[0].per_hour = 3000.0;
  std::vector<geometry::Point> const across{{150.0, -12.0}, {150.0, 6.0}};
  sources.push_back({.way = map::build_free_corridor(map, across), .per_hour = 400.0});
  return sources;
}

/// A run of such traffic. How fast agents like to go depends on how many have been drawn, as in a component that
/// counts.
struct Run {
  std::shared_ptr<Map const> map;
  Sim world;
  TrafficInflow<Sim> inflow;
  int drawn = 0;

  Run(std::shared_ptr<Map const> const& on, std::uint64_t seed)
      : map(on), world(on, {.seed = seed}), inflow(*on, sources_on(*on), seed) {}

  void step() {
    inflow.enter(world, [&](TrafficSource const& source, RandomStream& random) -> Sim::AgentSpec {
      double const much = 0.1 * ++drawn;
      if (source.way) return {.speed = 1.2, .shape = geometry::pedestrian(), .behavior = Pedestrian{}};
      return {.speed = 15.0,
              .acceleration = 0.01 * much,
              .behavior = IdmClassic{.law = {.desired_speed = 12.0 + 6.0 * uniform01(random) + much}},
              .route = random_route(*map, source.lane, random, 3000.0)};
    });
    REQUIRE(world.step(0.2));
    inflow.leave(world);
  }
};

constexpr std::uint64_t golden_waiting = 4;
constexpr double golden_speed = 16.3415;

std::uint64_t hash_of(Run const& run) { return snapshot_hash(run.world, run.inflow); }

}  // namespace

TEST_CASE("traffic that comes and goes does so bit by bit after it was saved and restored, in each format") {
  auto const road = support::straight_road(2, 300.0);
  Run original(road, 7);
  std::uint64_t longest = 0;
  std::array<int, 3> came{};
  for (int i = 0; i < 400; ++i) {
    original.step();
    longest = std::max(longest, original.inflow.waiting(0));
    if (i % 20 != 10) continue;
    auto const format = formats[static_cast<std::size_t>(i / 20 % 3)];
    auto const bytes = to_snapshot({.format = format}, original.world, original.inflow);
    Run thawed(road, 1);
    from_snapshot(bytes, "inflow", thawed.world, thawed.inflow);
    thawed.drawn = original.drawn;
    REQUIRE(hash_of(thawed) == hash_of(original));
    auto twin = original;
    for (int k = 0; k < 25; ++k) {
      twin.step();
      thawed.step();
      REQUIRE(hash_of(thawed) == hash_of(twin));
    }
    for (std::size_t s = 0; s < came.size(); ++s) came[s] += twin.inflow.waiting(s) > 0;
  }
  CHECK(longest > 10);
  for (int const count : came) CHECK(count > 0);
  CHECK(original.world.size() > 10);
}

TEST_CASE("an inflow is restored only into one with the same sources, and else keeps its state") {
  auto const road = support::straight_road(2, 300.0);
  Run run(road, 7);
  for (int i = 0; i < 20; ++i) run.step();
  auto const bytes = to_snapshot({}, run.inflow);
  auto const says_after = [&](auto const& change) {
    auto sources = sources_on(*road);
    change(sources);
    TrafficInflow<Sim> other(*road, sources, 1);
    auto const before = snapshot_hash(other);
    says("with other sources", [&] { from_snapshot(bytes, "run.snapshot", other); });
    CHECK(snapshot_hash(other) == before);
  };
  says_after([](auto& sources) { sources.pop_back(); });
  says_after([](auto& sources) { std::swap(sources[0].lane, sources[1].lane); });
  says_after([](auto& sources) { sources[2].per_hour = 401.0; });
  says_after([&](auto& sources) {
    std::vector<geometry::Point> const across{{160.0, -12.0}, {160.0, 6.0}};
    sources[2].way = map::build_free_corridor(*road, across);
  });
  TrafficInflow<Sim> same(*road, sources_on(*road), 1, {.headway = 2.0});
  from_snapshot(bytes, "run.snapshot", same);
  CHECK(snapshot_hash(same) == snapshot_hash(run.inflow));
}

namespace {

/// A driver before and after its version changed.
struct OldDriver : IdmClassic {
  static constexpr char const* name = "old_driver";
  static constexpr auto parameters() { return IdmClassic::parameters(); }
};
struct NewDriver : OldDriver {
  static constexpr unsigned version = 1;
  void upgrade(unsigned) { law.desired_speed += 1.0; }
};
template <class B>
using Traffic = World<BehaviorSet<B>, InterpolateExecution, SingleTrack>;

}  // namespace

TEST_CASE("an inflow of older drivers is upgraded, and still restored only into one with the same sources") {
  auto const road = support::straight_road(2, 300.0);
  auto const sources = find_sources(*road);
  TrafficInflow<Traffic<OldDriver>> old(*road, {sources[0]}, 1);
  Traffic<OldDriver> world(road, {});
  auto const begin = road->lane(sources[0].lane).path.pose(3.0);
  world.add({.position = begin.position()});  // in the way
  old.enter(world, [](TrafficSource const&, RandomStream&) {
    return Traffic<OldDriver>::AgentSpec{.behavior = OldDriver{{.law = {.desired_speed = 9.0}}}};
  });
  REQUIRE(old.waiting(0) == 1);
  auto const bytes = to_snapshot({}, old);
  TrafficInflow<Traffic<NewDriver>> other(*road, sources, 1), same(*road, {sources[0]}, 1);
  says("with other sources", [&] { from_snapshot(bytes, "old", other); });
  from_snapshot(bytes, "old", same);
  Traffic<NewDriver> free(road, {});
  REQUIRE(same.enter(free, [](auto const&...) { return Traffic<NewDriver>::AgentSpec{}; }).size() == 1);
  CHECK(std::get<NewDriver>(free.roster().agents[Slot{}].behavior).law.desired_speed == 10.0);
}

// As with worlds, in snapshot_test.cpp: files of each version of the format stay here for good.
TEST_CASE("inflows of earlier versions load") {
  auto const road = support::straight_road(2, 300.0);
  write_golden("inflow_2", 2, [&] {
    Run run(road, 7);
    for (int i = 0; i < 60; ++i) run.step();
    return run.inflow;
  });
  int const files = for_each_golden("inflow_2", [&](std::string const& path) {
    Run run(road, 1);
    load_snapshot(path, run.inflow);
    CHECK(run.inflow.waiting(0) == golden_waiting);
    run.step();  // whoever waits may enter an empty world
    CHECK(run.inflow.waiting(0) == golden_waiting - 1);
    CHECK(run.world.size() == 2);
    CHECK(std::get<IdmClassic>(run.world.roster().agents[Slot{}].behavior).law.desired_speed ==
          doctest::Approx(golden_speed));
  });
  CHECK(files >= 2);
  CHECK(for_each_golden("inflow_1", [&](std::string const& path) {
          Run run(road, 1);
          says("(law, lateral, heeds, jerk); read it with the program that wrote it",
               [&] { load_snapshot(path, run.inflow); });
        }) == 2);
}

TEST_CASE("a random stream goes on where it was, in the middle of a block, too") {
  RandomStream random(42, 3, 5, 9);
  for (int drawn = 0; drawn < 5; ++drawn) {
    for (auto const format : formats) {
      RandomStream thawed(0, 0, 0);
      from_snapshot(to_snapshot({.format = format}, random), "random", thawed);
      auto twin = random;
      for (int i = 0; i < 9; ++i) CHECK(thawed() == twin());
    }
    static_cast<void>(random());
  }
}
