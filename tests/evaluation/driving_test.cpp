#include "cambium/evaluation/driving.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "../support/maps.hpp"
#include "../world/fixtures.hpp"
#include "cambium/behavior/open_loop/static_trajectory.hpp"
#include "cambium/evaluation/course_end.hpp"
#include "cambium/evaluation/evaluator.hpp"
#include "cambium/map/road/curve_layout.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/routing/route.hpp"
#include "cambium/observer/parametric.hpp"
#include "cambium/scenario/highway_site.hpp"

using namespace fixtures;

namespace {

/// A user's own: looks at its neighbours through a view.
struct TimeHeadway {
  template <class World>
  double operator()(World& world, cb::Slot slot) const {
    auto const view = world.truth(slot);
    auto const next = view.ahead();
    return next ? next->gap / view.state().speed : 1e9;
  }
};
/// Believes others elsewhere, and does not see every second one, nor objects.
struct Misled {
  static constexpr bool perfect = false;
  static constexpr std::size_t past_steps = 1;
  template <class S>
  S observe(S state, bool, cb::RandomStream const&) const {
    state.x += 7.0;
    state.y += 3.0;
    state.speed += 1.0;
    return state;
  }
  std::size_t steps_back(bool) const { return 1; }
  template <class Scene>
  bool sees(Scene const&, cb::Slot, cb::Slot other) const {
    return cb::index_of(other) % 2 == 0;
  }
  template <class Scene>
  bool sees_object(Scene const&, cb::Slot, cb::Slot) const {
    return false;
  }
};

/// All that a view shows of the others.
template <class View>
std::vector<double> shown(View const& view) {
  std::vector<double> all{view.state().x, view.state().y, view.place().s, view.place().lateral};
  auto const add = [&](cb::RoadUser const& user) {
    all.insert(all.end(), {static_cast<double>(cb::index_of(user.slot)), user.gap, user.s, user.speed});
    if (cb::is_valid(user.agent)) all.push_back(view.state(user).x);
  };
  for (auto const& corridor : {cb::CorridorId{0}, cb::CorridorId{1}, cb::CorridorId{2}}) {
    auto const place = view.place(corridor);
    if (auto const next = view.ahead(place)) add(*next);
    if (auto const next = view.behind(place)) add(*next);
    view.around(place, 50.0, add);
  }
  if (auto const next = view.ahead()) add(*next);
  if (auto const next = view.behind()) add(*next);
  view.each_ahead({}, add);
  view.around(40.0, add);
  view.for_each_object([&](cb::ObjectId id, auto const&) { all.push_back(static_cast<double>(cb::index_of(id))); });
  return all;
}

/// A user's own behaviour, which says only where it drives.
struct Stops {
  template <class View>
  [[nodiscard]] cb::Plan<View> plan(View const& view, cb::NoMemory&, double dt) const {
    auto state = view.state();
    double const next = std::max(0.0, state.speed - 8.0 * dt);
    state.x += 0.5 * (state.speed + next) * dt;
    state.speed = next;
    state.time += dt;
    cb::Plan<View> plan;
    plan.trajectory.push_back(state);
    return plan;
  }
};
static_assert(cb::EvaluatorFor<TimeHeadway, Sim> && cb::EvaluatorFor<cb::Collision, Sim const>);

}  // namespace

TEST_CASE("the goal is reached by the agent that has it, while it is there") {
  Sim world(straight_road(1, 300));
  auto const lane = world.map().find_lane("1", 0, -1);
  auto const ego = world.slot_of(world.add({.position = {40, -1.75},
                                            .speed = 10,
                                            .behavior = cb::ConstantAcceleration{},
                                            .goal = cb::ReachLane{lane, 50.0, 70.0}}));
  auto const other =
      world.slot_of(world.add({.position = {60, -1.75}, .speed = 10, .behavior = cb::ConstantAcceleration{}}));
  cb::AtGoal const reached;
  CHECK_FALSE(reached(world, ego));
  for (int i = 0; i < 10; ++i) REQUIRE(world.step(0.2));  // at 60 m
  CHECK(reached(world, ego));
  CHECK_FALSE(reached(world, other));
  for (int i = 0; i < 10; ++i) REQUIRE(world.step(0.2));  // at 80 m
  CHECK_FALSE(reached(world, ego));
}

