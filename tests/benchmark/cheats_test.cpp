// Drivers that game a judge: each gets its failure, and its row says why.
#include <cambium/benchmark/contender.hpp>
#include <cambium/cambium.hpp>
#include <cambium/evaluation/rules.hpp>
#include <cambium/map/building/map_builder.hpp>
#include <cambium/map/opendrive.hpp>
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "../support/maps.hpp"
#include "../support/who_yields.hpp"
#include "cheats/cheat.hpp"

using namespace cambium;
using cheats::Cheat;
using Kind = Cheat::Kind;

namespace {

using Traffic = World<BehaviorSet<IdmClassic, ConstantAcceleration, Cheat>, InterpolateExecution, SingleTrack>;

/// Another vehicle of a scenario.
struct Other {
  double x, y, speed;
  Traffic::Behavior behavior = ConstantAcceleration{};
};

/// The ego drives at `speed` from x = 30 to 400 m of a straight road.
Scenario<Traffic> scene(double speed, std::vector<Other> const& others, std::shared_ptr<Map const> const& map) {
  Scenario<Traffic> scenario{.map = map, .ego = AgentId{0}};
  auto const lane = map->lanes().front().id;
  scenario.agents.push_back({.position = {30, -1.75},
                             .speed = speed,
                             .behavior = IdmClassic{},
                             .goal = ReachLane{lane, 400.0, 490.0},
                             .id = AgentId{0}});
  for (auto const& other : others)
    scenario.agents.push_back({.position = {other.x, other.y},
                               .speed = other.speed,
                               .behavior = other.behavior,
                               .id = static_cast<AgentId>(scenario.agents.size())});
  return scenario;
}
Scenario<Traffic> scene(double speed, std::vector<Other> const& others = {}) {
  return scene(speed, others, support::straight_road(2, 500));
}

RunResult judged(Kind kind, Scenario<Traffic> const& scenario, RunOptions const& options = {}) {
  return contender<Traffic>(Cheat{kind}).run(scenario, options, false).result;
}

bool says(RunResult const& result, std::string const& what) {
  INFO(result.violations);
  return result.violations.find(what) != std::string::npos;
}

double const length = geometry::car().length();

}  // namespace

TEST_CASE("an honest driver succeeds, alone, behind a slower one and where that one stops") {
  for (auto const& scenario : {scene(20), scene(20, {{80, -1.75, 12}}),
                               scene(20, {{100, -1.75, 15, IdmClassic{.law = {.desired_speed = 5}}}})}) {
    auto const result = judged(Kind::honest, scenario, {.time_limit = 90});
    CHECK(result.success);
    CHECK(result.violations == "");
    CHECK(result.failed_by == "");
    CHECK(result.infeasible_steps == 0);
    CHECK(std::isnan(result.impact_speed));
  }
}

TEST_CASE("what plans claim changes nothing, whoever claims it") {
  for (auto const kind : {Kind::honest, Kind::two_faced})
    for (auto const& scenario : {scene(20, {{80, -1.75, 12, Cheat{kind}}, {10, -1.75, 18, IdmClassic{}}}),
                                 scene(5, {{60, -1.75, 15, IdmClassic{.law = {.desired_speed = 5}}}}),
                                 scene(20, {{10, -1.75, 22, Cheat{kind}}, {90, -5.25, 12, Cheat{kind}}})})
      for (double const step : {0.1, 0.2}) {
        RunOptions const options{.time_step = step};
        CHECK(to_string(judged(Kind::two_faced, scenario, options)) ==
              to_string(judged(Kind::honest, scenario, options)));
      }
}

