#include <cambium/cambium.hpp>
#include <cambium/core/read_file.hpp>
#include <cambium/core/write_file.hpp>
#include <cambium/map/opendrive.hpp>
#include <cambium/map/road/curve_layout.hpp>
#include <cambium/scenario/highway_site.hpp>
#include <cambium/scenario/junction_site.hpp>
#include <cambium/scenario/merging_site.hpp>
#include <cambium/scenario/scenario_file.hpp>
#include <doctest/doctest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "../support/error_of.hpp"
#include "../support/maps.hpp"
#include "figure.hpp"

using namespace cambium;

namespace {

std::string const maps = CAMBIUM_SOURCE_DIR "/maps/";

template <class Site>
ScenarioSet<typename Site::World> sampled(Site const& site, std::string const& map_file, std::uint32_t count) {
  ScenarioSet<typename Site::World> set{.title = map_file};
  for (std::uint32_t i = 0; i < count; ++i) {
    auto scenario = site.sample(3, i);
    scenario.map_file = map_file;
    set.scenarios.push_back(std::move(scenario));
  }
  return set;
}

/// The frames of a scenario after some steps, as bits.
template <class World>
std::vector<double> run(Scenario<World> const& scenario) {
  auto world = scenario.make_world();
  std::vector<double> numbers;
  for (int step = 0; step < 60; ++step) {
    REQUIRE(world.step(0.2));
    for (auto const& record : world.frame().agents)
      numbers.insert(numbers.end(), {record.state.x, record.state.y, record.state.heading, record.state.speed});
  }
  return numbers;
}

template <class World>
void check_round_trip(ScenarioSet<World> const& set) {
  auto const text = to_json_text(set);
  auto const read = parse_scenarios<World>(text, maps);
  CHECK(read.hash() == set.hash());
  CHECK(to_json_text(read) == text);
  REQUIRE(read.scenarios.size() == set.scenarios.size());
  for (std::size_t i = 0; i < set.scenarios.size(); ++i) CHECK(run(read.scenarios[i]) == run(set.scenarios[i]));
  auto const bytes = to_bytes(set);
  auto const unpacked = parse_scenarios<World>(bytes, maps);
  CHECK(unpacked.hash() == set.hash());
  CHECK(to_bytes(unpacked) == bytes);
  CHECK(bytes.size() < text.size());
}

using Small = World<BehaviorSet<IdmClassic, Mobil>, InterpolateExecution, SingleTrack>;

std::string refusal(std::string const& text) {
  return support::error_of([&] { return parse_scenarios<Small>(text, maps, "f.json"); });
}

/// A file with one scenario on merging.xodr; `more` are further members of the scenario.
std::string with_agents(std::string const& agents, std::string const& more = "") {
  return R"({"format": 1, "scenarios": [{"map_file": "merging.xodr", "agents": [)" + agents + "]" + more + "}]}";
}

}  // namespace

TEST_CASE("a scenario set that was written and read runs the same, bit for bit") {
  check_round_trip(sampled(find_merging_site(load_opendrive(maps + "merging.xodr").map), "merging.xodr", 5));
  check_round_trip(sampled(find_highway_site(load_opendrive(maps + "highway_exit.xodr").map), "highway_exit.xodr", 5));
  auto const site = find_junction_site(load_opendrive(maps + "intersection_4way.xodr").map);
  auto set = sampled(site, "intersection_4way.xodr", 4);
  set.scenarios[1] = site.sample(5, 2, {.lights = true});
  set.scenarios[1].map_file = "intersection_4way.xodr";
  check_round_trip(set);
}