TEST_CASE("motion is judged along and across the lane") {
  Sim world(straight_road(1, 300));
  auto const id = world.add({.position = {40, -1.5},
                             .heading = 0.3,
                             .speed = 10,
                             .behavior = cb::ConstantAcceleration{.acceleration = -5.0}});
  auto const ego = world.slot_of(id);
  world.keep_history(1);
  CHECK(cb::Progress{}(world, ego) == doctest::Approx(10 * std::cos(0.3)));
  CHECK(cb::LaneOffset{}(world, ego) == doctest::Approx(0.25));
  CHECK(cb::SpeedDeviation{12.0}(world, ego) == doctest::Approx(2.0));
  CHECK(cb::Jerk{}(world, ego) == 0.0);
  CHECK(cb::LateralAcceleration{}(world, ego) == 0.0);
  REQUIRE(world.step(0.2));
  CHECK(cb::Acceleration{}(world, ego) == doctest::Approx(-5.0));
  CHECK(cb::HardBraking{}(world, ego));
  CHECK_FALSE(cb::HardBraking{5.5}(world, ego));
  CHECK(cb::Jerk{}(world, ego) == 0.0);  // nobody knows what it did before
  REQUIRE(world.step(0.2));
  CHECK(cb::Jerk{}(world, ego) == doctest::Approx(0.0));
  world.set_behavior(id, cb::ConstantAcceleration{.acceleration = -3.0});
  REQUIRE(world.step(0.2));
  CHECK(cb::Jerk{}(world, ego) == doctest::Approx(10.0));
}

TEST_CASE("speed counts as excess above the limit of the lane, and never without a limit") {
  Sim world(support::own_map("lane_drop.xodr"));
  auto const& lane = world.map().lane(world.map().nearest_lane({50.0, -1.75, 0.0})->lane);
  double const limit = lane.speed_limit_at(50.0);
  REQUIRE(std::isfinite(limit));
  auto const slow = world.slot_of(world.add({.position = {30, -1.75}, .speed = limit - 1.0}));
  auto const fast = world.slot_of(world.add({.position = {60, -1.75}, .speed = limit + 2.5}));
  CHECK(cb::SpeedLimitExcess{}(world, slow) == 0.0);
  CHECK(cb::SpeedLimitExcess{}(world, fast) == doctest::Approx(2.5));
  Sim free(straight_road(1, 300));
  CHECK(cb::SpeedLimitExcess{}(free, free.slot_of(free.add({.position = {30, -1.75}, .speed = 90.0}))) == 0.0);
}

TEST_CASE("a lane change grows urgent towards the end of a lane, and in a lane that does not lead to the goal") {
  Sim world(support::own_map("lane_drop.xodr"));
  auto const ends = [&](double x, double y) { return world.slot_of(world.add({.position = {x, y}, .speed = 10.0})); };
  auto const far = ends(300.0, -5.25), near = ends(340.0, -5.25), stays = ends(300.0, -1.75);
  cb::LaneChangeUrgency const urgency, late{.horizon = 1.0, .time_horizon = 0.0}, hurried{.time_horizon = 60.0};
  CHECK(urgency(world, stays) == 0.0);
  CHECK(urgency(world, far) > 0.0);
  auto const share = [&](cb::Slot slot) { return std::pow(urgency(world, slot), 1.0 / 6.0); };  // of the way
  CHECK(share(near) - share(far) == doctest::Approx(40.0 / 300.0).epsilon(0.05));
  CHECK(late(world, far) == 0.0);
  CHECK(hurried(world, far) > urgency(world, far));

  auto const map = support::own_map("highway_exit.xodr");
  auto const site = cb::find_highway_site(map);
  Sim motorway(map);
  auto const& begin = map->lane(site.lanes.front()).path;
  auto const pose = begin.pose(50.0);
  cb::Slot const inner = motorway.slot_of(motorway.add({.position = pose.position(),
                                                        .heading = pose.heading,
                                                        .speed = 15.0,  // which it likes and keeps
                                                        .goal = cb::ReachLane{site.exits.front()}}));
  double const first = cb::LaneChangeUrgency{}(motorway, inner);
  for (int i = 0; i < 40; ++i) REQUIRE(motorway.step(0.2));
  CHECK(cb::LaneChangeUrgency{}(motorway, inner) > first);
}

