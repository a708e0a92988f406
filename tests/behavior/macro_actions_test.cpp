#include "cambium/behavior/actions/driver_actions.hpp"
#include "cambium/behavior/actions/macro_actions.hpp"
#include "cambium/evaluation/collision.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <set>
#include <string>
#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;
using Kind = cb::MacroAction::Kind;

namespace {

using Behaviors = cb::BehaviorSet<cb::MacroActions, cb::DriverActions<cb::IdmClassic>, cb::RandomMacroActions,
                                  cb::MotionPrimitives, cb::Safety, cb::IdmClassic>;
using World = cb::World<Behaviors, cb::InterpolateExecution, cb::SingleTrack>;

/// Three lanes at -1.75, -5.25 and -8.75 m; one agent in the middle one at 100 m and 10 m/s.
struct Highway {
  World world{straight_road(3, 2000.0)};
  cb::AgentId id;

  explicit Highway(cb::MacroActions const& macro = {}, double y = -5.25)
      : id(world.add({.position = {100, y}, .speed = 10, .behavior = macro})) {}

  void choose(std::size_t number) { world.memory<cb::MacroActions>(id).choose(number); }
  void drive(int steps) {
    for (int i = 0; i < steps; ++i) CHECK(world.step(0.25));
  }
  [[nodiscard]] double y() const { return world.state(id).y; }
};

std::size_t number_of(Kind kind, double acceleration = 0.0) {
  cb::MacroActions const macro;
  for (std::size_t i = 0; i < macro.size(); ++i)
    if (macro.actions[i] == cb::MacroAction{kind, acceleration}) return i;
  FAIL("no such action");
  return 0;
}

}  // namespace

TEST_CASE("actions can be counted and named") {
  cb::MacroActions const macro;
  CHECK(macro.size() == 7);
  std::string names;
  for (auto const& action : macro.actions) names += cb::to_string(action.kind) + std::string(" ");
  CHECK(names == "keep_gap stay stay stay stay change_left change_right ");
  auto const two = cb::MacroActions::of({{Kind::stay, -3.0}, {Kind::change_left}});
  CHECK(two.size() == 2);
  CHECK_THROWS_AS((void)cb::MacroActions::of({}), cb::ParameterError);
  cb::MacroAction const keep;
  CHECK(cb::MacroActions::of(
            {keep, keep, keep, keep, keep, keep, keep, keep, keep, keep, keep, keep, keep, keep, keep, keep})
            .size() == 16);
  CHECK_THROWS_WITH_AS((void)cb::MacroActions::of({keep, keep, keep, keep, keep, keep, keep, keep, keep, keep, keep,
                                                   keep, keep, keep, keep, keep, keep}),
                       doctest::Contains("has 17 actions; give 1 to 16"), cb::ParameterError);
  auto wrong = two;
  wrong.actions[1].acceleration = std::nan("");
  CHECK_THROWS_AS(Highway{wrong}, cb::ParameterError);
}

TEST_CASE("the plan fails for a number that does not exist; `nothing` can be chosen") {
  for (std::size_t const number : {std::size_t{7}, std::size_t{254}, std::size_t{999}}) {
    Highway at;
    at.choose(number);
    CHECK(at.world.step(0.25).failed == 1);
  }
  Highway at;
  at.choose(cb::MacroActions::nothing);
  at.drive(20);
  CHECK(at.world.state(at.id).x == doctest::Approx(150.0));
}

TEST_CASE("staying holds its acceleration until another action is chosen, and stops rather than reverses") {
  Highway at;
  at.choose(number_of(Kind::stay, 1.5));
  at.drive(8);
  CHECK(at.world.state(at.id).speed == doctest::Approx(13));
  CHECK(at.world.state(at.id).x == doctest::Approx(100 + 10 * 2 + 0.75 * 4));
  CHECK(at.y() == -5.25);
  at.choose(number_of(Kind::stay, -5.0));
  at.drive(16);
  CHECK(at.world.state(at.id).speed == 0.0);
}

