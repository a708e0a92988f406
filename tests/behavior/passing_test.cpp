// Cyclists keep to the side of their lane; drivers pass them there with a clearance, or follow them.

#include "cambium/behavior/law/passing.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>

#include "cambium/map/road/curve_layout.hpp"

#include "../support/scale.hpp"
#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

using Sim = Traffic<ALL_DRIVERS>;

/// A road with lanes of a width, which bends from 100 m on; traffic drives to +x, on the right or on the left.
std::shared_ptr<cb::Map const> street(double width, double curvature = 0.0, bool right_hand = true, int lanes = 1) {
  using Rule = cb::map::opendrive::DrivingSide;
  cb::map::RoadPlan road{.id = "1",
                         .line = cb::map::lay_from({}, {{100.0}, {1400.0, curvature, curvature}}),
                         .sections = {{}},
                         .rule = right_hand ? Rule::right_hand : Rule::left_hand};
  auto& section = road.sections[0];
  (right_hand ? section.right : section.left) = cb::map::equal_lanes(static_cast<std::size_t>(lanes), width);
  return support::map_of(std::move(road));
}

/// A cyclist of a model that follows by IDM.
template <class Behavior = cb::IdmClassic>
Behavior cyclist(double desired_speed = 5.0) {
  auto idm = cb::presets::cyclist();
  idm.desired_speed = desired_speed;
  Behavior behavior;
  cb::presets::follow_as(idm, behavior.law);
  if constexpr (requires { behavior.lateral.keep; })
    behavior.lateral.keep = cb::presets::cyclist_lane();
  else
    behavior.lateral = cb::presets::cyclist_lane();
  return behavior;
}

/// Adds an agent `lateral` [m] to the left of the middle of the first lane, `s` [m] after its begin.
cb::AgentId enter(Sim& world, double s, double speed, Sim::Behavior const& behavior,
                  cb::geometry::Shape const& shape = {}, double lateral = 0.0) {
  return lane_traffic::enter(
      world, world.map().lanes()[0], s,
      {.speed = speed,
       .shape = shape,
       .behavior = behavior,
       .dynamics = shape == cb::geometry::bicycle() ? cb::presets::bicycle_dynamics() : cb::SingleTrack{}},
      lateral);
}

/// Air between two agents across the lane [m] where their bodies overlap along it; infinite elsewhere.
double air_beside(Sim const& world, cb::AgentId a, cb::AgentId b) {
  auto const& line = world.roster().agents[world.slot_of(a)].road->corridors[world.record(a).lane.corridor].center;
  auto const reach = [&](cb::AgentId id) {
    auto const& record = world.record(id);
    return cb::detail::lane_reach(line, record.state, world.roster().agents[world.slot_of(id)].shape,
                                  world.record(a).lane.segment);
  };
  auto const one = reach(a), two = reach(b);
  if (one.end < two.begin || two.end < one.begin) return 1e9;
  return std::max(one.right - two.left, two.right - one.left);
}

}  // namespace

TEST_CASE("a vehicle sticks out of its lane from 0.1 m beyond the border of the side on which it drives") {
  Sim world(street(3.0));
  for (auto const& shape : {cb::geometry::car(), cb::geometry::truck(), cb::geometry::bicycle()})
    for (double const side : {1.0, -1.0})
      for (double const beyond : {-0.5, -0.02, 0.02, 0.08, 0.12, 0.18, 0.5}) {
        double const lateral = side * (1.5 - (side > 0.0 ? shape.left : shape.right) + beyond);
        if (side * lateral < 0.1) continue;
        auto const id = enter(world, 50.0, 0.0, cb::IdmClassic{}, shape, lateral);
        CAPTURE(beyond);
        CHECK(cb::detail::sticks_out(world.observe(id)) == (beyond > 0.1));
        world.remove(id);
      }
}

