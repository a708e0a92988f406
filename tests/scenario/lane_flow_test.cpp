#include <cambium/cambium.hpp>
#include <cambium/map/opendrive.hpp>
#include <cambium/scenario/recipe.hpp>
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "../support/error_of.hpp"
#include "../support/maps.hpp"

using namespace cambium;

namespace {

using Sim = World<BehaviorSet<Mobil, IdmClassic, Intersection>, InterpolateExecution, SingleTrack>;
using Flow = LaneFlow<Sim>;
using FlowDriver = DriverShare<Sim>;
using Recipe = ScenarioRecipe<Sim>;

std::vector<Scenario<Sim>> drawn(std::string const& map, std::vector<Flow> flows, std::uint32_t scenarios = 40,
                                 InflowRules const& room = Recipe{}.room) {
  return draw(Recipe{.seed = 4, .scenarios = scenarios, .flows = std::move(flows), .room = room},
              support::own_map(map));
}

std::string refusal(std::string const& map, std::vector<Flow> flows) {
  return support::error_of([&] { return drawn(map, std::move(flows), 1); });
}

LaneId highway_lane(int number) { return support::own_map("highway.xodr")->find_lane("1", 0.0, number); }

}  // namespace

TEST_CASE("the simplest flow spreads vehicles uniformly over a lane") {
  for (auto const& scenario : drawn("highway.xodr",
                                    {Flow{.from = highway_lane(-2),
                                    .traffic = {.begin = 100.0,
                                               .end = 700.0,
                                               .speed = Uniform{20.0, 21.0},
                                               .desired_speed = Uniform{25.0, 25.0},
                                               .gap = Uniform{20.0, 40.0}}}},
                                    40, {.headway = 0.3, .minimum_gap = 1.0, .deceleration = 5.0})) {
    auto const& agents = scenario.agents;
    CHECK(agents.size() >= 12);  // vehicles of at most 10 m, gaps of at most 40 m
    auto world = scenario.make_world();
    for (auto const& agent : agents) {
      auto const view = world.observe(*agent.id);
      CHECK(view.place().s - agent.shape.rear >= 100.0);
      CHECK(view.place().s + agent.shape.front <= 700.0);
      if (auto const ahead = view.ahead()) {
        CHECK(ahead->gap >= 20.0 - 1e-6);
        CHECK(ahead->gap <= 40.0 + 1e-6);
      }
      CHECK(agent.speed >= 20.0);
      CHECK(agent.speed <= 21.25);
    }
  }
}

TEST_CASE("kinds of drivers have their shares, vehicles and drawn parameters") {
  auto const scenarios =
      drawn("highway.xodr",
            {Flow{.from = highway_lane(-2),
                  .traffic = {.end = 600.0, .speed = Uniform{18.0, 22.0}, .mix = {.truck_share = 0.0}},
                  .drivers = {FlowDriver{.share = 3.0,
                                         .behavior = Mobil{},
                                         .drawn = {{"law.desired_speed", TruncatedNormal{28.0, 3.0, 24.0, 33.0}},
                                                   {"lateral.rule.politeness", Uniform{0.1, 0.2}}}},
                              FlowDriver{.share = 1.0,
                                         .vehicle = FlowDriver::Vehicle::truck,
                                         .behavior = IdmClassic{.law = {.desired_speed = 22.0}}}},
                  .controlled_share = 0.25}});
  int cars = 0, trucks = 0, controlled = 0;
  double sum = 0.0, lowest = 1e9, highest = 0.0;
  for (auto const& scenario : scenarios) {
    controlled += static_cast<int>(scenario.controlled.size());
    for (auto const& agent : scenario.agents) {
      if (auto const* const mobil = std::get_if<Mobil>(&agent.behavior)) {
        ++cars;
        CHECK(agent.shape == geometry::car());
        CHECK(mobil->lateral.rule.politeness >= 0.1);
        CHECK(mobil->lateral.rule.politeness <= 0.2);
        sum += mobil->law.desired_speed;
        lowest = std::min(lowest, mobil->law.desired_speed);
        highest = std::max(highest, mobil->law.desired_speed);
      } else {
        ++trucks;
        CHECK(agent.shape == geometry::truck());
        CHECK(std::get<IdmClassic>(agent.behavior).law.desired_speed == 22.0);
      }
    }
  }
  CHECK(static_cast<double>(cars) / (cars + trucks) == doctest::Approx(0.75).epsilon(0.08));
  CHECK(static_cast<double>(controlled) / (cars + trucks) == doctest::Approx(0.25).epsilon(0.25));
  CHECK(sum / cars == doctest::Approx(28.2).epsilon(0.02));
  CHECK(lowest >= 24.0);
  CHECK(lowest < 24.5);
  CHECK(highest <= 33.0);
  CHECK(highest > 32.5);
}

