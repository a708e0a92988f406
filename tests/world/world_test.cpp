#include "cambium/world/world.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../support/error_of.hpp"

#include "cambium/behavior/drivers.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/map/corridor/free_corridor.hpp"
#include "cambium/map/road/curve_layout.hpp"
#include "cambium/world/driven_to.hpp"
#include "fixtures.hpp"

using namespace fixtures;

namespace {

double const undefined = std::numeric_limits<double>::quiet_NaN();

/// Checks that `action` throws an error whose text contains `part`.
template <class Action>
void refuses(std::string const& part, Action const& action) {
  auto const text = support::error_of(action);
  CAPTURE(part);
  CAPTURE(text);
  CHECK(text != "no error");
  CHECK(text.find(part) != std::string::npos);
}

}  // namespace

TEST_CASE("an agent enters its lane, heads along it, and moves") {
  Sim world(straight_road(), {.seed = 1});
  auto const id = world.add({.position = {10, -1.75}, .speed = 12.0, .behavior = cb::ConstantAcceleration{}});
  CHECK(world.state(id).heading == doctest::Approx(0.0));
  CHECK(world.step(0.2));
  CHECK(world.state(id).x == doctest::Approx(12.4));
  CHECK(world.state(id).time == doctest::Approx(0.2));
  CHECK(world.time() == doctest::Approx(0.2));
  CHECK(world.frame().step == 1);
}

TEST_CASE("agents keep their lateral offset and follow curves") {
  Sim world(straight_road(1, 300, 0.01));
  auto const id = world.add({.position = {0, -1.5}, .speed = 10.0, .behavior = cb::ConstantAcceleration{}});
  for (int i = 0; i < 100; ++i) REQUIRE(world.step(0.1));
  auto const& s = world.state(id);
  CHECK(std::hypot(s.x, s.y - 100) == doctest::Approx(101.5).epsilon(1e-4));
  CHECK(s.heading == doctest::Approx(100.0 / 101.75).epsilon(1e-3));
}

TEST_CASE("an agent that cannot enter is named, and the world stays as it was") {
  Sim world(straight_road());
  auto const before = world.frame();
  double const nan = undefined;
  cb::geometry::Point const on_road{10, -1.75};
  cb::LaneId const first{0};
  std::pair<Sim::AgentSpec, char const*> const cases[] = {
      {{.position = {10, 50}}, "no drivable lane within 5 m"},
      {{}, "position"},
      {{.position = on_road, .heading = nan}, "heading"},
      {{.position = on_road, .heading = 3.1}, "against the direction"},
      {{.position = on_road, .speed = -1.0}, "speed"},
      {{.position = on_road, .speed = nan}, "speed"},
      {{.position = on_road, .speed = 1e300}, "speed"},
      {{.position = on_road, .acceleration = 100.1}, "its acceleration is 100.1, not a number from -100 to 100"},
      {{.position = on_road, .acceleration = nan}, "acceleration"},
      {{.position = on_road, .behavior = cb::IdmClassic{.law = {.desired_speed = nan}}}, "desired_speed"},
      {{.position = on_road, .behavior = cb::IdmClassic{.law = {.time_headway = -1}}}, "time_headway"},
      {{.position = on_road, .shape = {0, 0, 0.9, 0.9}}, "no length"},
      {{.position = on_road, .shape = {3.6, 0.9, 0, 0}}, "no width"},
      {{.position = on_road, .shape = {1e9, 0, 0.9, 0.9}}, "shape.front"},
      {{.position = on_road, .goal = cb::ReachLane{cb::LaneId{99}}}, "lane 99"},
      {{.position = on_road, .goal = cb::ReachLane{first, 50.0, 20.0}}, "ends before it begins"},
      {{.position = on_road, .goal = cb::ReachLane{first, 1e4, 2e4}}, "its goal's stretch lies outside lane 0"},
      {{.position = {10, 2.0}, .route = cb::map::Route{{cb::LaneId{1}}}}, "route"},
      {{.position = on_road, .route = cb::map::Route{{cb::LaneId{99}}}}, "a lane that the map does not have"},
      {{.position = on_road, .route = cb::map::Route{}}, "route is empty"},
      {{.position = on_road, .id = cb::none<cb::AgentId>}, "no such id"}};
  for (auto const& [spec, part] : cases) refuses(part, [&] { world.add(spec); });
  refuses("no map", [&] { Sim without_map(nullptr); });
  for (double const time : {nan, 1.1e9, -1.1e9}) refuses("time", [&] { Sim never(straight_road(), {.time = time}); });
  CHECK(world.frame() == before);
  CHECK(world.roster().agents.empty());
}

TEST_CASE("a polygon as goal may be large: any lane that it touches leads there") {
  Sim world(straight_road(1, 500));
  cb::geometry::Polygon const field({{300, -200}, {400, -200}, {400, 0}, {300, 0}});  // its middle is far from the road
  auto const id = world.add({.position = {10, -1.75}, .goal = cb::ReachPolygon{field}});
  CHECK(world.lane_of(id) == world.map().find_lane("1", 10, -1));
  cb::geometry::Polygon const elsewhere({{300, -200}, {400, -200}, {400, -100}});
  refuses("polygon", [&] { world.add({.position = {10, -1.75}, .goal = cb::ReachPolygon{elsewhere}}); });
}

TEST_CASE("a place beyond the end of a road is no place on it") {
  auto const map = straight_road(1, 300);
  CHECK(map->find_lane("1", 300.0, -1) == map->find_lane("1", 0.0, -1));
  refuses("the road is 300 m long", [&] { (void)map->find_lane("1", 300.5, -1); });
  refuses("before the road", [&] { (void)map->find_lane("1", -0.5, -1); });
  refuses("there is no lane -7", [&] { (void)map->find_lane("1", 10.0, -7); });
  refuses("no such road", [&] { (void)map->find_lane("8", 10.0, -1); });
}