TEST_CASE_TEMPLATE("a cyclist keeps to the outer side of its lane, straight on and in bends", Behavior, cb::IdmClassic,
                   cb::IdmLaneTracking, cb::AdaptiveCruiseControl, cb::Mobil, cb::ZipMerge, cb::Intersection) {
  for (double const width : {3.0, 5.0})
    for (double const curvature : {0.0, 0.02, -0.02})
      for (bool const right_hand : {true, false}) {
        CAPTURE(width);
        CAPTURE(curvature);
        CAPTURE(right_hand);
        Sim world(street(width, curvature, right_hand));
        auto const id = enter(world, 10.0, 4.0, cyclist<Behavior>(), cb::geometry::bicycle());
        double const outwards = 0.5 * width - 0.4 - 0.325;
        double most = 0.0, least = 1e9;
        for (int i = 0; i < 250; ++i) {
          REQUIRE(world.step(0.2));
          double const aside = world.record(id).lane.lateral * (right_hand ? -1.0 : 1.0);
          most = std::max(most, aside);
          if (i > 60) least = std::min(least, aside);
        }
        CHECK(world.record(id).lane.s > 200.0);
        CHECK(most < outwards + 0.1);  // never nearer to the border than by 0.3 m
        CHECK(least > outwards - 0.1);
      }
}

TEST_CASE_TEMPLATE("drivers pass a cyclist with 1.5 m of air where the lane allows, and return to the middle", Behavior,
                   ALL_DRIVERS) {
  for (std::uint32_t seed = 0; seed < support::runs(12); ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 11, 0);
    bool const right_hand = cb::uniform01(random) < 0.5;
    double const width = between(4.6, 7.0, random);
    Sim world(street(width, seed % 3 == 0 ? 0.0 : between(-0.004, 0.004, random), right_hand), {.seed = seed});
    double const begin = between(30.0, 200.0, random);
    double const pace = between(3.0, 6.0, random);
    auto const slow = enter(world, begin, pace * between(0.6, 1.0, random), cyclist(pace), cb::geometry::bicycle(),
                            (right_hand ? -1.0 : 1.0) * (0.5 * width - 0.4 - 0.325));
    Behavior driver;
    if constexpr (requires { driver.law; }) driver.law.desired_speed = between(9.0, 15.0, random);
    auto const id = enter(world, 5.0, std::min(between(0.0, 14.0, random), 0.15 * begin), driver);
    double least = 1e9, hardest = 0.0, hardest_of_slow = 0.0;
    for (int i = 0; i < 400; ++i) {
      drive_safely(world, 1);
      least = std::min(least, air_beside(world, id, slow));
      hardest = std::min(hardest, world.record(id).action.acceleration);
      hardest_of_slow = std::min(hardest_of_slow, world.record(slow).action.acceleration);
      if (world.record(id).lane.s > world.record(slow).lane.s + 100.0) break;
    }
    CHECK(world.record(id).lane.s > world.record(slow).lane.s + 90.0);
    CHECK(least >= 1.5);
    CHECK(least < 100.0);
    CHECK(std::abs(world.record(id).lane.lateral) < 0.05);
    CHECK(hardest > -3.0);
    CHECK(hardest_of_slow > -0.5);
  }
}

TEST_CASE_TEMPLATE("drivers stay behind a cyclist for good in a lane that is too narrow to pass it", Behavior,
                   ALL_DRIVERS) {
  Sim world(street(3.25));
  auto const slow = enter(world, 80.0, 4.0, cyclist(), cb::geometry::bicycle());
  auto const id = enter(world, 10.0, 10.0, Behavior{});
  drive_safely(world, 1000);
  CHECK(world.record(slow).lane.s > 900.0);
  CHECK(world.record(id).lane.s < world.record(slow).lane.s - 5.0);
  CHECK(world.record(id).lane.s > world.record(slow).lane.s - 40.0);
}

TEST_CASE("a truck needs a wider lane than a car to pass, and a larger clearance too") {
  struct Case {
    cb::geometry::Shape shape;
    double width, clearance;
    bool passes;
  };
  // A bicycle takes 0.4 + 0.65 m, then come the clearance, the body and 0.1 m.
  for (auto const& [shape, width, clearance, passes] :
       {Case{cb::geometry::car(), 4.5, 1.5, true}, Case{cb::geometry::car(), 4.4, 1.5, false},
        Case{cb::geometry::truck(), 5.1, 1.5, false}, Case{cb::geometry::truck(), 5.3, 1.5, true},
        Case{cb::geometry::car(), 4.9, 2.0, false}, Case{cb::geometry::car(), 5.0, 2.0, true}}) {
    CAPTURE(width);
    CAPTURE(clearance);
    Sim world(street(width));
    auto const slow = enter(world, 80.0, 5.0, cyclist(), cb::geometry::bicycle(), -(0.5 * width - 0.725));
    auto const id = enter(world, 10.0, 5.0, cb::IdmClassic{.lateral = {.passing_clearance = clearance}}, shape);
    double least = 1e9;
    for (int i = 0; i < 400; ++i) {
      drive_safely(world, 1);
      least = std::min(least, air_beside(world, id, slow));
    }
    CHECK((world.record(id).lane.s > world.record(slow).lane.s) == passes);
    CHECK(least >= clearance);
  }
}