TEST_CASE("bicycles ride as cyclists do") {
  int bicycles = 0;
  for (auto const& scenario :
       drawn("highway.xodr", {Flow{.from = highway_lane(-3), .traffic = {.mix = {.bicycle_share = 0.5}}}}))
    for (auto const& agent : scenario.agents)
      if (agent.shape == geometry::bicycle()) {
        ++bicycles;
        CHECK(agent.speed <= presets::cyclist().desired_speed);
        CHECK(equal_parameters(agent.dynamics, presets::bicycle_dynamics()));
      }
  CHECK(bicycles > 40);
}

TEST_CASE("flows lead from sources to sinks, named by lane or by point; nobody overlaps or must collide at once") {
  auto const map = support::own_map("intersection_4way.xodr");
  std::vector<Flow> by_lane, by_point;
  for (auto const& source : find_sources(*map)) {
    RandomStream random(2, static_cast<std::uint32_t>(index_of(source.lane)), 0);
    auto const route = random_route(*map, source.lane, random);
    Flow flow{.traffic = {.end = 1000.0, .speed = Uniform{3.0, 12.0}},
              .drivers = {FlowDriver{.behavior = Intersection{.law = {.time_headway = 1.2}}}},
              .ego = by_lane.empty() ? Flow::Ego::random : Flow::Ego::none};
    flow.from = route.lanes.front();
    flow.to = route.lanes.back();
    by_lane.push_back(flow);
    flow.from = flow.to = none<LaneId>;
    flow.from_point = map->lane(route.lanes.front()).path.pose(20.0).position();
    flow.to_point = map->lane(route.lanes.back()).path.pose(20.0).position();
    by_point.push_back(flow);
  }
  REQUIRE(by_lane.size() >= 4);
  auto const scenarios = drawn("intersection_4way.xodr", by_lane, 60),
             twins = drawn("intersection_4way.xodr", by_point, 60);
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    CHECK(equal_parameters(scenarios[i], twins[i]));
    CHECK(is_valid(scenarios[i].ego));
    auto world = scenarios[i].make_world();
    CHECK(world.size() > by_lane.size());
    for (auto const& agent : scenarios[i].agents)
      CHECK(std::any_of(by_lane.begin(), by_lane.end(), [&](Flow const& flow) {
        return agent.route->lanes.front() == flow.from && agent.route->lanes.back() == flow.to;
      }));
    CHECK_FALSE(AnyCollision{}(world));
    for (int step = 0; step < 50; ++step) {
      REQUIRE(world.step(0.2));
      CHECK_FALSE(AnyCollision{}(world));
      for (Slot slot{}; step < 15 && index_of(slot) < world.size(); ++slot) CHECK(Acceleration{}(world, slot) > -4.0);
    }
  }
}

TEST_CASE("a flow to the lane beside begins in its own lane") {
  for (auto const& scenario : drawn("highway.xodr", {Flow{.from = highway_lane(-3), .to = highway_lane(-2)}}, 5)) {
    auto world = scenario.make_world();
    for (auto const& agent : scenario.agents) {
      auto const view = world.observe(*agent.id);
      CHECK(view.corridor().lane_at(view.place().s).lane == highway_lane(-3));
      CHECK(agent.route->lanes.back() == highway_lane(-2));
    }
  }
}

TEST_CASE("the ego is who the rule says, alone with a goal where that is asked for") {
  auto const from = highway_lane(-3);
  Goal const goal = ReachLane{highway_lane(-2), 700.0};
  for (auto const rule : {Flow::Ego::first, Flow::Ego::middle, Flow::Ego::last, Flow::Ego::random})
    for (auto const& scenario : drawn("highway.xodr", {Flow{.from = from,
                                                      .traffic = {.end = 400.0},
                                                      .goal = goal,
                                                      .goal_of = Flow::GoalOf::ego,
                                                      .ego = rule,
                                                      .controlled_share = 1.0}})) {
      auto const& agents = scenario.agents;
      CHECK(scenario.controlled.size() + 1 == agents.size());
      CHECK(std::count(scenario.controlled.begin(), scenario.controlled.end(), scenario.ego) == 0);
      for (std::size_t i = 0; i < agents.size(); ++i) {
        bool const is_ego = agents[i].id.given() == scenario.ego;
        CHECK(std::holds_alternative<ReachLane>(agents[i].goal.given()) == is_ego);
        if (rule == Flow::Ego::first) CHECK(is_ego == (i == 0));
        if (rule == Flow::Ego::last) CHECK(is_ego == (i + 1 == agents.size()));
        if (rule == Flow::Ego::middle) CHECK(is_ego == (i == agents.size() / 2));
      }
    }
}