TEST_CASE("a file holds goals of all kinds, objects and controlled agents") {
  auto const map = load_opendrive(maps + "merging.xodr").map;
  auto const lane = map->find_lane("3", 400.0, -2);
  Goal const goals[] = {ReachPolygon{geometry::Polygon({{0, 0}, {4, 0}, {4, 2}})},
                        ReachLane{lane, 3.0},
                        StateLimits{.lowest_speed = 3.0},
                        LaneLimits{.lane = lane, .left = 0.3},
                        ReachLaneEnd{12.0},
                        ReachLaneBeside{ReachLaneBeside::Side::right},
                        AllGoals{{ReachLane{lane}, StateLimits{.highest_speed = 9.0}}},
                        AnyGoal{{AllGoals{{ReachLane{lane}}}}},
                        GoalSequence{{ReachLane{lane}, ReachLaneEnd{}}}};
  ScenarioSet<Small> set;
  for (auto const& goal : goals) {
    Scenario<Small> scenario{.map = map, .seed = 9, .map_file = "merging.xodr"};
    scenario.agents.push_back(
        {.position = {20, -5.25}, .speed = 12.0, .behavior = Mobil{}, .goal = goal, .id = AgentId{7}});
    scenario.objects = {geometry::Polygon({{300, 0}, {304, 0}, {304, 2}})};
    scenario.controlled = {AgentId{7}};
    set.scenarios.push_back(scenario);
  }
  auto const read = parse_scenarios<Small>(to_json_text(set), maps);
  CHECK(read.hash() == set.hash());
  for (std::size_t i = 0; i < set.scenarios.size(); ++i) {
    auto const &a = read.scenarios[i].agents[0].goal.given(), &b = set.scenarios[i].agents[0].goal.given();
    CHECK(equal_parameters(read.scenarios[i], set.scenarios[i]));
    CHECK(a.index() == b.index());
  }
  auto other = set;
  other.scenarios[0].agents[0].goal = ReachPolygon{geometry::Polygon({{0, 0}, {4, 0}, {4, 3}})};
  CHECK(other.hash() != set.hash());
}

TEST_CASE("a recorded trajectory travels with its file") {
  using Replay = World<BehaviorSet<StaticTrajectory>, InterpolateExecution, SingleTrack>;
  ScenarioSet<Replay> set;
  Scenario<Replay> scenario{.map = load_opendrive(maps + "merging.xodr").map, .map_file = "merging.xodr"};
  scenario.agents.push_back(
      {.position = {20, -5.25},
       .behavior = StaticTrajectory({{0.0, 20.0, -5.25, 0.0, 10.0}, {50.0, 520.0, -5.25, 0.0, 10.0}}),
       .id = AgentId{1}});
  scenario.agents.push_back(
      {.position = {20, -5.25},
       .behavior = StaticTrajectory({{10.0, 20.0, -5.25, 0.0, 10.0}, {50.0, 420.0, -5.25, 0.0, 10.0}}),
       .id = AgentId{2}});  // comes when the first is far away
  set.scenarios.push_back(scenario);
  check_round_trip(set);
}

TEST_CASE("an error in a scenario file says where it is and what to do") {
  std::string const good = R"({"id": 0, "position": {"x": 20, "y": -5.25}, "heading": 0, "speed": 12})";
  CHECK(refusal(with_agents(good)) == "no error");
  CHECK(
      refusal(with_agents(R"({"position": {"x": 20, "y": -5.25}, "behavior": "imd"})")) ==
      "f.json: scenario_set.scenarios[0].agents[0].behavior: there is no \"imd\" here; give one of idm_classic, mobil");
  CHECK(refusal(with_agents(R"({"position": {"x": 20, "y": -5.25}, "behavior": {"mobil": {"politness": 1}}})")) ==
        "f.json: scenario_set.scenarios[0].agents[0].behavior.mobil: has no field \"politness\"; is it "
        "lateral.rule.politeness?");
  CHECK(refusal(with_agents(good + "," + good)).find("f.json: scenarios[0]: agent 0: ") == 0);
  CHECK(refusal(with_agents(good + R"(,{"id": 1, "position": {"x": 22, "y": -5.25}})")) ==
        "f.json: scenarios[0]: agents 0 and 1 overlap at the start; move one of them");
  CHECK(refusal(with_agents(good, R"(, "objects": [[{"x": 22, "y": -6}, {"x": 23, "y": -6}, {"x": 23, "y": -5}]])")) ==
        "f.json: scenarios[0]: agent 0 overlaps a static object; move one of them");
  CHECK(refusal(R"({"scenarios": [{"agents": []}]})").find("f.json: scenarios[0]: it names no map") == 0);
  CHECK(refusal(R"({"scenarios": [{"map_file": "nowhere.xodr"}]})").find("f.json: scenarios[0]: ") == 0);
  CHECK(refusal(R"({"format": 2})") == "f.json: scenario_set.format: is 2; give a value in [0, 1]");
  CHECK(refusal(with_agents(R"({"speed": 3})")).find("position.x: is nan") != std::string::npos);
  auto const goal = [](std::string const& lane) {
    return with_agents(R"({"position": {"x": 20, "y": -5.25}, "goal": {"reach_lane": {"lane": )" + lane + "}}}");
  };
  CHECK(refusal(goal("\"3/0/-2\"")) == "no error");
  CHECK(refusal(goal("\"3/0/-9\"")) ==
        "f.json: scenarios[0]: lane \"3/0/-9\": is not in its map; examples/run map FILE lists the lanes");
  CHECK(refusal(goal("\"here\"")).find("write road/section/lane") != std::string::npos);
  CHECK(refusal(goal("7")).find("give a lane's name, in quotes") != std::string::npos);
  CHECK(refusal(with_agents(good, R"(, "ego": 0)")) == "no error");
  for (auto const& text : {with_agents(good, R"(, "ego": 7)"),
                           with_agents(R"({"id": 0, "position": {"x": 20, "y": 500}, "heading": 0, "speed": 9})"),
                           with_agents(good + R"(, {"id": 0, "position": {"x": 60, "y": -5.25}, "speed": 9})")})
    CHECK(refusal(text).find("f.json: scenarios[0]: ") == 0);
  CHECK(refusal(with_agents(R"({"id": -1, "position": {"x": 20, "y": -5.25}})"))
            .find("give an integer without fraction or exponent, from 0 to 429496729") != std::string::npos);
}