TEST_CASE("ids are unique, kept, and never used again") {
  Sim world(straight_road());
  auto const a = world.add({.position = {10, -1.75}});
  auto const b = world.add({.position = {40, -1.75}, .id = static_cast<cb::AgentId>(17)});
  auto const c = world.add({.position = {70, -1.75}});
  CHECK(b == static_cast<cb::AgentId>(17));
  CHECK(static_cast<std::uint32_t>(c) == 18);
  refuses("already", [&] { world.add({.position = {100, -1.75}, .id = b}); });
  world.remove(c);
  CHECK(static_cast<std::uint32_t>(world.add({.position = {70, -1.75}})) == 19);
  refuses("agent 18: the world has no such agent", [&] { (void)world.state(c); });
  refuses("no such agent", [&] { world.remove(c); });
  CHECK(world.state(a).x == 10);
}

TEST_CASE("agents that pass the end of the road leave traffic, and are taken out on request") {
  Sim world(straight_road(1, 100));
  auto const id = world.add({.position = {90, -1.75}, .speed = 20, .behavior = cb::ConstantAcceleration{}});
  auto const follower = world.add({.position = {60, -1.75}, .speed = 10});
  CHECK(world.step(0.2).left == 0);
  CHECK(world.step(0.5).left == 1);
  CHECK(world.status(id) == cb::AgentStatus::left_map);
  CHECK_FALSE(world.observe(follower).ahead().has_value());
  auto const at = world.state(id);
  REQUIRE(world.step(0.2));
  CHECK(world.state(id) == at);
  CHECK(world.remove_departed() == 1);
  CHECK(world.size() == 1);
}

TEST_CASE("a step of 0 s, NaN, a negative time or more than an hour changes nothing and reports why") {
  Sim world(straight_road());
  world.add({.position = {10, -1.75}, .speed = 5});
  CHECK(Sim(world).step(Sim::longest_step));
  auto const before = world.frame();
  for (double dt :
       {0.0, -0.1, undefined, std::numeric_limits<double>::infinity(), 1e9, std::nextafter(Sim::longest_step, 1e9)}) {
    auto const result = world.step(dt);
    CHECK_FALSE(result.valid());
    CHECK(result.problem == cb::StepProblem::bad_duration);
    CHECK(world.frame() == before);
  }
}

namespace {

/// Plans badly, in the way asked for.
struct Broken {
  enum class How { no_plan, too_short, not_a_number, fine, backwards, too_fast, too_far } how = How::fine;

  template <class View>
  [[nodiscard]] cb::Plan<View> plan(View const& view, cb::NoMemory&, double dt) const {
    cb::Plan<View> plan;
    auto next = view.state();
    next.time += how == How::too_short ? dt / 2 : dt;
    if (how == How::not_a_number) next.x = undefined;
    if (how == How::backwards) next.speed = -5.0;
    if (how == How::too_fast) next.speed = 1e9;
    if (how == How::too_far) next.y = -1e160;
    plan.trajectory.push_back(view.state());
    plan.trajectory.push_back(next);
    if (how == How::no_plan) plan.status = cb::PlanStatus::failed;
    return plan;
  }
};

}  // namespace

TEST_CASE("an agent that plans badly is named and keeps its last state; the others move on") {
  using Fragile = cb::World<cb::BehaviorSet<cb::IdmClassic, Broken>, cb::InterpolateExecution, cb::SingleTrack>;
  std::pair<Broken::How, cb::StepProblem> const cases[] = {
      {Broken::How::no_plan, cb::StepProblem::no_plan},         {Broken::How::too_short, cb::StepProblem::no_execution},
      {Broken::How::not_a_number, cb::StepProblem::not_finite}, {Broken::How::backwards, cb::StepProblem::bad_speed},
      {Broken::How::too_fast, cb::StepProblem::bad_speed},      {Broken::How::too_far, cb::StepProblem::too_far}};
  for (auto const& [how, problem] : cases) {
    Fragile world(straight_road());
    auto const good = world.add({.position = {10, -1.75}, .speed = 10});
    auto const bad = world.add({.position = {50, -1.75}, .speed = 10, .behavior = Broken{how}});
    auto const state = world.state(bad);
    auto const result = world.step(0.2);
    CHECK(result.problem == problem);
    CHECK(result.agent == bad);
    CHECK(result.failed == 1);
    CHECK(world.status(bad) == cb::AgentStatus::failed);
    CHECK(world.state(bad) == state);
    CHECK(world.state(good).x > 10.0);
    CHECK(world.step(0.2).valid());
  }
}

TEST_CASE("history keeps the last frames with their actions, and copies do not take it along") {
  Sim world(straight_road());
  auto const id = world.add({.position = {10, -1.75}, .speed = 5});
  REQUIRE(world.step(0.2));
  CHECK(world.history_size() == 0);
  world.keep_history(3);
  std::vector<Sim::FrameType> frames;
  for (int i = 0; i < 5; ++i) {
    frames.push_back(world.frame());
    REQUIRE(world.step(0.2));
  }
  CHECK(world.history_size() == 3);
  for (std::size_t back = 1; back <= 3; ++back) CHECK(world.history(back) == frames[frames.size() - back]);
  CHECK(world.history(1).agents[0].action.acceleration > 0.0);
  refuses("no frame 4 steps back", [&] { (void)world.history(4); });
  Sim const copy = world;
  CHECK(copy.history_size() == 0);
  CHECK(world.observe(id).predict(cb::predict_all_as<Sim::Behaviors>(cb::IdmClassic{})).history_size() == 0);
}