TEST_CASE("a vehicle is past its junctions when its rear is, or when it has left traffic") {
  Sim world(support::own_map("intersection_4way.xodr"));
  for (auto const& lane : world.map().lanes())
    if (lane.drivable() && lane.predecessors.empty() && lane.length() > 20.0) {
      auto const pose = lane.path.pose(15.0);
      world.add({.position = pose.position(),
                 .heading = pose.heading,
                 .speed = 10.0,
                 .behavior = cb::ConstantAcceleration{}});
      break;
    }
  REQUIRE(world.size() == 1);
  auto const& corridor = world.roster().agents[0].road->corridors[0];
  double end = 0.0;
  for (auto const& piece : corridor.pieces)
    if (cb::is_valid(world.map().road(world.map().lane(piece.lane).road).junction)) end = std::max(end, piece.end);
  for (auto const& conflict : corridor.conflicts) end = std::max(end, conflict.hull().end);
  REQUIRE(end > 0.0);
  int before = 0, after = 0;
  for (int i = 0; i < 300; ++i) {
    REQUIRE(world.step(0.2));
    auto const& record = world.frame().agents[0];
    bool const drives = record.status == cb::AgentStatus::driving;
    bool const expected = !drives || record.lane.s - cb::geometry::car().rear >= end;
    CHECK(cb::PastJunctions{}(world, cb::Slot{0}) == expected);
    before += !expected;
    after += expected && drives;
  }
  CHECK(before > 10);
  CHECK(after > 5);
  CHECK(world.frame().agents[0].status != cb::AgentStatus::driving);  // it left the map at last
}

TEST_CASE("an agent before a junction is not past it, whatever lane leads there") {
  for (auto const* name :
       {"intersection_4way.xodr", "intersection_3way.xodr", "roundabout.xodr", "highway_exit.xodr"}) {
    auto const map = support::own_map(name);
    int junctions = 0;
    for (auto const& lane : map->lanes()) {
      if (!lane.drivable() || lane.length() < 15.0 || cb::is_valid(map->road(lane.road).junction)) continue;
      auto const route = cb::map::straight_route(*map, lane.id);
      auto const is_inside = [&](cb::LaneId id) { return cb::is_valid(map->road(map->lane(id).road).junction); };
      bool const leads_there = std::ranges::any_of(route.lanes, is_inside);
      auto const pose = lane.path.pose(10.0);
      Sim world(map);
      auto const ego = world.slot_of(
          world.add({.position = pose.position(), .heading = pose.heading, .speed = 5.0, .route = route}));
      if (leads_there) CHECK_FALSE(cb::PastJunctions{}(world, ego));
      junctions += leads_there;
    }
    CAPTURE(name);
    CHECK(junctions > 1);
  }
}

TEST_CASE("the lateral acceleration follows from the curve that was driven") {
  auto const map = support::map_of({.id = "1",
                                    .line = cb::map::lay_from({}, {{200.0, 0.02, 0.02}}),
                                    .sections = {{.right = cb::map::equal_lanes(1)}}});
  Sim world(map);
  auto const& lane = map->lanes()[0];
  auto const pose = lane.path.pose(20.0);
  auto const ego = world.slot_of(world.add(
      {.position = pose.position(), .heading = pose.heading, .speed = 10, .behavior = cb::ConstantAcceleration{}}));
  world.keep_history(1);
  for (int i = 0; i < 5; ++i) REQUIRE(world.step(0.2));
  double const radius = 50.0 + 1.75;  // the lane is on the outer side
  CHECK(cb::LateralAcceleration{}(world, ego) == doctest::Approx(100.0 / radius).epsilon(0.01));
}

TEST_CASE("closeness is the missing share of the gap to keep, and others' braking counts beyond what is comfortable") {
  Sim world(straight_road(1, 300));
  auto const ego = world.slot_of(world.add({.position = {40, -1.75}, .speed = 10}));
  CHECK(cb::Closeness{}(world, ego) == 0.0);
  double const bumpers = cb::geometry::car().front + cb::geometry::car().rear;
  auto const ahead =
      world.add({.position = {44 + bumpers, -1.75}, .speed = 10, .behavior = cb::ConstantAcceleration{-3.0}});
  CHECK(cb::Closeness{}(world, ego) == doctest::Approx(0.5));  // 4 m in place of 2 m + 0.6 s
  CHECK(cb::Closeness{.minimum_gap = 4.0, .time_headway = 0.0}(world, ego) == doctest::Approx(0.0));
  world.set_state(ahead, {.x = 40.5 + bumpers, .y = -1.75, .speed = 10});
  CHECK(cb::Closeness{}(world, ego) == doctest::Approx(1.0 - 0.5 / 8.0));
  CHECK(cb::OthersBraking{}(world, ego) == 0.0);
  world.set_state(ahead, {.x = 140, .y = -1.75, .speed = 10});
  REQUIRE(world.step(0.2));
  CHECK(cb::OthersBraking{.range = 120.0}(world, ego) == doctest::Approx(4.0));
  CHECK(cb::OthersBraking{.comfortable = 3.5, .range = 120.0}(world, ego) == 0.0);
  CHECK(cb::OthersBraking{}(world, ego) == 0.0);                                 // too far away
  CHECK(cb::OthersBraking{.range = 120.0}(world, world.slot_of(ahead)) == 0.0);  // not its own
}