TEST_CASE("a change leads to the next lane once, and is completed whatever is chosen meanwhile") {
  for (bool const left : {true, false}) {
    Highway at;
    at.choose(number_of(left ? Kind::change_left : Kind::change_right));
    at.drive(4);
    CHECK(at.y() != -5.25);
    at.choose(number_of(Kind::stay, 1.5));
    at.drive(20);
    CHECK(at.y() == doctest::Approx(left ? -1.75 : -8.75).epsilon(1e-6));
    CHECK(at.world.state(at.id).speed > 15);
    at.choose(number_of(left ? Kind::change_left : Kind::change_right));  // there is no further lane
    at.drive(20);
    CHECK(at.y() == doctest::Approx(left ? -1.75 : -8.75).epsilon(1e-6));
  }
}

TEST_CASE("choosing a change again continues it; choosing the opposite one leads back") {
  Highway at, twice, back;
  at.choose(number_of(Kind::change_left));
  twice.choose(number_of(Kind::change_left));
  back.choose(number_of(Kind::change_left));
  at.drive(4);
  twice.drive(4);
  back.drive(10);  // already in the left lane
  CHECK(back.y() > -3.5);
  twice.choose(number_of(Kind::change_left));
  back.choose(number_of(Kind::change_right));
  at.drive(4);
  twice.drive(4);
  CHECK(at.y() == twice.y());
  back.drive(20);
  CHECK(back.y() == doctest::Approx(-5.25).epsilon(1e-6));
}

TEST_CASE("the opposite change leads back smoothly before the border is crossed") {
  for (bool const left : {true, false})
    for (int const steps : {1, 4, 6}) {
      // The middle lane has a lane beyond, the edge has none.
      for (double const y : {-5.25, left ? -8.75 : -1.75}) {
        Highway at({}, y);
        at.choose(number_of(left ? Kind::change_left : Kind::change_right));
        at.drive(steps);
        CHECK(std::abs(at.y() - y) > 0.0);
        CHECK(std::abs(at.y() - y) < 1.75);
        auto const back = number_of(left ? Kind::change_right : Kind::change_left);
        auto const view = at.world.observe(at.id);
        CHECK(cb::MacroActions{}.available(view, back, at.world.memory<cb::MacroActions>(at.id).change));
        at.choose(back);
        double heading = at.world.state(at.id).heading, sharpest = 0.0;
        for (int i = 0; i < 20; ++i) {
          at.drive(1);
          CHECK(std::abs(at.y() - y) < 2.2);
          sharpest = std::max(sharpest, std::abs(at.world.state(at.id).heading - heading));
          heading = at.world.state(at.id).heading;
        }
        CHECK(at.y() == doctest::Approx(y).epsilon(1e-6));
        CHECK(sharpest < 0.12);
      }
    }
}

TEST_CASE("for any shape and speed the body stays within the two lanes of a change") {
  // The two middle lanes of four, from -10.5 to -3.5 m. A vehicle that aborts at an angle gets a little farther.
  double const left_border = -3.5, right_border = -10.5;
  for (auto const& shape :
       {cb::geometry::car(), cb::geometry::van(), cb::geometry::truck(), cb::geometry::articulated_truck(),
        cb::geometry::bus(), cb::geometry::motorcycle(), cb::geometry::bicycle(), cb::geometry::pedestrian()})
    for (int speed = 1; speed <= 30; ++speed)
      for (bool const leftwards : {true, false})
        for (double const given_up_after : {0.3, 1.0, 1.7, 2.5, 10.0}) {  // aborts at this lateral distance [m]
          double const from = leftwards ? -8.75 : -5.25;
          World world(straight_road(4, 1000.0));
          auto const id = world.add(
              {.position = {100, from}, .speed = double(speed), .shape = shape, .behavior = cb::MacroActions{}});
          auto const change = number_of(leftwards ? Kind::change_left : Kind::change_right);
          auto const back = number_of(leftwards ? Kind::change_right : Kind::change_left);
          world.memory<cb::MacroActions>(id).choose(change);
          double leftmost = -100.0, rightmost = 0.0;
          bool goes_on = true;
          do {
            REQUIRE(world.step(0.2));
            auto const state = world.state(id);
            auto const aside = cb::geometry::extent_along(shape, std::sin(state.heading), -std::cos(state.heading));
            leftmost = std::max(leftmost, state.y + aside.positive);
            rightmost = std::min(rightmost, state.y - aside.negative);
            if (goes_on && std::abs(state.y - from) > given_up_after) {
              world.memory<cb::MacroActions>(id).choose(back);
              goes_on = false;
            }
          } while (world.memory<cb::MacroActions>(id).change.active());
          INFO("length ", shape.length(), ", speed ", speed, ", leftwards ", leftwards, ", given up after ",
               given_up_after);
          double const over = goes_on ? 0.0 : 0.1;
          CHECK(leftmost < left_border + over);
          CHECK(rightmost > right_border - over);
          CHECK((std::abs(world.state(id).y - from) > 1.75) == goes_on);
        }
}