TEST_CASE("static objects stop traffic in the lanes they reach into, and only there") {
  Sim world(straight_road(2));
  auto const right = world.add({.position = {10, -5.25}, .speed = 12});
  auto const left = world.add({.position = {10, -1.75}, .speed = 12});
  std::vector<cb::geometry::Point> const outline{{60, -6}, {62, -6}, {62, -4.5}, {60, -4.5}};
  auto const object = world.add_object(cb::geometry::Polygon(outline));
  auto const seen = world.observe(right).ahead();
  REQUIRE(seen.has_value());
  CHECK(seen->object == object);
  CHECK(seen->gap == doctest::Approx(50 - cb::geometry::Shape{}.front).epsilon(0.01));
  CHECK_FALSE(world.observe(left).ahead().has_value());
  for (int i = 0; i < 150; ++i) REQUIRE(world.step(0.2));
  CHECK(world.state(right).speed < 0.1);
  CHECK(world.state(right).x + cb::geometry::Shape{}.front < 60.0);
  CHECK(world.state(left).x > 200.0);
  world.remove_object(object);
  CHECK_FALSE(world.observe(right).ahead().has_value());
  refuses("no such object", [&] { world.remove_object(object); });
}

TEST_CASE("an agent driven from outside follows its input and changes lane corridors") {
  Sim world(straight_road(2));
  auto const ego = world.add({.position = {10, -5.25}, .speed = 10, .behavior = cb::ExternalInput{}});
  CHECK(index_of(world.record(ego).lane.corridor) == 1);
  world.memory<cb::ExternalInput>(ego) = {0.0, 0.05};
  for (int i = 0; i < 12; ++i) REQUIRE(world.step(0.2));
  CHECK(world.record(ego).action.steering == doctest::Approx(0.05));
  CHECK(world.state(ego).y > -3.5);
  CHECK(index_of(world.record(ego).lane.corridor) == 0);
  CHECK(world.lane_of(ego) == world.map().find_lane("1", 50, -1));
  world.memory<cb::ExternalInput>(ego) = {-4.0, 0.0};
  for (int i = 0; i < 20; ++i) REQUIRE(world.step(0.2));
  CHECK(world.state(ego).speed == 0.0);
  refuses("behaviour", [&] { (void)world.memory<cb::IdmClassic>(ego); });
}

TEST_CASE("an agent that reaches over its lane's border is seen in both lanes") {
  Sim world(straight_road(2));
  auto const drifting = world.add({.position = {60, -3.0}, .speed = 5, .behavior = cb::ConstantAcceleration{}});
  auto const left = world.add({.position = {10, -1.75}, .speed = 10});
  auto const right = world.add({.position = {10, -5.25}, .speed = 10});
  for (auto const id : {left, right}) {
    auto const front = world.observe(id).ahead();
    REQUIRE(front.has_value());
    CHECK(front->agent == drifting);
    CHECK(front->gap == doctest::Approx(50 - 3.6 - 0.9));
  }
}

TEST_CASE("in a narrow lane a bus a little off the middle, or slightly aslant, is seen beside its lane") {
  Sim world(support::map_of(
      {.id = "1", .line = cb::map::lay_from({}, {{300.0}}), .sections = {{.right = cb::map::equal_lanes(2, 2.85)}}}));
  auto const bus = world.add(
      {.position = {100, -4.275}, .speed = 5, .shape = cb::geometry::bus(), .behavior = cb::ConstantAcceleration{}});
  auto const car = world.add({.position = {40, -1.425}, .speed = 10});
  for (auto const& [offset, heading, reaches] :
       {std::tuple{0.0, 0.0, false}, {0.1, 0.0, false}, {0.2, 0.0, true}, {0.0, 0.04, true}}) {
    CAPTURE(offset);
    CAPTURE(heading);
    world.set_state(bus, {.x = 100, .y = -4.275 + offset, .heading = heading, .speed = 5});
    auto const front = world.observe(car).ahead();
    CHECK(front.has_value() == reaches);
    if (front) CHECK(front->agent == bus);
  }
}

TEST_CASE("states set from outside place the agent anew") {
  Sim world(straight_road(2));
  auto const id = world.add({.position = {10, -5.25}, .speed = 10});
  world.set_state(id, {.x = 300, .y = -1.5, .heading = 0.01, .speed = 7});
  CHECK(world.record(id).lane.s == doctest::Approx(300));
  CHECK(index_of(world.record(id).lane.corridor) == 0);
  refuses("not a finite", [&] { world.set_state(id, {.x = std::numeric_limits<double>::infinity()}); });
  refuses("120 m outside the lanes of its route", [&] { world.set_state(id, {.x = 300, .y = 120}); });
  refuses("500 m outside the lanes of its route", [&] { world.set_state(id, {.x = -500, .y = -5.25}); });
  CHECK(world.state(id).x == 300);
}