TEST_CASE("gaps are those to the next one ahead; one's own evaluator looks likewise") {
  Sim world(straight_road(1, 300));
  auto const ego = world.slot_of(world.add({.position = {40, -1.75}, .speed = 10}));
  CHECK(cb::Gap{}(world, ego) == cb::Look::horizon);
  world.add({.position = {80, -1.75}, .speed = 6});
  double const gap = 40.0 - cb::geometry::car().front - cb::geometry::car().rear;
  CHECK(cb::Gap{}(world, ego) == doctest::Approx(gap));
  CHECK(TimeHeadway{}(world, ego) == doctest::Approx(gap / 10.0));
  CHECK(cb::Gap{.farthest = 10.0}(world, ego) == 10.0);
}

TEST_CASE("braking is seen although a behaviour does not report it") {
  cb::World<cb::BehaviorSet<Stops>, cb::InterpolateExecution, cb::SingleTrack> world(straight_road(1, 300));
  auto const ego = world.slot_of(world.add({.position = {40, -1.75}, .speed = 10}));
  REQUIRE(world.step(0.2));
  CHECK(cb::Acceleration{}(world, ego) == doctest::Approx(-8.0));
  CHECK(cb::HardBraking{}(world, ego));
}

TEST_CASE("a gap is the true one, whatever the agent sees") {
  using Noisy = cb::World<Sim::Behaviors, cb::InterpolateExecution, cb::SingleTrack, cb::ParametricObserver>;
  Noisy world(straight_road(1, 300), {.seed = 4});
  cb::ObservationNoise const noise{.along = 3.0, .speed = 2.0};
  auto const ego =
      world.slot_of(world.add({.position = {40, -1.75}, .speed = 10, .observer = {.own = noise, .others = noise}}));
  world.add({.position = {60, -1.75}, .speed = 5});
  double const gap = 20.0 - cb::geometry::car().length();
  REQUIRE(std::abs(world.observe(ego).ahead()->gap - gap) > 0.01);
  CHECK(cb::Gap{}(world, ego) == doctest::Approx(gap));
}

TEST_CASE("the true view shows what an agent would see with a perfect observer") {
  using Erring = cb::World<Sim::Behaviors, cb::InterpolateExecution, cb::SingleTrack, Misled>;
  Erring erring(straight_road(3, 300));
  Sim perfect(erring.shared_map());
  auto const fill = [](auto& world) {
    for (int i = 0; i < 12; ++i) world.add({.position = {30.0 + 9.0 * i, -1.75 - 3.5 * (i % 3)}, .speed = 8.0 + i % 4});
    world.add_object(cb::geometry::Polygon{{{150, -2}, {152, -2}, {152, -1}, {150, -1}}});
    for (int i = 0; i < 5; ++i) REQUIRE(world.step(0.2));
  };
  fill(erring), fill(perfect);
  for (cb::Slot slot{}; cb::index_of(slot) < perfect.size(); ++slot)
    perfect.set_state(perfect.roster().agents[slot].id, erring.frame().agents[slot].state);
  for (cb::Slot slot{}; cb::index_of(slot) < perfect.size(); ++slot) {
    auto const truth = shown(erring.truth(slot));
    REQUIRE(truth.size() > 40);
    CHECK(shown(erring.observe(slot)) != truth);
    CHECK(shown(perfect.observe(slot)) == truth);
    if (auto const next = erring.truth(slot).ahead(); next && cb::is_valid(next->agent))
      CHECK(erring.truth(slot).acceleration(*next) == double{erring.frame().agents[next->slot].acceleration});
  }
}