TEST_CASE("the hash of a set changes with what is in its maps") {
  auto text = read_file<Error>(maps + "merging.xodr", {});
  auto const hash_on = [&](std::string const& map_text) {
    ScenarioSet<Small> set;
    set.scenarios.push_back({.map = parse_opendrive(map_text).map, .map_file = "merging.xodr"});
    return set.hash();
  };
  auto const hash = hash_on(text);
  CHECK(hash_on(text + "<!-- a comment -->") == hash);
  auto const width = text.find("<width");
  REQUIRE(width != std::string::npos);
  auto const a = text.find(" a=\"", width) + 4;
  CHECK(hash_on(text.substr(0, a) + "2.9" + text.substr(text.find('"', a))) != hash);
}

TEST_CASE("bytes name their models, so other worlds that have these read them") {
  auto const merging = sampled(find_merging_site(load_opendrive(maps + "merging.xodr").map), "merging.xodr", 2);
  auto const read = parse_scenarios<Small>(to_bytes(merging), maps);
  CHECK(run(read.scenarios[1]) == run(merging.scenarios[1]));
  auto const site = find_junction_site(load_opendrive(maps + "intersection_4way.xodr").map);
  CHECK(
      refusal(to_bytes(sampled(site, "intersection_4way.xodr", 1))) ==
      "f.json: holds the model 'urban_driver', which is not among those of this program (idm_classic, mobil); read it "
      "with the type that was saved");
}

TEST_CASE("a set that is written to a file is read from it again, as text or as bytes") {
  auto const map = load_opendrive(maps + "merging.xodr").map;
  auto set = sampled(find_merging_site(map), maps + "merging.xodr", 2);
  for (auto const& written : {to_json_text(set), to_bytes(set)}) {
    auto const file = std::filesystem::path(CAMBIUM_BUILD_DIR) / "set";
    write_file(file, written);
    CHECK(read_scenarios<MergingSite::World>(file).hash() == set.hash());
  }
}

TEST_CASE("a recipe draws what its sampler draws") {
  using Site = MergingSite::World;
  auto const set = parse_scenarios<Site>(
      R"({"recipes": [{"title": "m", "map_file": "merging.xodr", "kind": "merging", "seed": 3, "first": 2, "scenarios": 3}]})",
      maps);
  auto const site = find_merging_site(load_opendrive(maps + "merging.xodr").map);
  REQUIRE(set.scenarios.size() == 3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    auto drawn = site.sample(3, 2 + i);
    drawn.map_file = "merging.xodr";
    drawn.title = "m";
    for (std::uint32_t other = 0; other < i; ++other) CHECK(set.scenarios[i].seed != set.scenarios[other].seed);
    drawn.seed = set.scenarios[i].seed;  // of the world: each its own
    CHECK(equal_parameters(set.scenarios[i], drawn));
  }
  CHECK(
      refusal(R"({"recipes": [{"map_file": "intersection_4way.xodr", "kind": "junction"}]})") ==
      "f.json: recipes[0]: needs the behaviour urban_driver, which the program lacks; add it to the BehaviorSet of the "
      "program's World");
}