TEST_CASE(
    "MOBIL passes a cyclist by changing lanes where the lane is too narrow, by the nearest room where it is not") {
  for (double const width : {3.25, 5.0}) {
    CAPTURE(width);
    Sim world(street(width, 0.0, true, 2));
    auto const slow = lane_traffic::enter(world, lane_of(world.map(), 2), 120.0,
                                          {.speed = 5.0,
                                           .shape = cb::geometry::bicycle(),
                                           .behavior = cyclist(),
                                           .dynamics = cb::presets::bicycle_dynamics()},
                                          -(0.5 * width - 0.725));
    auto const id = add(world, 2, 20.0, 12.0, cb::Mobil{});
    auto const home = world.record(id).lane.corridor;
    bool changed = false;
    double least = 1e9;
    for (int i = 0; i < 150; ++i) {
      drive_safely(world, 1);
      changed = changed || world.record(id).lane.corridor != home;
      least = std::min(least, air_beside(world, id, slow));
    }
    CHECK(world.record(id).lane.s > world.record(slow).lane.s + 20.0);
    CHECK(changed == (width < 4.0));
    CHECK(least >= 1.0);
  }
}

TEST_CASE("cars, vans and cyclists of different speeds share wide lanes without contact; most cars get past") {
  int with_car = 0, past = 0;
  for (std::uint32_t seed = 0; seed < support::runs(30); ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 12, 0);
    bool const right_hand = seed % 2 == 0;
    double const width = between(4.6, 6.0, random);
    Sim world(street(width, between(-0.005, 0.005, random), right_hand), {.seed = seed});
    std::optional<cb::AgentId> first, car;
    for (double s = 20.0; s < 300.0; s += between(12.0, 40.0, random)) {
      double const kind = cb::uniform01(random), speed = between(0.0, 4.0, random);
      if (kind < 0.5) {
        auto const id = enter(world, s, speed, cyclist(between(3.0, 7.0, random)), cb::geometry::bicycle());
        if (!first) first = id;
      } else if (kind < 0.8 || !first) {
        auto const id = enter(world, s, speed, cb::IdmClassic{.law = {.desired_speed = 13.0}});
        if (!first) car = id;
      } else {
        enter(world, s, speed, cb::Mobil{}, cb::geometry::van());
      }
    }
    drive_safely(world, 300);
    if (!first || !car) continue;
    ++with_car;
    past += world.record(*car).lane.s > world.record(*first).lane.s;
  }
  CHECK(with_car > 0);
  CHECK(past >= 0.8 * with_car);
}

TEST_CASE("nobody passes a vehicle that drives in the middle, is about to move over, or is hardly slower") {
  auto const map = street(7.0);
  auto const passes = [&](double lateral, double heading, double speed, cb::geometry::Shape const& shape) {
    Sim world(map);
    auto const slow = enter(world, 60.0, speed, cb::IdmClassic{.law = {.desired_speed = speed}}, shape, lateral);
    auto state = world.state(slow);
    state.heading = heading;
    world.set_state(slow, state);
    auto const id = enter(world, 40.0, 8.0, cb::IdmClassic{});
    auto const view = world.observe(id);
    cb::KeepLane::Memory memory;
    cb::Idm const law;
    (void)cb::KeepLane{}.next_in_way(view, cb::Limits(law, 8.0, law.desired_speed), memory);
    return memory.aside != 0;
  };
  auto const bicycle = cb::geometry::bicycle();
  CHECK(passes(-2.5, 0.0, 5.0, bicycle));
  CHECK(passes(-1.0, 0.0, 5.0, bicycle));
  CHECK_FALSE(passes(0.0, 0.0, 5.0, bicycle));   // in the middle
  CHECK_FALSE(passes(-2.5, 0.2, 5.0, bicycle));  // moves inwards at 1 m/s
  CHECK(passes(-2.5, -0.05, 5.0, bicycle));      // outwards
  CHECK_FALSE(passes(-3.3, 0.0, 5.0, bicycle));  // reaches over the border
  CHECK_FALSE(passes(-2.5, 0.0, 14.0, bicycle));
  CHECK(passes(-2.5, 0.0, 5.0, cb::geometry::car()));  // only the room matters, not the kind of vehicle
}