TEST_CASE("a state that add refuses set_state refuses with the same words, and both take the rest") {
  Sim world(straight_road(2));
  auto const id = world.add({.position = {100, -1.75}, .speed = 10});
  auto const before = world.frame();
  struct Case {
    cb::State state;
    std::string said;
  };
  double const pi = cb::geometry::pi, nan = undefined;
  for (auto const& [state, said] : {
           Case{{.x = 50, .y = -5.25, .heading = 0, .speed = -3}, "its speed is -3, not a number from 0 to 1000 m/s"},
           Case{{.x = 50, .y = -5.25, .heading = 0, .speed = -0.11}, "its speed is -0.11, not"},
           Case{{.x = 50, .y = -5.25, .heading = 0, .speed = 1001}, "its speed is 1001, not"},
           Case{{.x = 50, .y = -5.25, .heading = 0, .speed = nan}, "finite"},
           Case{{.x = 50, .y = -5.25, .heading = nan, .speed = 3}, "finite"},
           Case{{.x = 50, .y = -5.25, .heading = 1.58, .speed = 3}, "it heads against the direction of its lane"},
           Case{{.x = 50, .y = -5.25, .heading = pi, .speed = 3}, "it heads against the direction of its lane"},
           Case{{.x = 50, .y = 5.5, .heading = 0, .speed = 3}, " 5 m "},
           Case{{.x = 50, .y = -12.5, .heading = 0, .speed = 3}, " 5 m "},
           Case{{.x = 50, .y = -5.25, .heading = -1.57, .speed = 3}, "no error"},
           Case{{.x = 50, .y = 4.5, .heading = 0, .speed = 3}, "no error"},
           Case{{.x = 50, .y = -11.5, .heading = 0, .speed = 3}, "no error"},
           Case{{.x = 50, .y = -5.25, .heading = 0, .speed = -0.1}, "no error"},
           Case{{.x = 50, .y = -5.25, .heading = 6 * pi, .speed = 0}, "no error"},
       }) {
    CAPTURE(state.y);
    CAPTURE(state.heading);
    CAPTURE(state.speed);
    auto const entering = support::error_of([&] {
      Sim(world).add({.position = {state.x, state.y}, .heading = state.heading, .speed = state.speed});
    });
    auto const on_route = support::error_of([&] {
      Sim(world).add({.position = {state.x, state.y},
                      .heading = state.heading,
                      .speed = state.speed,
                      .route = cb::map::Route{
                          .lanes = {world.map().find_lane("1", 50.0, -1), world.map().find_lane("1", 50.0, -2)}}});
    });
    auto const setting = support::error_of([&] { world.set_state(id, state); });
    CHECK_MESSAGE((on_route == "no error") == (said == "no error"), on_route);
    CHECK_MESSAGE((entering == "no error") == (said == "no error"), entering);
    CHECK_MESSAGE((setting == "no error") == (said == "no error"), setting);
    CHECK_MESSAGE(setting.find(said) != std::string::npos, setting);
    CHECK((setting == "no error" || world.frame() == before));
    if (setting == "no error") CHECK(world.state(id).speed == std::max(state.speed, 0.0));
    world.restore(before);
  }
}

TEST_CASE("an agent that enters beside its route is in the lane where it stands") {
  Sim world(straight_road(2));
  auto const right = world.map().find_lane("1", 50.0, -2), left = world.map().find_lane("1", 50.0, -1);
  auto const id = world.add({.position = {100, -5.25}, .speed = 10, .route = cb::map::Route{.lanes = {left}}});
  CHECK(world.lane_of(id) == right);
  CHECK(std::abs(world.record(id).lane.lateral) < 1e-9);
  auto const entered = world.record(id).lane;
  world.set_state(id, {.x = 100, .y = -5.25, .speed = 10});
  CHECK(world.record(id).lane == entered);
}

TEST_CASE("a vehicle that was measured to stand backs up no metre") {
  Sim world(straight_road(1));
  auto const id = world.add({.position = {100, -1.75}, .speed = -0.01, .behavior = cb::ConstantAcceleration{}});
  CHECK(world.state(id).speed == 0.0);
  world.set_state(id, {.x = 50, .y = -1.75, .speed = -0.02});
  REQUIRE(world.step(1.0));
  CHECK(world.state(id).x == 50.0);
  CHECK(world.state(id).speed == 0.0);
}

TEST_CASE("with Reroute::yes a state is taken off the route, and the agent gets the one that add gives it there") {
  // A road each way.
  auto const map = support::map_of({.line = cb::map::lay_from({}, {{500.0}}),
                                    .sections = {{.left = cb::map::equal_lanes(1), .right = cb::map::equal_lanes(1)}}});
  Sim world(map);
  auto const there = map->nearest_lane({100, -1.75, 0.0})->lane;
  auto const back = map->nearest_lane({100, 1.75, cb::geometry::pi})->lane;
  auto const id = world.add({.position = {100, -1.75},
                             .speed = 10,
                             .goal = cb::GoalSequence{{cb::ReachLane{.lane = there}, cb::ReachLane{.lane = back}}},
                             .route = cb::map::Route{.lanes = {there}}});
  CHECK(world.frame().agents[0].goals_passed == 1);
  auto const shared = world;
  cb::State const state{.x = 300, .y = 1.75, .heading = cb::geometry::pi, .speed = 5};
  refuses("against the direction of its lane", [&] { world.set_state(id, state); });
  world.set_state(id, state, cb::Reroute::yes);
  CHECK(world.lane_of(id) == back);
  CHECK(world.reached_goal(id));
  CHECK(shared.lane_of(id) == there);
  Sim anew(map);
  anew.add({.position = {300, 1.75}, .heading = cb::geometry::pi, .speed = 5, .goal = cb::ReachLane{.lane = back}});
  CHECK(world.record(id).lane == anew.frame().agents[0].lane);
  REQUIRE(world.step(1.0));
  REQUIRE(anew.step(1.0));
  CHECK(world.state(id) == anew.frame().agents[0].state);
  refuses("no drivable lane within 5 m",
          [&] { world.set_state(id, {.x = 100, .y = 60, .heading = 0}, cb::Reroute::yes); });
  // From here no way leads back.
  refuses("there is no route from", [&] {
    auto other = shared;
    other.set_state(id, {.x = 100, .y = -1.75}, cb::Reroute::yes);
  });
}

namespace {

/// A road of 1 km along +x, three lanes that way and one the other.
std::shared_ptr<cb::Map const> three_and_one() {
  return support::map_of({.line = cb::map::lay_from({}, {{1000.0}}),
                          .sections = {{.left = cb::map::equal_lanes(1), .right = cb::map::equal_lanes(3)}}});
}

cb::State const the_other_way{.x = 600, .y = 1.75, .heading = cb::geometry::pi, .speed = 20};

}  // namespace