TEST_CASE("changes are available if there is a lane on that side") {
  auto const available = [](double y, Kind kind) {
    Highway at({}, y);
    return cb::MacroActions{}.available(at.world.observe(at.id), number_of(kind));
  };
  CHECK(available(-5.25, Kind::change_left));
  CHECK(available(-5.25, Kind::change_right));
  CHECK_FALSE(available(-1.75, Kind::change_left));
  CHECK(available(-1.75, Kind::change_right));
  CHECK_FALSE(available(-8.75, Kind::change_right));
  CHECK(available(-8.75, Kind::stay));
  Highway at;
  CHECK_FALSE(cb::MacroActions{}.available(at.world.observe(at.id), 7));
}

TEST_CASE("a change is unavailable beside others, and where a follower would have to brake harder than is safe") {
  auto const available = [](double x, double speed, double safe) {
    Highway at({}, -5.25);
    auto const own = at.world.state(at.id);
    at.world.add({.position = {own.x + x, -1.75}, .speed = own.speed + speed, .behavior = cb::IdmClassic{}});
    cb::MacroActions const macro{.safe_deceleration = safe};
    CHECK(macro.available(at.world.observe(at.id), number_of(Kind::change_right)));
    return macro.available(at.world.observe(at.id), number_of(Kind::change_left));
  };
  CHECK_FALSE(available(0.0, 0.0, 50.0));
  CHECK_FALSE(available(4.0, 0.0, 50.0));
  CHECK_FALSE(available(-4.0, 0.0, 50.0));
  CHECK(available(40.0, 0.0, 3.0));
  CHECK(available(-40.0, 0.0, 3.0));
  CHECK_FALSE(available(-25.0, 10.0, 3.0));
  CHECK(available(-25.0, 10.0, 50.0));
  CHECK(available(25.0, 10.0, 3.0));
}

TEST_CASE("a change into a lane that ends too soon is unavailable and does not begin") {
  World world(support::own_map("lane_drop.xodr"));
  auto const number = number_of(Kind::change_right);
  cb::MacroActions const macro{.minimum_remaining = 150.0};
  auto const far = add(world, 2, 200.0, 10.0, macro), near = add(world, 2, 390.0, 10.0, macro);
  CHECK(macro.available(world.observe(far), number));
  CHECK_FALSE(macro.available(world.observe(near), number));
  for (auto const id : {far, near}) world.memory<cb::MacroActions>(id).choose(number);
  REQUIRE(world.step(0.25));
  CHECK(world.memory<cb::MacroActions>(far).change.active());
  CHECK_FALSE(world.memory<cb::MacroActions>(near).change.active());
}