TEST_CASE("a driver passes at the nearest offset with room, as found by trying out steps of 1 cm") {
  int passed = 0;
  for (std::uint32_t seed = 0; seed < 400; ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 13, 0);
    bool const right_hand = cb::uniform01(random) < 0.5;
    double const width = between(3.0, 8.0, random), clearance = between(0.5, 2.5, random);
    Sim world(street(width, 0.0, right_hand));
    cb::geometry::Shape const shapes[] = {cb::geometry::bicycle(), cb::geometry::car(), cb::geometry::truck()};
    auto const& slow_shape = shapes[cb::uniform_index(random, 2)];
    auto const& shape = shapes[1 + cb::uniform_index(random, 2)];
    double const room = 0.5 * width - 0.5 * slow_shape.width();
    double const lateral = between(-room, room, random);
    auto const slow = enter(world, 60.0, 3.0, cb::IdmClassic{}, slow_shape, lateral);
    auto const id = enter(world, 30.0, 8.0, cb::IdmClassic{}, shape);
    auto const view = world.observe(id);
    double const side = right_hand ? 1.0 : -1.0;
    auto const found = cb::detail::offset_to_pass(view, *view.ahead(), clearance, side, true);
    std::optional<double> tried;
    auto const here = world.map().lanes()[0].path.pose(60.0);
    auto const& other = world.state(slow);
    auto const other_box = cb::geometry::box_of(slow_shape, other);
    for (int k = 0; k * 0.01 < width && !tried; ++k) {
      double const offset = side * 0.01 * k;
      cb::State const there{0.0, here.x, here.y + offset, here.heading, 8.0};
      bool const is_inside = std::abs(offset) + 0.5 * shape.width() <= 0.5 * width;
      auto const box = cb::geometry::box_of(shape, there);
      bool const is_inwards = side * (there.y - other.y) > 0.0;
      if (is_inside && is_inwards && cb::geometry::distance(box, other_box) >= clearance + 0.1) tried = 0.01 * k;
    }
    if (found && tried) {
      CHECK(*tried >= found->aim - 1e-9);
      CHECK(*tried < found->aim + 0.01 + 1e-9);
      CHECK(found->aim >= found->least);
      ++passed;
    } else {
      CHECK_FALSE(tried.has_value());
      if (found) CHECK(found->aim > 0.5 * width - 0.5 * shape.width() - 0.01);
    }
  }
  CHECK(passed > 50);
  CHECK(passed < 350);
}

TEST_CASE("as long as everybody drives in the middle, the rules of passing change nothing") {
  auto const road = support::straight_road(1, 2000.0);
  Sim usual(road), other(road);
  cb::RandomStream random(3, 14, 0);
  for (double s = 10.0; s < 600.0; s += between(12.0, 60.0, random)) {
    double const desired = between(4.0, 20.0, random);
    enter(usual, s, 4.0, cb::IdmClassic{.law = {.desired_speed = desired}});
    enter(other, s, 4.0, cb::IdmClassic{.law = {.desired_speed = desired}, .lateral = {.passing_clearance = 0.3}});
  }
  for (int i = 0; i < 300; ++i) {
    step_all(1, 0.2, usual, other);
    REQUIRE(usual.frame() == other.frame());
    for (auto const& record : usual.frame().agents) REQUIRE(record.lane.lateral == 0.0);
  }
}

TEST_CASE("the approach to a line is the same in one step and in many, and ends on it") {
  cb::LateralCourse<double> const start{1.3, -0.02, 0.0};
  auto at = start;
  for (int i = 0; i < 50; ++i) at = cb::approach(at, 12.0, 0.7);
  auto const once = cb::approach(start, 12.0, 35.0);
  CHECK(at.offset == doctest::Approx(once.offset));
  CHECK(at.slope == doctest::Approx(once.slope));
  double const h = 1e-4;
  auto const before = cb::approach(start, 12.0, 5.0 - h), here = cb::approach(start, 12.0, 5.0),
             after = cb::approach(start, 12.0, 5.0 + h);
  CHECK(here.slope == doctest::Approx((after.offset - before.offset) / (2.0 * h)));
  CHECK(here.bend == doctest::Approx((after.slope - before.slope) / (2.0 * h)));
  CHECK(here.bend == doctest::Approx(-2.0 * here.slope / 12.0 - here.offset / 144.0));
  CHECK(std::abs(cb::approach(start, 12.0, 150.0).offset) < 1e-3);
}