namespace {

/// What evaluators, metrics and rules say of each agent in each step of a world whose drivers are all of one kind.
std::vector<double> said_of(Kind kind, bool at_junction) {
  using Own = Traffic::WithBehaviors<BehaviorSet<Cheat>>;
  Own world(at_junction ? support::own_map("intersection_4way.xodr") : support::straight_road(2, 500));
  for (std::size_t i = 0; i < world.map().lights().size(); ++i)
    world.set_light(LightId{static_cast<std::uint32_t>(i)}, {.cycle = 100, .green_begin = 90, .green_end = 100});
  if (at_junction)
    for (char const* const road : {"1", "2", "3"}) {
      auto const& lane = world.map().lane(world.map().find_lane(road, 0.0, -1));
      auto const pose = lane.path.pose(lane.path.length() - 40.0);
      world.add({.position = {pose.x, pose.y}, .heading = pose.heading, .speed = 10, .behavior = Cheat{kind}});
    }
  else
    for (auto const& [x, y, speed] : {std::tuple{30.0, -1.75, 20.0}, {70.0, -1.75, 8.0}, {20.0, -5.25, 18.0}})
      world.add({.position = {x, y}, .speed = speed, .behavior = Cheat{kind}});
  world.keep_history(1);
  auto const evaluators =
      std::tuple<Collision, AtFaultCollision, OffRoad, OncomingLane, Straddles, Infeasible, AtGoal, PastJunctions,
                 Progress, SpeedDeviation, SpeedLimitExcess, LaneChangeUrgency, LaneOffset, Acceleration, HardBraking,
                 LateralAcceleration, Jerk, Gap, TimeHeadway, Clearance, TimeToCollision, RequiredDeceleration,
                 BrakeThreatNumber, Closeness, OthersBraking>();
  std::tuple<PostEncroachmentTime, ImposedBraking, Exposure, RssCompliance, ClosedLoopScore, Displacement> metrics[3];
  std::vector<RuleMonitor<RuleLabels<>>> monitors;
  for (auto const& rules : {highway_rules(), intersection_rules(), road_rules()})
    for (auto const& rule : rules)
      for (int i = 0; i < 3; ++i) monitors.emplace_back(rule);
  std::vector<double> said;
  auto const add = [&](auto value) { said.push_back(static_cast<double>(value)); };
  for (int step = 0; step < 100; ++step) {
    REQUIRE(world.step(0.2));
    add(AnyCollision{}(world));
    for (Slot slot{}; index_of(slot) < 3; ++slot) {
      std::apply([&](auto const&... evaluator) { (add(evaluator(world, slot)), ...); }, evaluators);
      auto const watch = [&](auto& metric) {
        metric.observe(world, slot, 0.2);
        add(metric.value());
      };
      std::apply([&](auto&... metric) { (watch(metric), ...); }, metrics[index_of(slot)]);
      for (std::size_t i = index_of(slot); i < monitors.size(); i += 3) add(static_cast<int>(monitors[i](world, slot)));
    }
  }
  return said;
}

}  // namespace

TEST_CASE("no evaluator, metric or rule reads a plan") {
  auto const same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (bool const at_junction : {false, true}) {
    CAPTURE(at_junction);
    auto const honest = said_of(Kind::honest, at_junction), lied = said_of(Kind::two_faced, at_junction);
    REQUIRE(honest.size() == lied.size());
    CHECK(std::ranges::equal(honest, lied, same));
    CHECK_FALSE(std::ranges::equal(honest, said_of(Kind::blinker, at_junction), same));  // it sees what is driven
  }
}

TEST_CASE("who does not move has no success") {
  auto const result = judged(Kind::statue, scene(20));
  CHECK_FALSE(result.success);
  CHECK(result.timed_out);
  CHECK(result.progress_m < 60.0);
  CHECK(result.closed_loop_score == 0.0);
}

TEST_CASE("who stands still just before the impact has made a motion that no vehicle can make") {
  auto const result = judged(Kind::flincher, scene(20, {{150, -1.75, 0}}));
  CHECK_FALSE(result.success);
  CHECK(result.infeasible_steps == 1);
  CHECK(says(result, "infeasible: agent 0 changes its speed by -100 m/s^2, possible are -8"));
}