TEST_CASE("keeping the gap equals IDM") {
  World world(straight_road(1, 2000.0));
  world.add({.position = {100, -1.75}, .speed = 10, .behavior = cb::MacroActions{}});
  world.add({.position = {140, -1.75}, .speed = 6, .behavior = cb::IdmClassic{.law = {.desired_speed = 6}}});
  World other(world.shared_map());
  other.add({.position = {100, -1.75}, .speed = 10, .behavior = cb::IdmClassic{}});
  other.add({.position = {140, -1.75}, .speed = 6, .behavior = cb::IdmClassic{.law = {.desired_speed = 6}}});
  for (int i = 0; i < 40; ++i) {
    step_all(1, 0.25, world, other);
    CHECK(world.state(cb::AgentId{0}).x == doctest::Approx(other.state(cb::AgentId{0}).x).epsilon(1e-12));
  }
}

TEST_CASE("behind a standing vehicle, keeping the gap leaves room for a change where there is a lane beside") {
  for (int const lanes : {1, 2}) {
    CAPTURE(lanes);
    double const y = lanes == 1 ? -1.75 : -5.25;
    World world(straight_road(lanes, 2000.0));
    auto const id = world.add({.position = {100, y}, .speed = 15, .behavior = cb::MacroActions{}});
    world.add({.position = {250, y}, .behavior = cb::Safety{}});
    for (int i = 0; i < 160; ++i) REQUIRE(world.step(0.25));
    double const gap = world.observe(id).ahead()->gap;
    CHECK(gap == doctest::Approx(lanes == 1 ? 2.0 : 12.5).epsilon(0.02));
    world.set_behavior(id, cb::DriverActions<cb::IdmClassic>{});  // likewise, where it drives
    world.set_state(id, {0.0, 100.0, y, 0.0, 15.0});
    for (int i = 0; i < 160; ++i) REQUIRE(world.step(0.25));
    CHECK(world.observe(id).ahead()->gap == doctest::Approx(gap).epsilon(0.05));
    if (lanes == 1) continue;
    world.set_behavior(id, cb::MacroActions{});
    world.memory<cb::MacroActions>(id).choose(number_of(Kind::change_left));
    for (int i = 0; i < 80; ++i) {
      REQUIRE(world.step(0.25));
      if (i == 0) world.memory<cb::MacroActions>(id).choose(number_of(Kind::stay, 1.5));
      CHECK_FALSE(cb::Collision{}(world, world.slot_of(id)));
    }
    CHECK(world.state(id).x > 260.0);
  }
}

TEST_CASE("in a lane that it must leave it stops where the changes still fit, if told so, and can still change") {
  auto const map = support::own_map("highway_exit.xodr");
  auto const lane = map->find_lane("1", 100.0, -2), ramp = map->find_lane("2", 20.0, -1);
  auto const where = [&](bool stops, bool changes) {
    World world(map);
    auto const pose = map->lane(lane).path.pose(100.0);
    auto const id = world.add({.position = pose.position(),
                               .heading = pose.heading,
                               .speed = 20,
                               .behavior = cb::MacroActions{.stops_before_end = stops},
                               .goal = cb::ReachLane{.lane = ramp}});
    for (auto const kind : {Kind::keep_gap, Kind::stay}) {
      world.memory<cb::MacroActions>(id).choose(number_of(kind));
      for (int i = 0; i < 100; ++i) REQUIRE(world.step(0.2));
    }
    for (int i = 0; changes && i < 100; ++i) {
      world.memory<cb::MacroActions>(id).choose(number_of(i < 50 ? Kind::change_right : Kind::keep_gap));
      REQUIRE(world.step(0.2));
    }
    return world.record(id);
  };
  auto const stopped = where(true, false);
  CHECK(stopped.state.speed < 0.1);
  CHECK(stopped.lane.s < 570.0);  // the exit begins at about 600 m
  CHECK(stopped.lane.s > 500.0);
  CHECK(where(false, false).lane.s > 600.0);
  CHECK(where(true, true).lane.corridor != stopped.lane.corridor);
}