TEST_CASE("an agent that is re-routed in the middle of a lane change has forgotten it, for lanes have other numbers") {
  using World =
      cb::World<cb::BehaviorSet<cb::Mobil, cb::ConstantAcceleration>, cb::InterpolateExecution, cb::SingleTrack>;
  World world(three_and_one());
  auto const id =
      world.add({.position = {100, -8.75}, .speed = 20, .behavior = cb::Mobil{.law = {.desired_speed = 25}}});
  world.add({.position = {130, -8.75}, .speed = 5, .behavior = cb::ConstantAcceleration{}});
  int steps = 0;
  while (!world.memory<cb::Mobil>(id).lateral.change.active() && steps++ < 100) REQUIRE(world.step(0.1));
  REQUIRE(world.memory<cb::Mobil>(id).lateral.change.active());
  auto const before = world.frame();
  world.set_state(id, the_other_way, cb::Reroute::yes);
  CHECK(world.memory<cb::Mobil>(id) == cb::Mobil::Memory{});
  for (int i = 0; i < 20; ++i) REQUIRE(world.step(0.1));
  CHECK(world.state(id).y == doctest::Approx(1.75));
  refuses("the frame is from before an agent entered, left", [&] { world.restore(before); });
}

TEST_CASE(
    "frames from before another model of behaviour do not fit, and the history ends; other parameters change neither") {
  Sim world(three_and_one());
  auto const id = world.add({.position = {100, -1.75}, .speed = 10});
  world.keep_history(5);
  REQUIRE(world.step(0.2));
  auto const before = world.frame();
  world.set_behavior(id, cb::IdmClassic{.law = {.desired_speed = 3.0}});
  CHECK(world.history_size() == 1);
  CHECK_NOTHROW(world.restore(world.history(1)));
  CHECK_NOTHROW(world.restore(before));
  REQUIRE(world.step(0.2));
  world.set_behavior(id, cb::ConstantAcceleration{});
  CHECK(world.history_size() == 0);
  refuses("model of behaviour", [&] { world.restore(before); });
  REQUIRE(world.step(0.2));
}

TEST_CASE("an agent on a free corridor is not re-routed: no lane leads on from there") {
  Sim world(three_and_one());
  std::vector<cb::geometry::Point> const way{{50, -20}, {50, 20}};
  auto const id = world.add({.position = {50, -15},
                             .speed = 1,
                             .behavior = cb::ConstantAcceleration{},
                             .road = cb::map::build_free_corridor(world.map(), way)});
  auto const before = world.frame();
  refuses("agent 0: it is on a free corridor",
          [&] { world.set_state(id, {.x = 50, .y = -8, .heading = 0.3, .speed = 1}, cb::Reroute::yes); });
  CHECK(world.frame() == before);
}

TEST_CASE("agents on equal ways share a free corridor") {
  Sim world(three_and_one());
  std::vector<cb::geometry::Point> const way{{50, -20}, {50, 20}}, other{{60, -20}, {60, 20}};
  auto const add = [&](double x, double y, std::vector<cb::geometry::Point> const& points) {
    return world.add({.position = {x, y}, .speed = 1, .behavior = cb::ConstantAcceleration{}, .way = points});
  };
  auto const behind = add(50, -18, way), ahead = add(50, -12, way);
  auto const beside = add(60, -12, other);
  auto const next = world.observe(behind).ahead();
  REQUIRE(next);
  CHECK(next->agent == ahead);
  CHECK(!world.observe(beside).ahead());
  refuses("m from its road", [&] { add(90, -18, way); });
}

TEST_CASE("a long body on a free corridor is in the lane that it reaches into, whatever their direction") {
  for (double const heading : {0.0, 0.8, 1.6, 2.5, -2.0}) {
    CAPTURE(heading);
    auto const map = support::map_of(
        {.line = cb::map::lay_from({0.0, 0.0, heading}, {{200.0}}), .sections = {{.right = cb::map::equal_lanes(1)}}});
    auto const at = [&](double along, double aside) {
      return cb::geometry::Point{along * std::cos(heading) - aside * std::sin(heading),
                                 along * std::sin(heading) + aside * std::cos(heading)};
    };
    for (double const aside : {3.0, -0.5, -6.5}) {  // the lane is at 0 to -3.5 m, the truck 2.5 m wide
      CAPTURE(aside);
      Sim world(map);
      auto const car = world.add({.position = at(20, -1.75), .speed = 1, .behavior = cb::ConstantAcceleration{}});
      auto const truck = world.add({.position = at(60, aside),
                                    .heading = heading,
                                    .speed = 1,
                                    .shape = cb::geometry::truck(),
                                    .behavior = cb::ConstantAcceleration{},
                                    .way = {at(40, aside), at(90, aside)}});
      auto const next = world.observe(car).ahead();
      CHECK(next.has_value() == (aside == -0.5));
      if (next) CHECK(next->agent == truck);
    }
  }
}

TEST_CASE("a state set where the route passes twice is taken for the pass that the agent is on") {
  // A road that crosses its own beginning: out to the east, round to the left, and back over it.
  auto const map = support::map_of({.line = cb::map::lay_from({}, {{100.0}, {235.619449, 0.02, 0.02}, {100.0}}),
                                    .sections = {{.right = cb::map::equal_lanes(1)}}});
  Sim world(map);
  auto const id = world.add({.position = {30, -1.75}, .speed = 20, .behavior = cb::ConstantAcceleration{}});
  double last = world.record(id).lane.s;
  for (int i = 0; i < 95; ++i) {
    REQUIRE(world.step(0.2));
    world.set_state(id, world.state(id));
    double const s = world.record(id).lane.s;
    CHECK(s == doctest::Approx(last + 4.0).epsilon(1e-3));
    last = s;
  }
  CHECK(last > 400.0);
}

