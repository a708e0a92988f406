// Sampled situations: the same laws for merges, highways and junctions.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <variant>

#include "../support/maps.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/off_road.hpp"
#include "cambium/scenario/highway_site.hpp"
#include "cambium/scenario/junction_site.hpp"
#include "cambium/scenario/merging_site.hpp"
#include "figure.hpp"

using namespace cambium;

namespace {

template <class Site>
struct Found;
template <>
struct Found<MergingSite> {
  static constexpr char const *own_map = "merging.xodr", *unfit = "highway.xodr";
  static constexpr double figure = 1277206.1906;
  static constexpr auto on = find_merging_site;
};
template <>
struct Found<HighwaySite> {
  static constexpr char const *own_map = "highway_exit.xodr", *unfit = "roundabout.xodr";
  static constexpr double figure = 950514.1767;
  static constexpr auto on = find_highway_site;
};
template <>
struct Found<JunctionSite> {
  static constexpr char const *own_map = "intersection_4way.xodr", *unfit = "highway.xodr";
  static constexpr double figure = 73506.9069;
  static constexpr auto on = find_junction_site;
};

template <class Site>
Site own_site() {
  return Found<Site>::on(support::own_map(Found<Site>::own_map), "map");
}

/// All that a step can depend on, in the bits of the numbers.
template <class World>
std::string text_of(World const& world) {
  std::string text;
  for (auto const& agent : world.roster().agents) {
    auto const& state = world.state(agent.id);
    std::visit([&](auto const& behavior) { text += std::to_string(hash_parameters(behavior)); }, agent.behavior);
    text += ' ' + to_string(agent.id);
    for (double const value : {state.x, state.y, state.heading, state.speed, agent.shape.front, agent.shape.rear}) {
      char bits[32];
      std::snprintf(bits, sizeof bits, " %a", value);
      text += bits;
    }
  }
  return text;
}

}  // namespace

TEST_CASE_TEMPLATE("a seed and a number give one situation, others another", Site, MergingSite, HighwaySite,
                   JunctionSite) {
  auto const site = own_site<Site>();
  auto const text = [&](std::uint64_t seed, std::uint32_t number) {
    return text_of(site.sample(seed, number).make_world());
  };
  auto const first = text(3, 5);
  static_cast<void>(text(3, 6));
  CHECK(text(3, 5) == first);
  CHECK(text(3, 6) != first);
  CHECK(text(4, 5) != first);
  double figure = 0.0;
  for (std::uint32_t number = 0; number < 5; ++number) figure += figure_of(site.sample(3, number));
  CHECK(figure == doctest::Approx(Found<Site>::figure).epsilon(1e-8));  // on every platform
}

TEST_CASE_TEMPLATE("a sampled situation begins without contact, on the road, with an ego among others", Site,
                   MergingSite, HighwaySite, JunctionSite) {
  auto const site = own_site<Site>();
  std::size_t agents = 0;
  for (std::uint32_t number = 0; number < 50; ++number) {
    CAPTURE(number);
    auto const scenario = site.sample(11, number);
    auto world = scenario.make_world();
    REQUIRE(world.size() == scenario.agents.size());
    REQUIRE(world.size() >= 2);
    agents += world.size();
    CHECK(world.roster().seed == 11);
    CHECK(world.slot_of(scenario.ego) < Slot(world.size()));
    CHECK_FALSE(AnyCollision{}(world));
    for (Slot slot{}; index_of(slot) < world.size(); ++slot) {
      CHECK_FALSE(OffRoad{}(world, slot));
      CHECK(world.roster().agents[slot].id == *scenario.agents[index_of(slot)].id);
    }
  }
  CHECK(agents > 50 * 4);
}

TEST_CASE_TEMPLATE("another world takes the same situation with behaviours of its own", Site, MergingSite, HighwaySite,
                   JunctionSite) {
  using Other = World<BehaviorSet<ConstantAcceleration>, InterpolateExecution, SingleTrack>;
  auto const site = own_site<Site>();
  auto const scenario = site.sample(1, 2);
  std::size_t asked = 0;
  auto const other = with_behaviors<Other>(scenario, [&](auto const& agent) {
    asked += is_valid(*agent.id);
    return ConstantAcceleration{.acceleration = 0.5};
  });
  CHECK(asked == scenario.agents.size());
  CHECK(other.ego == scenario.ego);
  auto const here = scenario.make_world();
  auto world = other.make_world();
  REQUIRE(world.size() == here.size());
  for (Slot slot{}; index_of(slot) < world.size(); ++slot) {
    auto const& a = here.roster().agents[slot];
    auto const& b = world.roster().agents[slot];
    CHECK(a.id == b.id);
    CHECK(a.shape == b.shape);
    CHECK(a.road->route == b.road->route);
    CHECK(here.roster().goals[slot].index() == world.roster().goals[slot].index());
    CHECK(here.frame().agents[slot].state.speed == world.frame().agents[slot].state.speed);
    CHECK(here.frame().agents[slot].state.x == world.frame().agents[slot].state.x);
  }
  REQUIRE(world.step(0.2));
  CHECK(world.state(other.ego).speed == doctest::Approx(here.state(other.ego).speed + 0.1));
}