TEST_CASE("random actions repeat, differ between seeds, and all occur") {
  auto const run = [](std::uint64_t seed) {
    World world(straight_road(3, 2000.0), {.seed = seed});
    for (int i = 0; i < 5; ++i)
      world.add({.position = {100 + 60.0 * i, -5.25}, .speed = 10, .behavior = cb::RandomMacroActions{}});
    step_all(80, 0.25, world);
    return world.frame();
  };
  CHECK(run(1) == run(1));
  CHECK(run(1) != run(2));
  World world(straight_road(3, 2000.0));
  auto const id =
      world.add({.position = {100, -5.25}, .speed = 10, .behavior = cb::RandomMacroActions{.interval = 0.5}});
  std::set<int> chosen;
  int switches = 0, last = -1;
  for (int i = 0; i < 240; ++i) {
    REQUIRE(world.step(0.25));
    if (world.status(id) != cb::AgentStatus::driving) break;
    int const now = world.memory<cb::RandomMacroActions>(id).macro.chosen;
    switches += now != last;
    CHECK((i % 2 == 0 || now == last));  // every half second
    last = now;
    chosen.insert(now);
  }
  CHECK(chosen.size() == 7);
  CHECK(switches > 50);
}

TEST_CASE("the vehicle model carries out the chosen motion primitive") {
  World world(straight_road(3, 2000.0));
  cb::MotionPrimitives const primitives = cb::MotionPrimitives::of({{1.0, 0.05}, {-2.0, 0.0}});
  CHECK(primitives.size() == 2);
  auto const id = world.add({.position = {100, -5.25}, .speed = 10, .behavior = primitives});
  cb::SingleTrack const model;
  auto expected = cb::rk4_step(model, cb::rk4_step(model, world.state(id), {1.0, 0.05}, 0.1), {1.0, 0.05}, 0.1);
  REQUIRE(world.step(0.2));
  CHECK(world.state(id).x == doctest::Approx(expected.x).epsilon(1e-14));
  CHECK(world.state(id).heading == doctest::Approx(expected.heading).epsilon(1e-14));
  world.memory<cb::MotionPrimitives>(id).chosen = 1;
  double const speed = world.state(id).speed;
  REQUIRE(world.step(0.2));
  CHECK(world.state(id).speed == doctest::Approx(speed - 0.4));
  CHECK(world.record(id).action.acceleration == doctest::Approx(-2.0));
  world.memory<cb::MotionPrimitives>(id).chosen = cb::MotionPrimitives::nothing;  // coasts
  auto const before = world.state(id);
  REQUIRE(world.step(0.2));
  CHECK(world.state(id).speed == before.speed);
  CHECK(world.state(id).heading == before.heading);
  CHECK(std::hypot(world.state(id).x - before.x, world.state(id).y - before.y) == doctest::Approx(0.2 * before.speed));
  for (std::uint8_t const missing : {std::uint8_t{9}, std::uint8_t{77}}) {
    auto copy = world;
    copy.memory<cb::MotionPrimitives>(id).chosen = missing;
    auto const result = copy.step(0.2);
    CHECK(result.problem == cb::StepProblem::no_plan);
    CHECK(result.failed == 1);
  }
  CHECK_THROWS_AS((void)cb::MotionPrimitives::of({}), cb::ParameterError);
  cb::MotionPrimitive const p;
  CHECK(cb::MotionPrimitives::of({p, p, p, p, p, p, p, p, p, p, p, p, p, p, p, p}).size() == 16);
  CHECK_THROWS_WITH_AS((void)cb::MotionPrimitives::of({p, p, p, p, p, p, p, p, p, p, p, p, p, p, p, p, p}),
                       doctest::Contains("give 1 to 16"), cb::ParameterError);
}

TEST_CASE("safety brakes to a standstill and returns to the middle of its lane") {
  World world(straight_road(2, 1000.0));
  auto const id = world.add({.position = {100, -1.0}, .speed = 30, .behavior = cb::Safety{}});
  for (int i = 0; i < 40; ++i) CHECK(world.step(0.25));
  CHECK(world.state(id).speed == 0.0);
  CHECK(world.state(id).x == doctest::Approx(100 + 900 / 8.0).epsilon(0.01));
  CHECK(world.state(id).y == doctest::Approx(-1.75).epsilon(0.01));
}