TEST_CASE("the first touch ends a run, and the impact is on record beside the fault") {
  auto const result = judged(Kind::bumper, scene(12.6, {{30 + length + 2, -1.75, 12}}));
  CHECK_FALSE(result.success);
  CHECK(result.collision);
  CHECK(result.at_fault);
  CHECK(result.hit == AgentId{1});
  CHECK(result.impact_speed == doctest::Approx(0.6));
  CHECK(result.duration_s < 5.0);
  auto const struck = judged(Kind::statue, scene(12, {{10, -1.75, 20}}));  // not to blame, yet a crash
  CHECK(struck.collision);
  CHECK_FALSE(struck.at_fault);
  CHECK_FALSE(struck.success);
  CHECK(struck.impact_speed > 8.0);
}

TEST_CASE("places that run ahead of the speed are no motion of a vehicle") {
  auto const result = judged(Kind::teleporter, scene(20));
  CHECK_FALSE(result.success);
  CHECK(result.infeasible_steps == result.steps);
  CHECK(says(result, "infeasible: agent 0 moves 12 m in a step, possible are 4.1"));
}

TEST_CASE("what a single step may be off cannot be had in every step") {
  auto crept = scene(0);
  crept.agents.front().goal = ReachLane{crept.map->lanes().front().id, 40.0, 490.0};
  auto const creeps = judged(Kind::creeper, crept);
  CHECK_FALSE(creeps.success);
  CHECK(creeps.failed_by == "infeasible");
  CHECK(says(creeps, "agent 0 drifts from its speeds by "));
  auto const drifts = judged(Kind::drifter, scene(20, {{150, -1.75, 12}}));
  CHECK_FALSE(drifts.success);
  CHECK(says(drifts, "agent 0 drifts off its headings by -"));
}

TEST_CASE("accelerations are those that were driven, not those that were claimed") {
  auto const result = judged(Kind::liar, scene(22));
  CHECK_FALSE(result.success);
  CHECK(result.infeasible);
  CHECK(result.hardest_braking == doctest::Approx(40.0));
  CHECK(result.largest_jerk == doctest::Approx(400.0));
  CHECK(result.hard_brakings > 20);
}

TEST_CASE("a braking of one step is on record, raw") {
  auto const calm = judged(Kind::honest, scene(20)), result = judged(Kind::blinker, scene(20));
  CHECK_FALSE(result.infeasible);  // it is rough, but possible
  CHECK(result.hard_brakings >= 5);
  CHECK(result.hardest_braking == doctest::Approx(7.0));
  CHECK(result.largest_jerk > 35.0);
  CHECK(calm.largest_jerk < 4.0);
  CHECK(result.closed_loop_score <= calm.closed_loop_score - 2.0 / 16.0);
  auto const strict = judged(Kind::blinker, scene(20), {.fails = {Criterion::discomfort}});
  CHECK_FALSE(strict.success);
  CHECK(strict.failed_by == "discomfort");
  CHECK(says(strict, " s discomfort"));
  CHECK(judged(Kind::honest, scene(20), {.fails = {Criterion::discomfort}}).success);
}

TEST_CASE("a stop within the step of the impact hides neither fault nor speed") {
  auto const result =
      judged(Kind::late_stopper, scene(7.9, {{30 + length + 2 + 4 * 7.9, -1.75, 0}}), {.time_step = 1.0});
  CHECK(result.collision);
  CHECK(result.at_fault);
  CHECK(result.impact_speed == doctest::Approx(7.9));
  CHECK_FALSE(result.infeasible);
}

TEST_CASE("vehicles do not go sideways") {
  auto const result = judged(Kind::crab, scene(20, {{150, -1.75, 0}}));
  CHECK_FALSE(result.success);
  CHECK(says(result, "infeasible: agent 0 moves sideways by -0.5 m in a step"));
}