TEST_CASE("the example in the README is a scenario file") {
  auto const readme = read_file<Error>(CAMBIUM_SOURCE_DIR "/include/cambium/scenario/README.md", {});
  auto const begin = readme.find("```json\n") + 8;
  auto const set = parse_scenarios<Small>(readme.substr(begin, readme.find("```", begin) - begin), maps, "README");
  CHECK(set.scenarios.size() == 1051);
  CHECK(set.title == "a merge");
  double figure = 0.0;
  for (auto const& scenario : set.scenarios) figure += figure_of(scenario);
  CHECK(figure == doctest::Approx(258766563.572).epsilon(1e-8));  // on every platform
}

TEST_CASE("flows of a file draw dense traffic by lane, the same each time") {
  std::string const text = R"({"recipes": [{"map_file": "highway.xodr", "scenarios": 30, "seed": 8, "flows": [
    {"from": "1/0/-1", "traffic": {"begin": 0, "end": 300, "mix": {"truck_share": 0}}, "ego": "middle",
     "drivers": [{"share": 3, "behavior": {"mobil": {"law": {"desired_speed": 25}}}}, {"share": 1, "behavior": "idm_classic"}]},
    {"from": "1/0/-2", "traffic": {"begin": 0, "end": 300, "mix": {"truck_share": 0.5}}, "controlled_share": 1}]}]})";
  auto const set = parse_scenarios<Small>(text, maps);
  CHECK(parse_scenarios<Small>(text, maps).hash() == set.hash());
  REQUIRE(set.scenarios.size() == 30);
  for (auto const& scenario : set.scenarios) {
    CHECK(is_valid(scenario.ego));
    CHECK(scenario.controlled.size() > 2);
    CHECK(scenario.agents.size() > 8);
  }
  CHECK(refusal(R"({"recipes": [{"map_file": "highway.xodr", "flows": [{}]}]})") ==
        "f.json: recipes[0].flows[0]: names no source; give \"from\": \"road/section/lane\", or "
        "\"from_point\"");
  CHECK(refusal(R"({"recipes": [{"map_file": "highway.xodr", "flows": [{"from": "1/0/-1",
    "traffic": {"desired_speed": {"uniform": {"low": 9, "high": 12}}}, "drivers": [{"behavior": "idm_classic"}]}]}]})")
            .find("f.json: recipes[0].flows[0].traffic.desired_speed: is not for flows with drivers; ") == 0);
  CHECK(refusal(R"({"recipes": [{"map_file": "highway.xodr"}]})") ==
        "f.json: recipes[0]: draws no vehicle, or none for the ego; give longer or denser flows, or slower ones");
}

TEST_CASE("a set has the same hash in every program that can read it, and says what makes a run no success") {
  using Large = World<BehaviorSet<Pedestrian, Mobil, UrbanDriver, IdmClassic>, InterpolateExecution, SingleTrack,
                      ObserverSet<PerfectObserver, OccludedObserver>>;
  std::string const recipes = R"("recipes": [{"map_file": "highway.xodr", "scenarios": 3, "flows": [
    {"from": "1/0/-1", "traffic": {"end": 300}, "ego": "middle",
     "drivers": [{"share": 3, "behavior": {"mobil": {"law": {"desired_speed": 25}}}}, {"share": 1, "behavior": "idm_classic"}]}]}]})";
  auto const hash = parse_scenarios<Small>("{" + recipes, maps).hash();
  CHECK(parse_scenarios<Large>("{" + recipes, maps).hash() == hash);
  CHECK(parse_scenarios<Small>(R"({"time_step": 0.1, )" + recipes, maps).hash() != hash);

  auto const chosen = parse_scenarios<Small>(R"({"fails": ["off_road", "red_light"], )" + recipes, maps);
  CHECK(chosen.fails == std::vector{Criterion::off_road, Criterion::red_light});
  CHECK(chosen.hash() != hash);
  CHECK(parse_scenarios<Small>(R"({"fails": [], )" + recipes, maps).fails.empty());
  CHECK(parse_scenarios<Small>(to_json_text(chosen), maps).fails == chosen.fails);
  CHECK(refusal(R"({"fails": ["read_light"], )" + recipes) ==
        "f.json: scenario_set.fails[0]: is \"read_light\"; is it red_light?");
  auto const bounded =
      parse_scenarios<Small>(R"({"bounds": {"straddling": 3, "infeasible": {"grip": 6}}, )" + recipes, maps);
  CHECK(bounded.bounds.straddling == 3.0);
  CHECK(bounded.bounds.infeasible.grip == 6.0);
  CHECK(bounded.bounds.wrong_way == 1.0);
  CHECK(bounded.hash() != hash);
  CHECK(refusal(R"({"bounds": {"straddling": -1}, )" + recipes).find("f.json: scenario_set.bounds.straddling: ") == 0);
}