TEST_CASE("the lists to choose from are parameters") {
  auto const differ = [](auto const& one, auto const& other) {
    return !cb::equal_parameters(one, other) && cb::hash_parameters(one) != cb::hash_parameters(other) &&
           cb::to_string(one) != cb::to_string(other);
  };
  auto const one = cb::MacroActions::of({{Kind::stay, -3.0}, {Kind::change_left}});
  CHECK(differ(one, cb::MacroActions::of({{Kind::stay, -2.0}, {Kind::change_left}})));
  CHECK(differ(one, cb::MacroActions::of({{Kind::stay, -3.0}, {Kind::change_right}})));
  CHECK(differ(one, cb::MacroActions::of({{Kind::stay, -3.0}})));
  CHECK_FALSE(differ(one, cb::MacroActions::of({{Kind::stay, -3.0}, {Kind::change_left}})));
  CHECK(differ(cb::MotionPrimitives::of({{1.0, 0.05}}), cb::MotionPrimitives::of({{1.0, 0.06}})));
  CHECK_THROWS_WITH_AS(cb::check_parameters(cb::MotionPrimitives{.primitives = {{1.0, 0.0}, {0.0, 2.0}}}),
                       "motion_primitives.primitives[1].steering: is 2 rad; give a value in [-1.5, 1.5] rad",
                       cb::ParameterError);
}

TEST_CASE("an action that keeps the gap is no faster than car following permits, in either lane of a change") {
  using Action = cb::MacroAction;
  auto const macro = cb::MacroActions::of({{Kind::stay, 1.0},
                                           {Kind::stay, 1.0, true},
                                           {Kind::keep_gap},
                                           {Kind::change_left, 1.0, true},
                                           {Kind::change_left, 1.0}});
  auto const speed_after = [&](std::size_t action, double leader_y) {
    Highway at(macro);
    at.world.add({.position = {115, leader_y}, .speed = 4, .behavior = cb::IdmClassic{.law = {.desired_speed = 4}}});
    at.choose(action);
    at.drive(4);
    return at.world.state(at.id).speed;
  };
  CHECK(speed_after(0, -5.25) == doctest::Approx(11.0));
  CHECK(speed_after(1, -5.25) == doctest::Approx(speed_after(2, -5.25)));
  CHECK(speed_after(1, -5.25) < 9.0);
  CHECK(speed_after(1, -1.75) == doctest::Approx(11.0).epsilon(1e-3));
  CHECK(speed_after(3, -1.75) < 9.0);
  CHECK(speed_after(4, -1.75) == doctest::Approx(11.0));
  CHECK_FALSE(Action{Kind::stay, 1.0} == Action{Kind::stay, 1.0, true});
}

TEST_CASE(
    "driver actions obey a red light although somebody stands beyond it, and leave room behind who stands before it") {
  using Ruled = cb::DriverActions<cb::Intersection>;
  auto const map = support::road_with_signal("1000001", 2);
  REQUIRE(map->lights().size() == 1);
  for (double const stands_at : {225.0, 260.0, 120.0}) {
    CAPTURE(stands_at);
    Traffic<Ruled, cb::ConstantAcceleration> world(map);
    world.set_light(map->lights()[0].id, {.cycle = 100.0, .green_begin = 90.0, .green_end = 95.0});
    auto const ego = world.add({.position = {50, -1.75}, .speed = 10, .behavior = Ruled{}});
    auto const other =
        world.add({.position = {stands_at, -1.75}, .speed = 0.0, .behavior = cb::ConstantAcceleration{}});
    for (int i = 0; i < 200; ++i) REQUIRE(world.step(0.2));
    double const front = world.state(ego).x + cb::geometry::car().front,
                 rear = world.state(other).x - cb::geometry::car().rear;
    CHECK(world.state(ego).speed < 0.1);
    CHECK(front < 200.0);
    if (stands_at > 200.0) {
      CHECK(front > 190.0);
    } else {
      CHECK(rear - front > 10.0);
      CHECK(rear - front < 20.0);
    }
  }
}