TEST_CASE("who crosses another vehicle between two frames has hit it") {
  double const before = 30.0 + 12.0 * 7;
  auto const result = judged(Kind::bullet, scene(60, {{before + 6.0 + 0.5 * (12.0 - length) - 4.0, -1.75, 0}}));
  CHECK_FALSE(result.success);
  CHECK(result.collision);
  CHECK(result.impact_speed == doctest::Approx(60.0));
  CHECK(result.at_fault);  // the other stood
  auto walled = scene(60);
  walled.objects = {
      geometry::Polygon({{before + 9.0, -3.0}, {before + 9.4, -3.0}, {before + 9.4, -0.5}, {before + 9.0, -0.5}})};
  auto const through = judged(Kind::bullet, walled);
  CHECK(through.collision);
  CHECK(through.at_fault);
  CHECK_FALSE(through.success);
  for (double const speed : {0.0, 0.06, 5.0}) {  // the fault does not depend on where the frames are
    auto const passed = judged(Kind::bullet, scene(30, {{69, -1.75, speed}}), {.time_step = 1.0});
    CAPTURE(speed);
    CHECK(passed.collision);
    CHECK(passed.at_fault);
    CHECK(passed.least_time_to_collision == 0.0);
    CHECK(passed.least_clearance == 0.0);
  }
}

TEST_CASE("who leaves the road at once is judged by the way there") {
  auto away = scene(20, {{60, -1.75, 0}});
  away.agents.front().goal = NoGoal{};
  auto const result = judged(Kind::escaper, away);
  CHECK_FALSE(result.success);
  CHECK(result.collision);
  CHECK(says(result, "agent 0 moves 1000 m in a step"));
  CHECK_FALSE(judged(Kind::escaper, scene(20)).success);
}

TEST_CASE("who ends his plans has failed, also an agent that does so for the ego") {
  auto away = scene(20, {{150, -1.75, 0}});
  away.agents.front().goal = NoGoal{};
  auto const result = judged(Kind::quitter, away);
  CHECK_FALSE(result.success);
  CHECK(result.error == "agent 0: its plan says that it has nothing more to do, but it drives");
  auto two = scene(20, {{60, -5.25, 10}, {120, -5.25, 0}});
  two.controlled = {AgentId{1}};
  CHECK(judged(Kind::quitter, two).error == "agent 1: its plan says that it has nothing more to do, but it drives");
}

TEST_CASE("other agents under test are judged, too") {
  auto ram = scene(10, {{60, -5.25, 10}, {120, -5.25, 0}});
  CHECK(judged(Kind::bullet, ram).success);
  ram.controlled = {AgentId{1}};
  auto const rammed = judged(Kind::bullet, ram);
  CHECK_FALSE(rammed.success);
  CHECK(rammed.collision);
  CHECK(rammed.hit == AgentId{2});
  CHECK(says(rammed, "s collision by agent 1"));
  CHECK(rammed.others_collided == 0);

  auto pass = scene(20, {{100, -5.25, 20}}, support::road_with_signal("1000001", 2));
  pass.agents.front().position = {220, -1.75};
  pass.controlled = {AgentId{1}};
  pass.lights = {{.cycle = 100, .green_begin = 90, .green_end = 100}};
  auto const passed = judged(Kind::bullet, pass);
  CHECK_FALSE(passed.success);
  CHECK(passed.red_light);
  CHECK(says(passed, "s red_light by agent 1"));
}

TEST_CASE("who vanishes where something is in the way has failed") {
  auto const result = judged(Kind::ghost, scene(20, {{150, -1.75, 0}}));
  CHECK_FALSE(result.success);
  CHECK(result.error == "agent 0: its plan says that it has not started, but it drives");
  CHECK_FALSE(result.collision);
}

TEST_CASE("a red light makes a run no success, unless its set chooses otherwise") {
  auto scenario = scene(20, {}, support::road_with_signal("1000001"));
  scenario.lights = {{.cycle = 100, .green_begin = 90, .green_end = 100}};
  auto result = judged(Kind::bullet, scenario);
  CHECK_FALSE(result.success);
  CHECK(result.red_light);
  CHECK(result.failed_by == "red_light");
  CHECK(says(result, "s red_light"));
  auto const moments = violations_of(result);
  REQUIRE(moments.size() == 1);
  CHECK(moments.front().text == "red_light");
  CHECK(moments.front().time == doctest::Approx(170.0 / 20.0).epsilon(0.05));
  CHECK(judged(Kind::bullet, scenario, {.fails = {}}).success);
  scenario.lights = {{.cycle = 100, .green_begin = 0, .green_end = 50}};
  CHECK(judged(Kind::bullet, scenario).success);
}