TEST_CASE_TEMPLATE("a map without such a place, or no map, is an error that names the file and the remedy", Site,
                   MergingSite, HighwaySite, JunctionSite) {
  auto const refused = [](std::shared_ptr<Map const> const& map, char const* words) {
    CHECK_THROWS_WITH_AS(Found<Site>::on(map, "my.xodr"), doctest::Contains(words), MapError);
  };
  refused(support::own_map(Found<Site>::unfit), "my.xodr");
  refused(support::own_map(Found<Site>::unfit), "give a map");
  refused(nullptr, "there is no map");
  refused(support::straight_road(2, 30.0), "my.xodr");
}

TEST_CASE("vehicles on the ramp have the lane behind the merge as their goal, and the ego is one of them") {
  auto const site = own_site<MergingSite>();
  auto const& ramp = site.entrances[site.ramp];
  CHECK(ramp.merges());
  CHECK(ramp.gives_up_lane);
  CHECK(std::ranges::any_of(site.entrances, [](auto const& entrance) { return !entrance.merges(); }));
  for (auto const& entrance : site.entrances)
    if (!entrance.merges()) CHECK_FALSE(entrance.gives_up_lane);
  for (std::uint32_t number = 0; number < 20; ++number) {
    auto const scenario = site.sample(5, number);
    for (auto const& agent : scenario.agents) {
      bool const merges = agent.route->lanes == ramp.route.lanes;
      CHECK(std::holds_alternative<ReachLane>(agent.goal) == merges);
      if (*agent.id == scenario.ego) CHECK(merges);
    }
  }
}

TEST_CASE("who insists at the merge is drawn apart from the traffic, and stays the same") {
  auto const site = own_site<MergingSite>();
  std::string insisting;
  for (std::uint32_t number = 0; number < 4; ++number) {
    auto const yielding = site.sample(7, number), mixed = site.sample(7, number, {.non_yielding_share = 0.5});
    REQUIRE(mixed.agents.size() == yielding.agents.size());
    for (std::size_t i = 0; i < mixed.agents.size(); ++i) {
      CHECK(mixed.agents[i].position == yielding.agents[i].position);
      bool const insists = std::get<IdmClassic>(mixed.agents[i].behavior).lateral.merging == Merging::ignored;
      insisting += insists ? '!' : '.';
    }
    insisting += ' ';
  }
  CHECK(insisting == "........!...!!!.!!.!!!. ..........!!!.!.!!...!!!! ..........!.!.!!.!.!.. ........!..!!!!.!.! ");
}

TEST_CASE("traffic at junctions has the shares that are asked for, and lights in turn") {
  auto const site = own_site<JunctionSite>();
  auto const count = [&](JunctionTraffic const& traffic, geometry::Shape const& shape) {
    std::size_t found = 0;
    for (std::uint32_t number = 0; number < 50; ++number)
      for (auto const& agent : site.sample(5, number, traffic).agents) found += agent.shape == shape;
    return found;
  };
  CHECK(count({.mix = {.bicycle_share = 0.0}}, geometry::bicycle()) == 0);
  CHECK(count({.mix = {.bicycle_share = 0.5}}, geometry::bicycle()) > 50);
  CHECK(count({.mix = {.truck_share = 0.0}}, geometry::truck()) == 0);
  CHECK(count({.mix = {.truck_share = 0.5}}, geometry::truck()) > 50);

  auto const world = site.sample(5, 1, {.lights = true}).make_world();
  REQUIRE(world.map().lights().size() == 2);
  auto const color = [&](std::size_t light, double time) { return world.roster().lights[light].at(time); };
  CHECK(color(0, 5.0) == map::LightColor::green);
  CHECK(color(1, 5.0) == map::LightColor::red);
  CHECK(color(0, 25.0) == map::LightColor::red);
  CHECK(color(1, 25.0) == map::LightColor::green);
  CHECK_THROWS_WITH_AS(site.sample(5, 1, {.mix = {.truck_share = 1.5}}), doctest::Contains("truck_share"),
                       ParameterError);
}

TEST_CASE("traffic at junctions begins in the middle of its lanes, also where a lane opens behind its entrance") {
  auto const map = support::corpus_map("multi_intersections.xodr");
  if (!map) return;
  auto const site = find_junction_site(map);
  for (std::uint32_t number = 0; number < 20; ++number) {
    auto const world = site.sample(3, number).make_world();
    for (auto const& record : world.frame().agents) CHECK(std::abs(record.lane.lateral) < 0.01);
  }
}

TEST_CASE("a scenario whose ego is missing or whose ids repeat makes no world") {
  auto const site = own_site<HighwaySite>();
  auto scenario = site.sample(1, 1);
  scenario.ego = AgentId{4711};
  CHECK_THROWS_WITH_AS(scenario.make_world(), doctest::Contains("4711"), WorldError);
  scenario.ego = none<AgentId>;
  CHECK_NOTHROW(scenario.make_world());
  scenario.agents[1].id = *scenario.agents[0].id;
  CHECK_THROWS_AS(scenario.make_world(), WorldError);
  scenario.map = nullptr;
  CHECK_THROWS_WITH_AS(scenario.make_world(), doctest::Contains("there is no map"), WorldError);
}