TEST_CASE("a recipe of flows has lights, objects and pedestrians, and what it draws is written and read again") {
  using Walked = World<BehaviorSet<IdmClassic, Pedestrian>, InterpolateExecution, SingleTrack>;
  auto const with = [](std::string const& flows, std::string const& rest) {
    return R"({"recipes": [{"map_file": "intersection_4way.xodr", "scenarios": 5, "flows": [)" + flows + "]" + rest +
           "}]}";
  };
  std::string const cars = R"({"from": "3/0/-2", "traffic": {"end": 95}, "ego": "last"})",
                    walkers = R"({"way": [{"x": -40, "y": -14}, {"x": -40, "y": 10}], "traffic": {"end": 6, "speed":
      {"uniform": {"low": 1, "high": 1}}, "gap": {"uniform": {"low": 1, "high": 3}}},
      "drivers": [{"vehicle": "pedestrian", "behavior": "pedestrian"}]})",
                    van = R"([{"x": -75, "y": -6}, {"x": -70, "y": -6}, {"x": -70, "y": -5}])",
                    site = R"(, "lights": [{"cycle": 60, "green_end": 20}], "objects": [)" + van +
                           R"(], "room": {"headway": 0.5, "minimum_gap": 0.5})";
  auto const set = parse_scenarios<Walked>(with(cars + "," + walkers, site), maps);
  std::size_t on_foot = 0;
  for (auto const& scenario : set.scenarios) {
    REQUIRE(scenario.lights.size() == 1);
    CHECK(scenario.lights[0].green_end == 20.0);
    REQUIRE(scenario.objects.size() == 1);
    auto const world = scenario.make_world();
    for (auto const& agent : scenario.agents) {
      CHECK(!Collision{}(world, world.slot_of(*agent.id)));
      if (agent.way.empty()) continue;
      ++on_foot;
      CHECK(agent.shape == geometry::pedestrian());
      CHECK(agent.position.x() == doctest::Approx(-40.0));
      CHECK(agent.position.y() < -8.0);
    }
  }
  CHECK(on_foot > set.scenarios.size());
  check_round_trip(set);
  auto moved = set;
  moved.scenarios[0].agents.back().way[1].x() += 1.0;
  CHECK(moved.hash() != set.hash());

  auto const says = [&](std::string const& flows, std::string const& rest, std::string const& words) {
    auto const text = support::error_of([&] { return parse_scenarios<Walked>(with(flows, rest), maps, "f.json"); });
    CAPTURE(text);
    CHECK(text.find("f.json: recipes[0]") == 0);
    CHECK(text.find(words) != std::string::npos);
  };
  says(R"({"way": [{"x": 0, "y": 0}], "drivers": [{}]})", "", "flows[0].way");
  says(R"({"way": [{"x": 0, "y": 0}, {"x": 0, "y": 9}]})", "", "has a way, but no drivers");
  says(R"({"way": [{"x": 0, "y": 0}, {"x": 0, "y": 9}], "from": "3/0/-1", "drivers": [{}]})", "",
       "has a way beside from or to");
  says(cars, R"(, "lights": [{}, {}, {}])", "light");
  says(cars, R"(, "lights": [{}], "kind": "highway")", "has lights or objects, but no flows");
}

TEST_CASE("a road's name may hold a slash") {
  auto const road = support::map_of(
      {.id = "a/b", .line = map::lay_from({}, {{100.0}}), .sections = {{.right = map::equal_lanes(1)}}});
  detail::LaneTable const table;
  auto const number = table.lane("a/b/0/-1");
  CHECK(table.lane_in(*road, number, "f.json") == LaneId{0});
  CHECK(table.number_of(*road, LaneId{0}) == number);
}