namespace {

/// The criteria that a run meets, in their order.
std::string met_by(RunResult const& result) {
  std::string names;
  for (int i = 0; i <= static_cast<int>(Criterion::discomfort); ++i) {
    auto const criterion = static_cast<Criterion>(i);
    if (detail::meets(result, criterion, {})) names.append(names.empty() ? "" : " ").append(to_string(criterion));
  }
  return names;
}

/// Two lanes with a mark between them that nobody may cross.
std::shared_ptr<Map const> road_with_solid_line() {
  return parse_opendrive(
             "<OpenDRIVE><road id='0' length='500' junction='-1'><planView><geometry s='0' x='0' y='0' hdg='0' "
             "length='500'><line/></geometry></planView><lanes><laneSection s='0'><center><lane id='0'/></center>"
             "<right><lane id='-1' type='driving'><width sOffset='0' a='3.5' b='0' c='0' d='0'/><roadMark sOffset='0' "
             "type='solid' laneChange='none' weight='standard' color='standard' width='0.12'/></lane><lane id='-2' "
             "type='driving'><width sOffset='0' a='3.5' b='0' c='0' d='0'/></lane></right></laneSection></lanes>"
             "</road></OpenDRIVE>")
      .map;
}

}  // namespace

TEST_CASE("each broken rule is on record as itself, and fails a run where its set chooses so") {
  auto const check = [](Scenario<Traffic> const& scenario, Criterion criterion, std::string const& words) {
    auto const result = judged(Kind::bullet, scenario, {.time_limit = 30});
    INFO(to_string(result));
    CHECK(met_by(result) == to_string(criterion));
    CHECK(says(result, words));
    auto const strict = judged(Kind::bullet, scenario, {.time_limit = 30, .fails = {criterion}});
    CHECK(strict.failed_by == to_string(criterion));
    CHECK_FALSE(strict.success);
  };
  check(scene(20, {}, support::road_with_signal("206")), Criterion::stop_sign, "s stop_sign");

  auto crosses = scene(20, {}, road_with_solid_line());
  crosses.agents.front().heading = -0.02;
  crosses.agents.front().goal = NoGoal{};
  crosses.agents.front().position = {300, -1.75};
  check(crosses, Criterion::solid_line, "s solid_line");

  auto leaves = scene(20);
  leaves.agents.front().heading = 0.02;
  leaves.agents.front().position = {400, -1.75};
  leaves.agents.front().goal = NoGoal{};
  check(leaves, Criterion::off_road, "s off_road");
  auto other_leaves = scene(20, {{30, -5.25, 20}});
  other_leaves.agents[1].heading = -0.02;
  other_leaves.controlled = {AgentId{1}};
  check(other_leaves, Criterion::off_road, "s off_road by agent 1");

  support::WhoYields const at;
  Scenario<Traffic> takes{.map = at.map, .ego = AgentId{0}};
  auto const add = [&](std::pair<LaneId, double> const& place, map::Route const& route, double speed) {
    auto const pose = at.map->lane(place.first).path.pose(place.second);
    takes.agents.push_back({.position = pose.position(),
                            .heading = pose.heading,
                            .speed = speed,
                            .behavior = ConstantAcceleration{},
                            .route = route,
                            .id = static_cast<AgentId>(takes.agents.size())});
  };
  add(at.own_place(20.0), at.own, 5.0);
  add(at.other_place(26.0), at.other, 5.5);
  auto const along = contender<Traffic>(ConstantAcceleration{});
  auto const taken = along.run(takes, {.fails = {Criterion::right_of_way}}, false).result;
  INFO(to_string(taken));
  CHECK(met_by(taken) == "right_of_way");
  CHECK(taken.failed_by == "right_of_way");
  CHECK(says(taken, "s right_of_way to agent 1"));
}

