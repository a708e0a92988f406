// Nominal behaviours of RSS-conformant agents: recordings, searches, models that heed conflicts.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "../support/maps.hpp"
#include "cambium/cambium.hpp"

using namespace cambium;

namespace {

using PredictionWorld = World<BehaviorSet<MacroActions, IdmClassic>, InterpolateExecution, SingleTrack>;
using Search = Mcts<PredictionWorld>;
template <class Nominal>
using Safe = RssConformant<Nominal>;
using Sim = World<BehaviorSet<IdmClassic, ConstantAcceleration, Safe<StaticTrajectory>, Search, Safe<Search>,
                              Intersection, Safe<Intersection>, Safe<IdmClassic>>,
                  InterpolateExecution, SingleTrack>;

/// A recording on a straight road from x = 100 m on, at `speed` for 20 s, or standing at once from `stops_at` [s] on.
StaticTrajectory recording(double speed, std::optional<double> stops_at = {}) {
  std::vector<State> states;
  for (int i = 0; i <= 200; ++i) {
    double const t = 0.1 * i, driven = std::min(t, stops_at.value_or(t));
    states.push_back({t, 100 + speed * driven, -1.75, 0.0, driven < t ? 0.0 : speed});
  }
  return StaticTrajectory(states);
}

/// Adds an agent of this shape that drives through the map's junction.
AgentId add_through(Sim& world, geometry::Shape const& shape, Sim::Behavior const& behavior) {
  auto const& map = world.map();
  for (auto const& lane : map.lanes()) {
    if (!lane.drivable() || is_valid(map.road(lane.road).junction) || lane.successors.empty()) continue;
    return world.add({.position = lane.path.pose(20.0).position(),
                      .shape = shape,
                      .behavior = behavior,
                      .route = map::straight_route(map, lane.id)});
  }
  FAIL("the map has no junction");
  return none<AgentId>;
}

}  // namespace

TEST_CASE("a vehicle that had to brake does not jump to where its recording is by then") {
  double const dt = 0.1;
  for (double const leader_speed : {2.0, 5.0, 8.0}) {
    CAPTURE(leader_speed);
    Safe<StaticTrajectory> const driver{recording(15), {}};
    Sim world(support::straight_road(2, 1000.0));
    auto const one = world.add({.position = {100, -1.75}, .speed = 15, .behavior = driver});
    auto const slow = world.add({.position = {150, -1.75}, .speed = leader_speed, .behavior = ConstantAcceleration{}});
    double longest = 0.0;
    for (int i = 0; i < 190; ++i) {
      if (i == 80) world.remove(slow);
      auto const before = world.state(one);
      REQUIRE(world.step(dt));
      auto const after = world.state(one);
      double const way = std::hypot(after.x - before.x, after.y - before.y);
      double const most = before.speed + driver.rss.maximum_acceleration * dt;
      CHECK(after.speed <= most + 1e-9);
      CHECK(way <= 1.05 * most * dt + 0.1);
      CHECK(after.x >= before.x - 1e-9);
      CHECK(std::abs(after.heading) < 1e-6);
      longest = std::max(longest, way);
      if (i == 79) CHECK(100 + 15 * 8.0 - after.x > 20);  // its recording is far ahead
    }
    CHECK(world.state(one).speed == doctest::Approx(15));
    CHECK(longest == doctest::Approx(1.5));
  }
}

TEST_CASE("a vehicle that passes its recording because it cannot brake as hard does not turn round") {
  Sim world(support::straight_road(2, 1000.0));
  auto const one =
      world.add({.position = {100, -1.75}, .speed = 15, .behavior = Safe<StaticTrajectory>{recording(15, 3.0), {}}});
  for (int i = 0; i < 190; ++i) {
    double const x = world.state(one).x;
    REQUIRE(world.step(0.1));
    CHECK(world.state(one).x >= x);
    CHECK(world.state(one).heading == doctest::Approx(0.0));
  }
  CHECK(world.state(one).speed == 0.0);
  CHECK(world.state(one).x ==
        doctest::Approx(145 + 15 * 15 / (2 * RssParameters{}.maximum_deceleration)).epsilon(0.02));
}

TEST_CASE("a search as nominal behaviour drives to the bit when alone, and brakes before an object") {
  Search search;
  search.options.budget.iterations = 20;
  Sim safe(support::straight_road(2, 1000.0)), nominal(safe.shared_map());
  auto const one = safe.add({.position = {100, -1.75}, .speed = 15, .behavior = Safe<Search>{search, {}}});
  auto const other = nominal.add({.position = {100, -1.75}, .speed = 15, .behavior = search});
  for (int i = 0; i < 10; ++i) {
    REQUIRE(safe.step(0.2));
    REQUIRE(nominal.step(0.2));
    CHECK(safe.state(one) == nominal.state(other));
  }
  double const x = safe.state(one).x + 20;  // closer than RSS permits
  safe.add_object(geometry::Polygon({{x, -7}, {x + 4, -7}, {x + 4, 0}, {x, 0}}));
  double const speed = safe.state(one).speed;
  REQUIRE(safe.step(0.2));
  CHECK(safe.state(one).speed <= speed - 0.2 * RssParameters{}.minimum_deceleration + 1e-9);
}

TEST_CASE("agents that heed conflicts must not exceed the conflict shapes, however wrapped and whenever set") {
  auto const map = support::own_map("intersection_4way.xodr");
  Sim world(map);
  auto const large = geometry::articulated_truck();
  Sim::Behavior const heeding[] = {Intersection{}, Safe<Intersection>{}}, others[] = {IdmClassic{}, Safe<IdmClassic>{}};
  auto const refused = doctest::Contains("large_conflict_shape");
  for (auto const& behavior : heeding) {
    CHECK_NOTHROW(world.remove(add_through(world, geometry::bus(), behavior)));
    CHECK_THROWS_WITH_AS(add_through(world, large, behavior), refused, WorldError);
  }
  for (auto const& first : others) {
    auto const truck = add_through(world, large, first);
    for (auto const& behavior : others) CHECK_NOTHROW(world.set_behavior(truck, behavior));
    for (auto const& behavior : heeding) {
      CHECK_THROWS_WITH_AS(world.set_behavior(truck, behavior), refused, WorldError);
      CHECK(world.roster().agents[0].behavior.index() == others[1].index());
    }
    world.remove(truck);
    auto const bus = add_through(world, geometry::bus(), first);
    for (auto const& behavior : heeding) CHECK_NOTHROW(world.set_behavior(bus, behavior));
    world.remove(bus);
  }
}