TEST_CASE("what a flow cannot do is an error that says where and what to do") {
  auto const from = highway_lane(-2);
  CHECK(refusal("highway.xodr", {Flow{.from = from}}) == "no error");
  CHECK(refusal("highway.xodr", {Flow{.from = highway_lane(-4)}}) ==
        "recipe.flows[0].from: there is no such lane for vehicles; examples/run map FILE lists the lanes");
  CHECK(refusal("highway.xodr", {Flow{.from = LaneId{77}}}).find("there is no such lane") != std::string::npos);
  CHECK(refusal("highway.xodr", {Flow{.from = from, .drivers = {FlowDriver{.share = 0.0, .behavior = Mobil{}}}}}) ==
        "recipe.flows[0]: has only drivers whose share is 0; give one of them a share");
  auto const exit = support::own_map("highway_exit.xodr");
  CHECK(refusal("highway_exit.xodr",
                {Flow{.from = exit->find_lane("2", 200.0, -1), .to = exit->find_lane("1", 10.0, -1)}}) ==
        "recipe.flows[0]: no way leads from its source to its sink; examples/run map FILE --reachable lists where one "
        "gets");
  CHECK(refusal("highway.xodr", {Flow{.from_point = geometry::Point{0.0, 900.0}}}) ==
        "recipe.flows[0].from_point: no drivable lane is within 5 m of it; look at examples/run map FILE --picture");
  CHECK(refusal("highway.xodr", {Flow{.from = from, .from_point = geometry::Point{0.0, 0.0}}}) ==
        "recipe.flows[0]: has both from and from_point; leave out one of them");
  CHECK(refusal("highway.xodr",
                {Flow{.from = from, .ego = Flow::Ego::first}, Flow{.from = from, .ego = Flow::Ego::last}}) ==
        "recipe.flows[1]: is the second flow with an ego; let one flow have it");
  auto const with = [&](DrawnParameter const& parameter) {
    return std::vector<Flow>{Flow{.from = from, .drivers = {FlowDriver{.behavior = Mobil{}, .drawn = {parameter}}}}};
  };
  CHECK(refusal("highway.xodr", with({"law.desird_speed", Uniform{20.0, 30.0}})) ==
        "recipe.flows[0].drivers[0].drawn[0]: law.desird_speed: there is no number of that key; is it desired_speed?");
  auto second = with({"law.desired_speed", Uniform{20.0, 30.0}});
  second[0].drivers[0].drawn.push_back({"politness", Uniform{0.0, 1.0}});
  CHECK(refusal("highway.xodr", second).find("recipe.flows[0].drivers[0].drawn[1]: politness: there is no number") ==
        0);
  CHECK(refusal("highway.xodr", with({"law.time_headway", TruncatedNormal{1.0, 0.5}}))
            .find("law.time_headway: is -inf") != std::string::npos);
}