TEST_CASE("bounds of a set, the way off the route and collisions of others are on record") {
  auto const rough = judged(Kind::blinker, scene(20), {.bounds = {.infeasible = {.grip = 5.0}}});
  CHECK(rough.failed_by == "infeasible");
  CHECK(says(rough, "possible are -5"));
  auto lost = scene(20);
  lost.agents.front().heading = 0.1;
  auto const away = judged(Kind::bullet, lost);  // beside the lane that it should reach
  INFO(to_string(away));
  CHECK(away.off_road);
  CHECK(away.off_route);
  CHECK_FALSE(away.success);
  lost.agents.front().goal = LaneLimits{.from = 400.0};
  CHECK(judged(Kind::bullet, lost).off_route);
  auto const pile = judged(Kind::honest, scene(20, {{60, -5.25, 30}, {70, -5.25, 30}, {110, -5.25, 10}}));
  CHECK(pile.success);
  CHECK(pile.others_collided == 1);
}

TEST_CASE("an impact is as hard as the two velocities differ, and who passes in one lane is beside") {
  auto crossed = scene(20, {});
  crossed.agents.push_back(
      {.position = {90, -46.75}, .speed = 15, .behavior = ConstantAcceleration{}, .id = AgentId{1}});
  crossed.agents[1].heading = 1.5707963267948966;
  crossed.agents[1].way = {{90, -60}, {90, 30}};
  auto const hit = judged(Kind::bullet, crossed, {.time_step = 0.05});
  INFO(to_string(hit));
  CHECK(hit.collision);
  CHECK(hit.impact_speed == doctest::Approx(25.0));
  CHECK(hit.post_encroachment_time == 0.0);

  auto const row = judged(Kind::bullet, scene(20, {{36, -1.75, 15}, {44, -1.75, 0}}), {.time_step = 1.0});
  CHECK(row.impact_speed == doctest::Approx(20.0));  // of two in a step, the harder one
  CHECK(row.hit == AgentId{2});

  auto const wide = support::map_of(
      {.id = "1", .line = map::lay_from({}, {{500}}), .sections = {{.right = map::equal_lanes(1, 6.0)}}});
  auto passes = scene(10, {{60, -4.6, 5}, {250, -4.6, 5}}, wide);
  passes.agents.front().position = {30, -1.4};
  auto const passed = judged(Kind::bullet, passes, {.time_limit = 12});
  CHECK_FALSE(passed.collision);
  CHECK(passed.least_gap > 0.0);
  CHECK(passed.time_headway > 0.0);
  CHECK(passed.least_clearance < 1.5);
}

TEST_CASE("whoever runs over a pedestrian is at fault, however long the steps are") {
  for (double const step : {0.2, 0.5, 1.0})
    for (double const speed : {20.0, 40.0})
      for (int i = 0; i < 12; ++i) {
        double const x = 150.0 + 0.65 * i;
        auto walks = scene(speed, {{x, -1.95 - 0.5 * (x - 34.0) / speed, 0.5}});
        auto& pedestrian = walks.agents[1];
        pedestrian.heading = 1.5707963267948966;
        pedestrian.way = {{x, -30}, {x, 30}};
        pedestrian.shape = {.front = 0.25, .rear = 0.25, .left = 0.25, .right = 0.25};
        auto const result = judged(Kind::bullet, walks, {.time_step = step});
        CAPTURE(step);
        CAPTURE(speed);
        CAPTURE(i);
        CHECK(result.collision);
        CHECK(result.at_fault);
      }
}