TEST_CASE("driver actions: its driver's plan, unless a macro action is chosen or a change is under way") {
  using Junction = cb::DriverActions<cb::Intersection>;
  using Crossing = Traffic<Junction, cb::Intersection>;
  auto const crossing = [](Crossing::Behavior const& own) {
    Crossing world(own_map("intersection_4way.xodr"));
    world.add({.position = {-40.0, -1.75}, .heading = 0.0, .speed = 8.0, .behavior = own, .id = cb::AgentId{1}});
    world.add({.position = {1.75, -38.0},
               .heading = cb::geometry::pi / 2,
               .speed = 8.0,
               .behavior = cb::Intersection{},
               .id = cb::AgentId{2}});
    return world;
  };
  cb::Intersection const driver{.law = {.desired_speed = 9.0}};
  auto own = crossing(Junction{.driver = driver}), alike = crossing(driver);
  double slowest = 8.0;
  for (int i = 0; i < 60; ++i) {
    step_all(1, 0.2, own, alike);
    CHECK(own.state(cb::AgentId{1}) == alike.state(cb::AgentId{1}));
    CHECK(own.state(cb::AgentId{2}) == alike.state(cb::AgentId{2}));
    slowest = std::min(slowest, own.state(cb::AgentId{1}).speed);
  }
  CHECK(slowest < 7.0);  // it gives way to the right

  // The same macro actions, in the same order, as `MacroActions` carries them out.
  using Road = Traffic<Junction, cb::MacroActions>;
  Road mixed(straight_road(3, 2000.0)), plain(straight_road(3, 2000.0));
  auto const left = number_of(Kind::change_left);
  auto const one = mixed.add({.position = {100, -5.25}, .speed = 10, .behavior = Junction{}});
  auto const two = plain.add({.position = {100, -5.25}, .speed = 10, .behavior = cb::MacroActions{}});
  mixed.memory<Junction>(one).choose(left);
  plain.memory<cb::MacroActions>(two).choose(left);
  step_all(1, 0.2, mixed, plain);
  mixed.memory<Junction>(one).choose(Junction::drive);  // in the middle of the change
  plain.memory<cb::MacroActions>(two).choose(number_of(Kind::keep_gap));
  for (int i = 0; i < 30 && plain.memory<cb::MacroActions>(two).change.active(); ++i) {
    CHECK(mixed.state(one) == plain.state(two));
    step_all(1, 0.2, mixed, plain);
  }
  CHECK(mixed.state(one) == plain.state(two));
  CHECK(mixed.state(one).y == doctest::Approx(-1.75).epsilon(0.05));
}

TEST_CASE("driver actions: one lane change is under way, whoever began it") {
  using Passing = cb::DriverActions<cb::Mobil>;
  for (auto const then : {number_of(Kind::change_right), number_of(Kind::keep_gap)}) {
    Traffic<Passing, cb::ConstantAcceleration> world(straight_road(3, 3000.0));
    auto const ego = world.add(
        {.position = {100, -5.25}, .speed = 20, .behavior = Passing{.driver = {.law = {.desired_speed = 25}}}});
    world.add({.position = {150, -5.25}, .speed = 10, .behavior = cb::ConstantAcceleration{}});
    double most = 0.0;
    auto const drive = [&](int steps, auto const& until) {
      for (int i = 0; i < steps && !until(); ++i) {
        double const y = world.state(ego).y;
        REQUIRE(world.step(0.2));
        most = std::max(most, std::abs(world.state(ego).y - y));
      }
    };
    auto const never = [] { return false; };
    drive(100, [&] { return world.state(ego).y > -1.78; });  // its driver changes to the left
    REQUIRE(world.state(ego).y > -1.78);
    world.memory<Passing>(ego).choose(then);
    drive(20, never);
    CHECK(world.state(ego).y == doctest::Approx(then == number_of(Kind::keep_gap) ? -1.75 : -5.25).epsilon(0.1));
    world.memory<Passing>(ego).choose(Passing::drive);
    drive(60, never);
    CHECK(most < 0.6);
  }
}
