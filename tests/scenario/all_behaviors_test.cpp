// Laws that hold for every shipped behaviour, whatever else it does.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "../support/allocations.hpp"
#include "../world/fixtures.hpp"
#include "cambium/behavior.hpp"

using namespace fixtures;

namespace {

template <class Behavior>
using World = cb::World<cb::BehaviorSet<Behavior>, cb::InterpolateExecution, cb::SingleTrack>;

/// Three in a lane, two beside, an object ahead.
template <class Behavior>
World<Behavior> traffic() {
  World<Behavior> world(straight_road(2, 500.0));
  for (double const x : {60.0, 30.0, 5.0}) world.add({.position = {x, -1.75}, .speed = 12.0});
  for (double const x : {50.0, 8.0}) world.add({.position = {x, -5.25}, .speed = 10.0});
  world.add_object(cb::geometry::Polygon({{150, -3}, {151, -3}, {151, -0.5}, {150, -0.5}}));
  return world;
}

/// Whether it draws numbers: then a prediction, which does not know the seed, goes another way.
template <class Behavior>
constexpr bool draws =
    std::is_same_v<Behavior, cb::IdmStochastic> || std::is_same_v<Behavior, cb::RandomMacroActions> ||
    std::is_same_v<Behavior, cb::HumanDriver<cb::IdmClassic>> || std::is_same_v<Behavior, cb::HumanDriver<cb::Mobil>>;

/// How a vehicle goes on that enters, or is set, on its way across the border between two lanes.
struct Entering {
  double hardest = 0.0;          ///< highest lateral acceleration [m/s^2]
  bool in_lane = true;           ///< it ends along the middle of the lane to which it drifted, to 0.4 m
  bool snaps_back = false;       ///< its lateral speed changes its sign
  bool is_set, leftwards;        ///< where it comes from
  double beyond, drift, dt = 0;  ///< [m] beyond the border, [m/s], [s]
};

/// The lanes' centre lines are at y = -1.75 and -5.25 m.
template <class Behavior>
Entering enter(Entering now) {
  double const speed = 15.0, side = now.leftwards ? 1.0 : -1.0, target = now.leftwards ? -1.75 : -5.25;
  World<Behavior> world(straight_road(2, 900.0), {.seed = 3});
  auto const heading = std::asin(side * now.drift / speed);
  double const y = -3.5 + side * now.beyond;
  auto const id = world.add(
      {.position = {50, now.is_set ? -7.0 - target : y}, .heading = now.is_set ? 0.0 : heading, .speed = speed});
  if (now.is_set) {
    for (int k = 0; k < 5; ++k) REQUIRE(world.step(0.2));
    auto state = world.state(id);
    state.y = y;
    state.heading = heading;
    world.set_state(id, state);
  }
  for (double time = 0.0; time < 15.0; time += now.dt) {
    auto const before = world.state(id);
    REQUIRE(world.step(now.dt));
    auto const& after = world.state(id);
    double const across = (after.speed * std::sin(after.heading) - before.speed * std::sin(before.heading)) / now.dt;
    now.hardest = std::max(now.hardest, std::abs(across));
    now.snaps_back = now.snaps_back || side * std::sin(after.heading) < -0.01;
  }
  now.in_lane = std::abs(world.state(id).y - target) < 0.4 && std::abs(world.state(id).heading) < 0.01;
  return now;
}

template <class Behavior>
void check_entering(bool reaches_lane) {
  for (bool const is_set : {false, true})
    for (bool const leftwards : {false, true})
      for (double const beyond : {-0.6, -0.2, 0.2, 0.8})
        for (double const drift : {0.8, 1.2, 1.6})
          for (double const dt : {0.1, 0.2, 0.5}) {
            auto const way =
                enter<Behavior>({.is_set = is_set, .leftwards = leftwards, .beyond = beyond, .drift = drift, .dt = dt});
            INFO(Behavior::name, ", set: ", is_set, ", leftwards: ", leftwards, ", beyond: ", beyond,
                 " m, drift: ", drift, " m/s, dt: ", dt, " s");
            CHECK(way.hardest < 4.0);
            if (!reaches_lane) continue;
            CHECK(way.in_lane);
            CHECK_FALSE(way.snaps_back);
          }
}

}  // namespace

TEST_CASE_TEMPLATE(
    "a vehicle that enters or is set on its way into a lane goes on into it, without a jerk of the wheel", Behavior,
    cb::IdmClassic, cb::AdaptiveCruiseControl, cb::IdmStochastic, cb::Mobil, cb::LaneChangeRuleBased, cb::Intersection,
    cb::MacroActions, cb::HumanDriver<cb::IdmClassic>, cb::HumanDriver<cb::Mobil>,
    cb::HeadwayHypotheses<cb::IdmClassic>) {
  check_entering<Behavior>(true);
}

TEST_CASE_TEMPLATE("a lane keeper that steers to its lane's middle does so without a jerk of the wheel", Behavior,
                   cb::IdmLaneTracking, cb::ZipMerge, cb::Safety, cb::IdmProposal) {
  check_entering<Behavior>(false);
}

TEST_CASE_TEMPLATE("every behaviour can predict, allocates nothing once warm, and where it draws nothing comes true",
                   Behavior, cb::IdmClassic, cb::IdmLaneTracking, cb::AdaptiveCruiseControl, cb::IdmStochastic,
                   cb::Mobil, cb::LaneChangeRuleBased, cb::ZipMerge, cb::Intersection,
                   cb::RssConformant<cb::IdmClassic>, cb::RssConformant<cb::Mobil>, cb::HumanDriver<cb::IdmClassic>,
                   cb::HumanDriver<cb::Mobil>, cb::Safety, cb::ConstantAcceleration, cb::ExternalInput,
                   cb::MotionPrimitives, cb::MacroActions, cb::RandomMacroActions,
                   cb::HeadwayHypotheses<cb::IdmClassic>, cb::IdmProposal) {
  auto world = traffic<Behavior>();
  using Set = cb::BehaviorSet<Behavior>;
  auto const begin = world.observe(static_cast<cb::AgentId>(1)).predict(cb::predict_all_as<Set>(Behavior{}));
  auto prediction = begin;
  auto const run = [&] {
    prediction = begin;
    for (int k = 0; k < 80; ++k) REQUIRE(prediction.step(0.2));
  };
  run();
  auto const first = prediction.frame();
  auto const before = support::allocations();
  run();
  CHECK(support::allocations() == before);
  CHECK(prediction.frame() == first);
  for (int k = 0; k < 80; ++k) REQUIRE(world.step(0.2));
  std::size_t differ = 0;
  for (std::size_t i = 0; i < world.size(); ++i)
    differ += !(prediction.frame().agents[i].state == world.frame().agents[i].state);
  CHECK((differ == 0) == !draws<Behavior>);
}