TEST_CASE("what others had to brake because of the ego is on record, and a criterion for sets that choose it") {
  auto const follower = IdmClassic{.law = {.desired_speed = 25}};
  auto const checked = scene(20, {{10, -1.75, 20, follower}});
  RunOptions const options{.fails = {Criterion::imposed_braking}};
  auto const result = judged(Kind::brake_checker, checked, options);
  CHECK(result.imposed_braking > 4.0);
  CHECK_FALSE(result.success);
  CHECK(result.failed_by == "imposed_braking");
  CHECK(says(result, " s imposed_braking of "));
  CHECK(judged(Kind::honest, checked, options).success);
  CHECK(judged(Kind::brake_checker, checked, {.fails = options.fails, .bounds = {.imposed_braking = 20.0}}).success);
  CHECK(judged(Kind::honest, checked, options).imposed_braking == 0.0);
  CHECK(judged(Kind::pulser, scene(20, {{8, -1.75, 20, follower}}), {.time_step = 0.5}).imposed_braking > 4.0);

  auto cuts = scene(12, {{15, -1.75, 20, follower}});
  cuts.agents.front().position = {60, -5.25};
  cuts.agents.front().heading = 0.08;
  CHECK(judged(Kind::bullet, cuts, {.time_limit = 5}).imposed_braking > 2.0);
  cuts.agents.front().heading = 0.0;
  CHECK(judged(Kind::bullet, cuts, {.time_limit = 5}).imposed_braking == 0.0);
  // Whoever brakes behind a leader that brakes for another one is asked to.
  auto const queue = scene(20, {{10, -1.75, 20, follower}, {70, -1.75, 18, ConstantAcceleration{-3.0}}});
  CHECK(judged(Kind::honest, queue).imposed_braking == 0.0);
}

TEST_CASE("who stays between two lanes is on record, and fails where the set chooses so") {
  auto between = scene(20);
  between.agents.front().position = {30, -3.2};
  RunOptions const options{.fails = {Criterion::straddling}};
  auto const result = judged(Kind::bullet, between, options);
  CHECK(result.straddling_s > 15.0);
  CHECK_FALSE(result.success);
  CHECK(result.failed_by == "straddling");
  CHECK(says(result, "0 s straddling until "));
  CHECK(judged(Kind::bullet, between, {.fails = options.fails, .bounds = {.straddling = 30.0}}).success);
  CHECK(judged(Kind::bullet, scene(20), options).straddling_s == 0.0);
  CHECK(judged(Kind::bullet, scene(20), options).success);
}

TEST_CASE("a ride against traffic makes a run no success") {
  auto const map = support::two_way_road(500);
  auto const own = std::ranges::find_if(map->lanes(), [](auto const& lane) { return lane.number < 0; });
  REQUIRE(own != map->lanes().end());
  auto scenario = scene(20, {}, map);
  scenario.agents.front().goal = ReachLane{own->id, 400.0, 490.0};
  CHECK(judged(Kind::bullet, scenario).success);
  scenario.agents.front().position = {30, -1.0};
  scenario.agents.front().heading = 0.008;
  scenario.agents.front().goal = NoGoal{};
  auto const result = judged(Kind::bullet, scenario);
  INFO(to_string(result));
  CHECK(result.wrong_way);
  CHECK_FALSE(result.success);
  CHECK(says(result, "s wrong_way until "));
  CHECK(judged(Kind::bullet, scenario, {.bounds = {.wrong_way = 100.0}}).success);
}

TEST_CASE("who drives to the letter of the score loses by the hidden bounds of a set, who drives well does not") {
  auto const score = [](Kind kind, double share_of_bounds) {
    RunOptions options{.time_step = 0.1};
    for (double ClosedLoopScore::*bound :
         {&ClosedLoopScore::acceleration, &ClosedLoopScore::deceleration, &ClosedLoopScore::jerk})
      options.bounds.score.*bound *= share_of_bounds;
    return judged(kind, scene(20), options).closed_loop_score;
  };
  CHECK(score(Kind::judges_twin, 1.0) == 1.0);
  CHECK(score(Kind::judges_twin, 0.9) == doctest::Approx(14.0 / 16.0));
  CHECK(score(Kind::honest, 0.9) == 1.0);
}