TEST_CASE("a frame is put back, as a search does, and only one that fits") {
  Sim world(straight_road(1, 500));
  auto const id = world.add({.position = {10, -1.75}, .speed = 10});
  auto const root = world.frame();
  REQUIRE(world.step(1.0));
  auto const later = world.frame();
  world.restore(root);
  CHECK(world.frame() == root);
  REQUIRE(world.step(1.0));
  CHECK(world.frame() == later);
  Sim node(world.shared_map(), world.shared_roster(), root);
  REQUIRE(node.step(1.0));
  CHECK(node.frame() == later);
  CHECK(&node.roster() == &world.roster());
  world.add({.position = {60, -1.75}});
  refuses("1 records, the roster 2 agents", [&] { world.restore(root); });
  CHECK(world.state(id).x == later.agents[0].state.x);
  refuses("no map", [&] { Sim bad(nullptr, world.shared_roster(), root); });
}

TEST_CASE("after an assignment, and after a frame is put back, neighbours are those of the new frame") {
  Sim near(straight_road(1, 500));
  auto const id = near.add({.position = {100, -1.75}}), leader = near.add({.position = {130, -1.75}});
  Sim far = near;
  far.set_state(leader, {.x = 190, .y = -1.75});
  auto const gap = [&](Sim& world) { return world.observe(id).ahead()->gap; };
  double const small = gap(near), large = gap(far);
  REQUIRE(large > small + 50.0);
  Sim world = near;
  CHECK(gap(world) == small);  // its index is built
  world = far;
  CHECK(gap(world) == large);
  world = near;
  CHECK(gap(world) == small);
  world.restore(far.frame());
  CHECK(gap(world) == large);
  world.restore(near.frame());
  CHECK(gap(world) == small);
  Sim moved = std::move(world);
  CHECK(gap(moved) == small);
}

TEST_CASE("frames are exchanged: each world goes on where the other's frame was, as if it had been put there") {
  Sim world(straight_road(1, 500), {.seed = 3});
  world.add({.position = {10, -1.75}, .speed = 10});
  world.add({.position = {40, -1.75}, .speed = 4});
  auto const root = world.frame();
  for (int i = 0; i < 5; ++i) REQUIRE(world.step(0.2));
  auto const later = world.frame();
  auto frame = root;
  static_cast<void>(world.observe(world.roster().agents[0].id));  // the index is of this frame
  world.exchange(frame);
  CHECK(frame == later);
  CHECK(world.frame() == root);
  auto const leader = world.observe(world.roster().agents[0].id).ahead();  // of the frame that is there now
  REQUIRE(leader);
  CHECK(leader->gap ==
        doctest::Approx(30.0 - world.roster().agents[0].shape.front - world.roster().agents[1].shape.rear));
  for (int i = 0; i < 5; ++i) REQUIRE(world.step(0.2));
  CHECK(world.frame() == later);
  world.exchange(frame);
  CHECK(world.frame() == later);
  CHECK(frame == later);
}

TEST_CASE("an object that covers whole lanes stands in them, and goes with its entries") {
  Sim world(own_map("merging.xodr"));
  auto const id = world.add({.position = {20, -1.75}, .speed = 10});
  auto const small = world.add_object(cb::geometry::Polygon({{80, -3}, {81, -3}, {81, -1}, {80, -1}}));
  auto const all = world.add_object(cb::geometry::Polygon({{-1e3, -1e3}, {1e3, -1e3}, {1e3, 1e3}, {-1e3, 1e3}}));
  REQUIRE(world.observe(id).ahead().has_value());
  REQUIRE(world.step(1.0));
  CHECK(world.state(id).speed < 8.0);
  world.remove_object(all);
  CHECK(world.observe(id).ahead()->object == small);
  world.remove_object(small);
  CHECK_FALSE(world.observe(id).ahead().has_value());
  CHECK(world.roster().object_entries.empty());
  cb::geometry::Polygon const vast({{0, 0}, {1e200, 0}, {0, 1e200}});
  refuses("10 km", [&] { world.add_object(vast); });
}

TEST_CASE("a prediction with parameters that make no sense is refused") {
  Sim world(straight_road(1, 500));
  auto const id = world.add({.position = {10, -1.75}});
  refuses("desired_speed", [&] {
    (void)world.observe(id).predict(
        cb::predict_all_as<Sim::Behaviors>(cb::IdmClassic{.law = {.desired_speed = undefined}}));
  });
}

TEST_CASE("a step may be long: what lies half a circle on is found") {
  Sim world(straight_road(1, 150, 0.08));  // radius 12.5 m
  auto const id = world.add({.position = {0, -1.75}, .speed = 10, .behavior = cb::ConstantAcceleration{}});
  REQUIRE(world.step(6.0));
  CHECK(world.record(id).lane.s == doctest::Approx(60.0).epsilon(1e-3));
  CHECK(std::abs(world.record(id).lane.lateral) < 0.05);
}

TEST_CASE("set_state brings an agent that has left back into traffic") {
  Sim world(straight_road(1, 100));
  auto const id = world.add({.position = {95, -1.75}, .speed = 20});
  REQUIRE(world.step(1.0));
  REQUIRE(world.status(id) == cb::AgentStatus::left_map);
  world.set_state(id, {.x = 20, .y = -1.75, .speed = 5});
  CHECK(world.status(id) == cb::AgentStatus::driving);
  REQUIRE(world.step(1.0));
  CHECK(world.state(id).x > 24.0);
}

TEST_CASE("a prediction shows what the observer expects, whatever the others really do") {
  Sim world(straight_road());
  auto const ego = world.add({.position = {10, -1.75}, .speed = 10});
  auto const other =
      world.add({.position = {60, -1.75}, .speed = 10, .behavior = cb::ConstantAcceleration{.acceleration = -2}});
  using Guess = cb::BehaviorSet<cb::ConstantAcceleration>;
  auto future = world.observe(ego).predict(
      cb::predict_as<Guess>(cb::ConstantAcceleration{.acceleration = 1}, cb::ConstantAcceleration{}));
  for (int i = 0; i < 5; ++i) {
    REQUIRE(future.step(0.2));
    REQUIRE(world.step(0.2));
  }
  CHECK(future.state(other).speed == doctest::Approx(10.0));
  CHECK(future.state(ego).speed == doctest::Approx(11.0));
  CHECK(world.state(other).speed == doctest::Approx(8.0));
}