TEST_CASE("populations drive the same vehicles from the same places, each in its way") {
  using People = World<BehaviorSet<Mobil, HumanDriver<Mobil>>, InterpolateExecution, SingleTrack>;
  using P = TrafficPopulation;
  auto const map = support::own_map("highway.xodr");
  auto const recipe_of = [&](std::vector<P> const& populations) {
    ScenarioRecipe<People> recipe{.seed = 4, .scenarios = 10, .populations = populations};
    LaneFlow<People> flow{.from = map->find_lane("1", 0.0, -2),
                          .traffic = {.end = 700.0, .speed = Uniform{18.0, 22.0}},
                          .drivers = {{.behavior = Mobil{.law = {.desired_speed = 25.0}}, .people = true}}};
    recipe.flows = {flow};
    flow.from = map->find_lane("1", 0.0, -3);
    flow.drivers = {{.behavior = Mobil{.law = {.desired_speed = 30.0}}}};  // no people
    flow.ego = LaneFlow<People>::Ego::first;
    recipe.flows.push_back(flow);
    return recipe;
  };
  std::vector<P> const all{P::as_given, P::timid, P::aggressive, P::inattentive, P::mixed};
  auto const scenarios = draw(recipe_of(all), map);
  REQUIRE(scenarios.size() == 50);
  CHECK(to_string(draw(recipe_of({P::timid}), map)[3].agents.front()) == to_string(scenarios[13].agents.front()));

  double headway[5] = {}, speed[5] = {};
  std::size_t people[5] = {}, human[5] = {};
  for (std::size_t p = 0; p < 5; ++p)
    for (std::size_t i = 0; i < 10; ++i) {
      auto const &scenario = scenarios[10 * p + i], &given = scenarios[i];
      CHECK(scenario.population == to_string(all[p]));
      CHECK(scenario.seed == given.seed);
      REQUIRE(scenario.agents.size() == given.agents.size());
      for (std::size_t a = 0; a < given.agents.size(); ++a) {
        auto const &one = scenario.agents[a], &twin = given.agents[a];
        CHECK(one.position == twin.position);
        CHECK(one.speed == twin.speed);
        CHECK(one.shape == twin.shape);
        auto const* const wrapped = std::get_if<HumanDriver<Mobil>>(&one.behavior.given());
        auto const& driver = wrapped != nullptr ? wrapped->nominal : std::get<Mobil>(one.behavior.given());
        if (driver.law.desired_speed == 30.0) continue;
        ++people[p];
        human[p] += wrapped != nullptr;
        headway[p] += driver.law.time_headway;
        speed[p] += driver.law.desired_speed;
      }
    }
  for (std::size_t p = 0; p < 5; ++p) {
    REQUIRE(people[p] > 50);
    headway[p] /= static_cast<double>(people[p]);
    speed[p] /= static_cast<double>(people[p]);
  }
  CHECK(speed[0] == 25.0);
  CHECK(headway[1] == doctest::Approx(presets::timid().time_headway).epsilon(0.05));
  CHECK(headway[2] == doctest::Approx(presets::aggressive().time_headway).epsilon(0.05));
  CHECK(speed[1] < 25.0);
  CHECK(speed[2] > 26.0);
  CHECK(human[1] + human[2] == 0);
  CHECK(human[3] == people[3]);
  CHECK(human[4] > people[4] / 8);
  CHECK(human[4] < people[4] / 2);

  ScenarioRecipe<Sim> lacking{.scenarios = 1, .populations = {P::inattentive}};
  lacking.flows = {Flow{.from = highway_lane(-2), .drivers = {{.behavior = Mobil{}, .people = true}}}};
  auto const refused = support::error_of([&] { return draw(lacking, map); });
  CHECK(refused ==
        "recipe.flows[0]: needs HumanDriver of mobil, which the program lacks; add it to the BehaviorSet of the "
        "program's World, or leave out inattentive and mixed");
}

TEST_CASE("populations without effect are refused") {
  using P = TrafficPopulation;
  using Open = World<BehaviorSet<Mobil, ConstantAcceleration>, InterpolateExecution, SingleTrack>;
  using OpenRecipe = ScenarioRecipe<Open>;
  auto const map = support::own_map("highway.xodr");
  auto const refusal_of = [&](OpenRecipe recipe, auto const&... drivers) {
    recipe.scenarios = 1;
    recipe.flows = {LaneFlow<Open>{.from = highway_lane(-2), .traffic = {.end = 400.0}, .drivers = {drivers...}}};
    return support::error_of([&] { return draw(recipe, map); });
  };
  DriverShare<Open> const usual{.behavior = Mobil{}}, person{.behavior = Mobil{}, .people = true},
      nobody{.share = 0.0, .behavior = Mobil{}, .people = true},
      machine{.behavior = ConstantAcceleration{}, .people = true};
  CHECK(refusal_of({.populations = {P::timid, P::as_given}}, usual, person) == "no error");
  CHECK(refusal_of({.populations = {}}, person) == "recipe: has no populations; leave them out, or name some");
  CHECK(refusal_of({.populations = {P::timid, P::as_given, P::timid}}, person) ==
        "recipe.populations: has timid twice; name each once");
  std::string const no_people =
      R"(recipe: has populations, but none of its drivers are people; leave them out, or give drivers "people": true)";
  CHECK(refusal_of({.populations = {P::as_given, P::mixed}}, usual) == no_people);
  CHECK(refusal_of({.populations = {P::mixed}}, usual, nobody) == no_people);
  CHECK(refusal_of({}, usual, machine) ==
        "recipe.flows[0].drivers[1].people: is true, but the behaviour is no Driver, as mobil is one; leave it out, or "
        "take another behaviour");
  for (auto const kind : {OpenRecipe::Kind::merging, OpenRecipe::Kind::highway, OpenRecipe::Kind::junction})
    CHECK(refusal_of({.kind = kind, .populations = {P::as_given, P::timid}}, person) ==
          "recipe: has populations, but no flows; leave them out, or make it of kind lanes");

  auto const population_among = [&](DriverShare<Open> const& driver) {
    OpenRecipe recipe{.scenarios = 1};
    recipe.flows = {LaneFlow<Open>{.from = highway_lane(-2), .traffic = {.end = 400.0}, .drivers = {driver}}};
    return draw(recipe, map).front().population;
  };
  CHECK(population_among(person) == "as_given");
  CHECK(population_among(usual) == "");  // nobody is of it
}