TEST_CASE("a course that has not begun is not over, and an evaluator that uses a view can end one") {
  using Late = cb::World<cb::BehaviorSet<cb::ConstantAcceleration, cb::StaticTrajectory>, cb::InterpolateExecution,
                         cb::SingleTrack>;
  Late world(straight_road(1, 300));
  auto const ego = world.slot_of(world.add({.position = {40, -1.75}, .speed = 10}));
  world.add({.position = {60, -1.75}, .speed = 5});
  auto const is_near = [](auto& at, cb::Slot slot) { return TimeHeadway{}(at, slot) < 2.0; };
  CHECK(cb::course_end(world, ego) == cb::CourseEnd::none);
  CHECK(cb::course_end(world, ego, is_near) == cb::CourseEnd::collision);
  std::vector<cb::State> recording;
  for (int i = 0; i < 10; ++i)
    recording.push_back({.time = 1.0 + 0.2 * i, .x = 100.0 + 2.0 * i, .y = -1.75, .heading = 0.0, .speed = 10.0});
  auto const late = world.slot_of(world.add({.position = {100, -1.75}, .behavior = cb::StaticTrajectory{recording}}));
  REQUIRE(world.frame().agents[late].status == cb::AgentStatus::not_started);
  CHECK(cb::course_end(world, late) == cb::CourseEnd::none);
}

TEST_CASE("the course of an agent that does not drive ends by its status") {
  using Status = cb::AgentStatus;
  for (auto const& [status, end] : {std::pair{Status::not_started, cb::CourseEnd::none},
                                    {Status::arrived, cb::CourseEnd::over},
                                    {Status::off_route, cb::CourseEnd::off_road},
                                    {Status::left_map, cb::CourseEnd::over},
                                    {Status::expired, cb::CourseEnd::over},
                                    {Status::failed, cb::CourseEnd::off_road}}) {
    CAPTURE(to_string(status));
    auto roster = std::make_shared<Sim::RosterType>();
    roster->agents.emplace_back();
    roster->goals.emplace_back();
    Sim::FrameType frame;
    frame.agents.push_back({});
    frame.agents[cb::Slot{0}].status = status;
    Sim world(straight_road(1, 10), std::move(roster), std::move(frame));
    CHECK(course_end(world, cb::Slot{0}) == end);
  }
}

TEST_CASE("a course ends by a collision, off the road, in an oncoming lane, off its route, or where the map ends") {
  auto const map = support::two_way_road(300.0);
  Sim world(map);
  auto const id = world.add({.position = {40, -1.75}, .heading = 0.0, .speed = 10});
  auto const ego = world.slot_of(id);
  CHECK(course_end(world, ego) == cb::CourseEnd::none);
  for (double const speed : {0.0, 10.0}) {  // back in its own lane
    auto const& agent = world.roster().agents[ego];
    auto at = world.frame().agents[ego].lane;
    at.heading_error = 3.1;
    CHECK(cb::OncomingLane::enters(*map, *agent.road, at,
                                   cb::State{.x = 40, .y = -1.75, .heading = 3.1, .speed = speed},
                                   agent.shape) == (speed > 0.0));
  }
  world.set_state(id, {.x = 60, .y = 1.75, .heading = 0.0, .speed = 10});
  CHECK(cb::OncomingLane{}(world, ego));
  CHECK(course_end(world, ego) == cb::CourseEnd::off_road);
  CHECK(course_end(world, ego, cb::Collision{}, false) == cb::CourseEnd::none);
  world.set_state(id, {.x = 60, .y = -3.0, .heading = 0.0, .speed = 10});
  CHECK(cb::OffRoad{}(world, ego));
  CHECK(course_end(world, ego) == cb::CourseEnd::off_road);
  world.set_state(id, {.x = 60, .y = -1.75, .heading = 0.0, .speed = 10});
  world.add({.position = {62, -1.75}, .heading = 0.0});
  CHECK(course_end(world, ego) == cb::CourseEnd::collision);
  auto const nobody = [](auto const&, cb::Slot) { return false; };
  CHECK(course_end(world, ego, nobody) == cb::CourseEnd::none);
  world.set_state(id, {.x = 299, .y = -1.75, .heading = 0.0, .speed = 20});
  REQUIRE(world.step(0.5));
  CHECK(course_end(world, ego) == cb::CourseEnd::over);
}