namespace {

/// Has not begun; keeps the gaps that it sees meanwhile.
struct Latecomer {
  struct Memory {
    double front = 0.0, rear = 0.0;
    friend bool operator==(Memory const&, Memory const&) = default;
  };

  template <class View>
  [[nodiscard]] cb::Plan<View> plan(View const& view, Memory& memory, double) const {
    auto const front = view.ahead(), rear = view.behind();
    memory = {front ? front->gap : -1e9, rear ? rear->gap : -1e9};
    cb::Plan<View> plan;
    plan.status = cb::PlanStatus::not_started;
    return plan;
  }
};

bool same(std::optional<cb::RoadUser> const& a, std::optional<cb::RoadUser> const& b) {
  if (!a || !b) return !a && !b;
  return a->agent == b->agent && a->gap == b->gap && a->speed == b->speed;
}

}  // namespace

TEST_CASE("an agent that has not started sees its neighbours as if it drove, but no agent sees it") {
  using Late = cb::World<cb::BehaviorSet<cb::IdmClassic, Latecomer>, cb::InterpolateExecution, cb::SingleTrack>;
  auto const map = own_map("merging.xodr");
  int seen_by_it = 0, would_see_it = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Late world(map, {.seed = seed});
    cb::RandomStream random(seed, 7, 0);
    for (std::uint32_t i = 0; i < 12; ++i) {
      auto const& lane = map->lanes()[static_cast<std::size_t>(cb::uniform01(random) * 0.999 *
                                                               static_cast<double>(map->lanes().size()))];
      if (!lane.drivable()) continue;
      auto const pose = lane.path.pose(cb::uniform01(random) * lane.length());
      Late::AgentSpec spec{.position = pose.position(), .heading = pose.heading, .speed = 15 * cb::uniform01(random)};
      if (i % 4 == 0) spec.behavior = Latecomer{};
      world.add(spec);
    }
    REQUIRE(world.step(0.2));
    auto const late = [&](cb::AgentId id) { return world.status(id) == cb::AgentStatus::not_started; };
    for (auto const& agent : world.roster().agents) {
      auto const view = world.observe(agent.id);
      for (cb::CorridorId k{}; cb::index_of(k) < agent.road->corridors.size(); ++k)
        for (auto const& neighbor : {view.ahead(view.place(k)), view.behind(view.place(k))})
          if (neighbor) CHECK_FALSE(late(neighbor->agent));
      view.around(std::numeric_limits<double>::infinity(), [&](auto const& other) { CHECK_FALSE(late(other.agent)); });
      if (!late(agent.id)) continue;
      // The same world but for this agent, which drives.
      auto frame = world.frame();
      frame.agents[world.slot_of(agent.id)].status = cb::AgentStatus::driving;
      Late driven(map, std::make_shared<Late::RosterType>(world.roster()), frame);
      auto const truth = driven.observe(agent.id);
      for (cb::CorridorId k{}; cb::index_of(k) < agent.road->corridors.size(); ++k) {
        CHECK(same(view.ahead(view.place(k)), truth.ahead(truth.place(k))));
        CHECK(same(view.behind(view.place(k)), truth.behind(truth.place(k))));
      }
      seen_by_it += truth.ahead().has_value() + truth.behind().has_value();
      for (auto const& other : world.roster().agents) {
        auto const front = driven.observe(other.id).ahead();
        would_see_it += front && front->agent == agent.id;
      }
      CHECK(view.predict(cb::predict_all_as<Sim::Behaviors>(cb::IdmClassic{})).roster().slot_of(agent.id) ==
            std::nullopt);
      // Its behaviour is shown in a step what the view shows.
      auto const expected =
          Latecomer::Memory{truth.ahead() ? truth.ahead()->gap : -1e9, truth.behind() ? truth.behind()->gap : -1e9};
      Late next = world;
      REQUIRE(next.step(0.2));
      CHECK(next.memory<Latecomer>(agent.id) == expected);
      CHECK(late(agent.id));
    }
  }
  CHECK(seen_by_it > 200);
  CHECK(would_see_it > 100);
}