namespace {

/// Drives at the speeds of another run, or gets there as fast as a vehicle can.
struct Recalled {
  static constexpr char const* name = "recalled";
  static constexpr auto parameters() { return parameter_list(); }

  std::shared_ptr<std::vector<double> const> speeds;  ///< after each step

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, NoMemory&, double dt) const {
    double const speed = view.state().speed;
    auto const next = static_cast<std::size_t>(std::llround(view.state().time / dt)) + 1;
    double const wanted = next < speeds->size() ? (*speeds)[next] : speeds->back();
    double const to = std::clamp(wanted, std::max(0.0, speed - 8.0 * dt), speed + 4.0 * dt);
    return plan_along_lane(view, {0.5 * (speed + to) * dt, to}, dt);
  }
};

}  // namespace

TEST_CASE("who has learnt the futures of some seeds by heart gains nothing on fresh ones") {
  std::vector<Scenario<Traffic>> scenarios;  // behind a leader whom only the seed knows
  std::mt19937_64 random(3);
  auto const uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  for (std::uint64_t seed = 100; seed < 112; ++seed) {
    double const ahead = uniform(70, 130), speed = uniform(6, 18), later = uniform(2, 18);
    scenarios.push_back(scene(20, {{ahead, -1.75, speed, IdmClassic{.law = {.desired_speed = later}}}}));
    scenarios.back().seed = seed;
  }
  RunOptions const options{.time_limit = 200.0};
  auto const honest = contender<Traffic>(IdmClassic{.law = {.desired_speed = 22.0}});
  std::map<std::uint64_t, Recalled> known;  // by seed
  for (std::size_t i = 0; i < 4; ++i) {
    auto const run = honest.run(scenarios[i], options, true);
    REQUIRE(run.recording);
    auto const& agents = run.recording->agents;
    auto const ego =
        static_cast<std::size_t>(std::ranges::find(agents, scenarios[i].ego, &RecordedAgent::id) - agents.begin());
    std::vector<double> speeds;
    for (auto const& frame : run.recording->frames) speeds.push_back(frame.poses[ego].speed);
    known[scenarios[i].seed].speeds = std::make_shared<std::vector<double> const>(std::move(speeds));
  }
  auto const oracle = contender_by<Traffic>("oracle", "", 0, [&](auto const&, auto const& scenario) {
    auto const at = known.find(scenario.seed);
    return at != known.end() ? at->second : known.begin()->second;
  });
  std::size_t at_home = 0, elsewhere = 0, honestly = 0;
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    auto const result = oracle.run(scenarios[i], options, false).result;
    INFO(to_string(result));
    (i < 4 ? at_home : elsewhere) += result.success;
    if (!result.success) CHECK(result.collision);
    honestly += i >= 4 && honest.run(scenarios[i], options, false).result.success;
  }
  CHECK(at_home == 4);
  CHECK(honestly == 8);
  CHECK(elsewhere <= 4);
}

TEST_CASE("a criterion that the map cannot answer fails the run with a sentence") {
  auto const result = judged(Kind::honest, scene(20), {.fails = {Criterion::speeding}});
  CHECK_FALSE(result.success);
  CHECK(result.error ==
        "the set: fails runs by \"speeding\", but no lane of the map has a speed limit; leave it out of \"fails\", or "
        "give the map limits");
}

TEST_CASE("who throws, or takes too long, has failed") {
  auto const threw = judged(Kind::thrower, scene(20));
  CHECK_FALSE(threw.success);
  CHECK(threw.error == "out of ideas");
  auto const late = judged(Kind::honest, scene(20), {.plan_limit = 1e-9});
  CHECK_FALSE(late.success);
  CHECK(late.error_kind == RunErrorKind::plans_too_long);
  CHECK(late.error == "its plans took longer than 1e-09 s together");
}

TEST_CASE("a plan that is no number is an error that says so") {
  auto const result = judged(Kind::odd, scene(20));
  CHECK_FALSE(result.success);
  CHECK(result.error.find("agent 0 (the ego)") == 0);
  CHECK(result.error.find("finite") != std::string::npos);
}
