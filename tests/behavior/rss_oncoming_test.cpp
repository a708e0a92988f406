// A property: RSS-conformant agents that overtake on a two-way road never collide with oncoming ones.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

/// Ignores others and drives beside its lane, on the left, for some time.
struct Overtake {
  double begin = 0.0, end = 0.0;  ///< [s]
  double speed = 15.0;            ///< [m/s]

  static constexpr auto parameters() {
    return cb::parameter_list(
        cb::parameter("begin", &Overtake::begin, "s", cb::any_finite, "start of the time beside the lane"),
        cb::parameter("end", &Overtake::end, "s", cb::any_finite, "end of the time beside the lane"),
        cb::parameter("speed", &Overtake::speed, "m/s", cb::Range{0, 50}, "desired speed"));
  }

  template <class View>
  cb::Plan<View> plan(View const& view, cb::NoMemory&, double dt) const {
    constexpr double lateral_speed = 1.0;  // [m/s]
    auto const& at = view.place();
    double const now = view.state().speed, a = std::clamp((speed - now) / dt, -3.0, 2.0);
    double const target = view.time() >= begin && view.time() < end ? 3.5 : 0.0;
    double const most = now > 2.0 ? lateral_speed * dt : 0.0, aside = std::clamp(target - at.lateral, -most, most);
    double const along = (now + 0.5 * a * dt) * dt;
    auto next = view.state();
    next.time = view.time() + dt;
    cb::place_on_lane(view.corridor(), at.s + along, at.lateral + aside, aside == 0.0 ? 0.0 : std::atan2(aside, along),
                      at.segment, next);
    next.speed = now + a * dt;
    cb::Plan<View> plan;
    plan.trajectory.push_back(next);
    plan.action.acceleration = a;
    return plan;
  }
};

using Safe = cb::RssConformant<Overtake>;
using Behaviors = cb::BehaviorSet<Overtake, Safe>;
using World = cb::World<Behaviors, cb::InterpolateExecution, cb::SingleTrack>;

Behaviors::Any driver(Overtake const& nominal, bool safe) {
  if (safe) return Safe{nominal, {}};
  return nominal;
}

struct Tally {
  int collisions = 0, in_other_lane = 0, braked = 0, passed = 0;
};

Tally drive(bool safe, std::uint32_t scenarios) {
  auto const map = support::two_way_road(2000.0);
  Tally tally;
  for (std::uint32_t number = 0; number < scenarios; ++number) {
    cb::RandomStream random(7, number, 0);
    auto const draw = [&random](double low, double high) { return between(low, high, random); };
    double const dt = 0.1 * (2 + cb::uniform_index(random, 4)), speed = draw(8, 25), slow = draw(3, 8);
    World world(map);
    double const begin = draw(0, 6);
    // The leader is slower and at a safe distance; oncoming vehicles are far enough, only just, or too close.
    double const gap = cb::rss_same_direction(cb::RssParameters{}, speed, slow) + draw(0, 20);
    auto const one = world.add({.position = {300, -1.75},
                                .heading = 0.0,
                                .speed = speed,
                                .behavior = driver({begin, begin + draw(3, 15), speed}, safe)});
    world.add({.position = {305 + gap, -1.75}, .heading = 0.0, .speed = slow, .behavior = driver({0, 0, slow}, safe)});
    double x = 300 + draw(40, 600);
    for (int i = 0; i < 2; ++i) {
      double const oncoming = draw(5, 25);
      bool const overtakes = cb::uniform_index(random, 4) == 0;
      double const from = overtakes ? draw(0, 6) : 0.0;
      world.add({.position = {x, 1.75},
                 .heading = cb::geometry::pi,
                 .speed = oncoming,
                 .behavior = driver({from, overtakes ? from + 6.0 : 0.0, oncoming}, safe)});
      x += cb::rss_same_direction(cb::RssParameters{}, 25.0, oncoming) + 10.0;
    }
    bool collided = false, was_left = false, braked = false;
    for (double t = 0; t < 25.0 && !collided; t += dt) {
      INFO("number ", number, ", t ", t);
      REQUIRE(world.step(dt));
      collided = cb::AnyCollision{}(world);
      if (safe && collided) FAIL_CHECK("a collision");
      was_left = was_left || world.state(one).y > 0.0;
      braked = braked || (world.state(one).y > 0.0 && world.record(one).action.acceleration < -3.9);
    }
    tally.collisions += collided;
    tally.in_other_lane += was_left;
    tally.braked += braked;
    tally.passed += world.record(one).state.x > world.frame().agents[2].state.x;
  }
  MESSAGE(scenarios << " scenarios: in " << tally.in_other_lane << " the other lane is entered, in " << tally.braked
                    << " braked in, in " << tally.passed << " the first one that comes is passed, in "
                    << tally.collisions << " somebody collides");
  return tally;
}

}  // namespace

TEST_CASE("oncoming RSS-conformant agents never collide, whoever overtakes") {
  auto const tally = drive(true, 3000);
  CHECK(tally.collisions == 0);
  CHECK(tally.in_other_lane > 300);
  CHECK(tally.braked > 50);
  CHECK(tally.passed > 1000);
}

TEST_CASE("the same agents without RSS do collide") { CHECK(drive(false, 300).collisions > 60); }

TEST_CASE("nobody brakes for oncoming vehicles in their own lane") {
  auto const map = support::map_of({.id = "1",
                                    .line = cb::map::lay_from({}, {{500.0, 0.004, 0.004}, {500.0, -0.004, -0.004}}),
                                    .sections = {{.left = cb::map::equal_lanes(1), .right = cb::map::equal_lanes(1)}}});
  World world(map);
  for (auto const& lane : map->lanes())
    for (double const s : {100.0, 300.0, 500.0}) enter(world, lane, s, {.speed = 15.0, .behavior = Safe{}});
  for (int i = 0; i < 80; ++i) {
    REQUIRE(world.step(0.2));
    for (auto const& record : world.frame().agents) CHECK(record.state.speed == doctest::Approx(15.0).epsilon(1e-3));
  }
}

TEST_CASE("an oncoming vehicle counts round a bend as on a straight road") {
  cb::RssParameters const rss;
  double const distance = cb::rss_opposite_direction(rss, 15.0, 15.0);  // between the front ends
  for (double const curvature : {0.0, 1.0 / 75.0, 1.0 / 40.0})
    for (double const more : {-10.0, 15.0}) {
      CAPTURE(curvature);
      auto const map =
          support::map_of({.id = "1",
                           .line = cb::map::lay_from({}, {{10.0}, {230.0, curvature, curvature}, {10.0}}),
                           .sections = {{.left = cb::map::equal_lanes(1), .right = cb::map::equal_lanes(1)}}});
      auto const& lane = map->lane(map->find_lane("1", 20.0, -1));
      World world(map);
      auto const own = lane.path.pose(15.0);
      double const fronts = 2.0 * cb::geometry::car().front;
      auto const theirs = lane.path.pose(15.0 + distance + fronts + more);
      auto const id =
          world.add({.position = own.position(), .heading = own.heading, .speed = 15.0, .behavior = Safe{{}, rss}});
      world.add({.position = cb::geometry::to_map(theirs, {0.0, 1.75}),
                 .heading = theirs.heading + cb::geometry::pi,
                 .speed = 15.0});
      auto const view = world.observe(id);
      auto end = view.state();
      end.x += 3.0;
      CHECK(Safe{{}, rss}.response(view, end, 0.2).brake == (more < 0.0));
    }
}