// Twin: a step of the world under constant acceleration. `driven_to` gets the state that the step ends in.
TEST_CASE("a record driven to the state of a step has the lane, the status and the goals that the step finds") {
  std::vector<cb::AgentStatus> ends;
  auto const compare = [&](Sim world) {
    for (int k = 0; k < 400 && world.frame().agents[0].status == cb::AgentStatus::driving; ++k) {
      auto const before = world;
      auto const& last = before.frame().agents[0];
      REQUIRE(world.step(0.5));
      auto const& next = world.frame().agents[0];
      auto const found = cb::driven_to(before, cb::Slot{0}, last, next.state);
      CHECK(found.state == next.state);
      CHECK(found.lane == next.lane);
      CHECK(found.status == next.status);
      CHECK(found.goals_passed == next.goals_passed);
      CHECK(found.action.acceleration == doctest::Approx(next.action.acceleration));
      CHECK(found.memory == last.memory);
    }
    auto const& gone = world.frame().agents[0];
    ends.push_back(gone.status);
    auto elsewhere = gone.state;
    elsewhere.x += 5.0;
    CHECK(cb::driven_to(world, cb::Slot{0}, gone, elsewhere) == gone);  // it has left
    return gone.goals_passed;
  };
  auto const straight = straight_road(1, 200.0);
  Sim to_the_end(straight);
  to_the_end.add({.position = {20, -1.75}, .speed = 8, .behavior = cb::ConstantAcceleration{.acceleration = 0.5}});
  compare(to_the_end);

  Sim past_goals(straight);
  auto const lane = straight->find_lane("1", 0, -1);
  past_goals.add({.position = {20, -1.75},
                  .speed = 8,
                  .behavior = cb::ConstantAcceleration{},
                  .goal = cb::GoalSequence{{cb::ReachLane{lane, 60.0, 70.0}, cb::ReachLane{lane, 120.0, 130.0}}}});
  CHECK(compare(past_goals) == 2);

  auto const fork = own_map("highway_exit.xodr");
  auto const of_type = [&](cb::map::LaneType type) -> cb::map::Lane const& {
    return *std::ranges::find(fork->lanes(), type, &cb::map::Lane::type);
  };
  auto const& path = of_type(cb::map::LaneType::exit).path;
  auto const pose = path.pose(0.8 * path.length());
  for (double const beside : {3.6, 0.0}) {  // the exit lane
    Sim to_the_ramp(fork);
    to_the_ramp.add({.position = cb::geometry::to_map(pose, {0.0, beside}),
                     .heading = pose.heading,
                     .speed = 12,
                     .goal = cb::ReachLane{of_type(cb::map::LaneType::off_ramp).id}});
    compare(to_the_ramp);
  }

  auto const merging = own_map("merging.xodr");
  Sim at_destination(merging);
  auto const ramp = merging->find_lane("2", 10, -1);
  at_destination.add({.position = merging->lane(ramp).path.pose(150.0).position(),
                      .speed = 15,
                      .goal = cb::ReachLane{merging->find_lane("3", 10, -3)}});
  compare(at_destination);
  CHECK(ends == std::vector{cb::AgentStatus::left_map, cb::AgentStatus::left_map, cb::AgentStatus::off_route,
                            cb::AgentStatus::left_map, cb::AgentStatus::arrived});
}

TEST_CASE("the largest shape that a view knows holds those of all agents, in a predicted world too") {
  Sim world(straight_road());
  auto const car = world.add({.position = {10, -1.75}, .shape = cb::geometry::car()});
  CHECK(world.observe(car).largest_shape() == cb::geometry::car());
  cb::geometry::Shape const wide{.front = 1.0, .rear = 0.2, .left = 1.4, .right = 1.1}, truck = cb::geometry::truck();
  world.add({.position = {40, -1.75}, .shape = wide});
  world.add({.position = {80, -1.75}, .shape = truck});
  auto const check = [&](auto const& view) {
    CHECK(view.largest_shape().holds(truck));
    CHECK(view.largest_shape().holds(wide));
    CHECK(view.largest_shape().front == truck.front);
  };
  check(world.observe(car));
  using Idm = cb::BehaviorSet<cb::IdmClassic>;
  auto predicted = world.observe(car).predict(cb::predict_all_as<Idm>(cb::IdmClassic{}));
  check(predicted.observe(car));
}

// Each agent's own corridor says where it waits; others see the same place, on the lane's path.
TEST_CASE("where a vehicle waits before a junction others see on the way that it signals, and nowhere else") {
  auto const map = own_map("intersection_4way.xodr");
  Sim world(map);
  struct Waits {
    cb::AgentId id;
    cb::LaneId way;
    double s;  ///< corridor position of the way's begin
    cb::map::LaneCorridor const* corridor;
  };
  std::vector<Waits> all;
  for (auto const& entrance : map->lanes())
    if (entrance.drivable() && entrance.predecessors.empty() && !entrance.successors.empty()) {
      auto const way = entrance.successors.front();
      auto const pose = entrance.path.pose(entrance.length() - 40.0);
      auto const id = world.add({.position = pose.position(),
                                 .heading = pose.heading,
                                 .route = cb::map::Route{{entrance.id, way, map->lane(way).successors.front()}, 0.0}});
      auto const& agent = world.roster().agents[world.slot_of(id)];
      auto const& corridor = agent.road->corridors[agent.road->corridor_of(way)];
      auto const piece = std::ranges::find(corridor.pieces, way, &cb::map::CorridorPiece::lane);
      all.push_back({id, way, piece->begin, &corridor});
    }
  REQUIRE(all.size() >= 8);
  int seen = 0;
  for (auto const& own : all)
    for (auto const& other : all) {
      if (own.id == other.id) continue;
      auto const observer = world.observe(own.id);
      cb::RoadUser user{};
      user.agent = other.id;
      user.slot = world.slot_of(other.id);
      for (auto const& conflict : own.corridor->conflicts) {
        if (conflict.lane != own.way) continue;
        if (!observer.signals_way(user, conflict.other)) {
          CHECK_FALSE(observer.section(user, conflict, false, false, false));
          continue;
        }
        CHECK_FALSE(observer.section(cb::RoadUser{}, conflict, false, false, false));  // an object
        auto const section = observer.section(user, conflict, false, false, false);
        if (conflict.kind == cb::map::OverlapKind::split || conflict.zones[0][0].empty()) continue;
        REQUIRE(section);
        ++seen;
        // The zones of the junction, from the corridor of the one who waits: its place is outside of them all.
        double first = 1e9;
        for (auto const& theirs : other.corridor->conflicts)
          if (!theirs.zones[0][0].empty() && theirs.kind != cb::map::OverlapKind::split)
            first = std::min(first, theirs.zones[0][0].begin);
        double const front = cb::geometry::car().front, place = other.s + section->place_to_wait(front, false);
        CHECK(place <= first + 1e-9);
        CHECK(place > first - 25.0);
        CHECK(section->place_to_wait(front, true) <= conflict.zones[0][0].other_begin + 1e-9);
      }
    }
  CHECK(seen > 20);
}
