// Laws that hold for every behaviour that heeds others, whatever else it does.
#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>

#include "../support/allocations.hpp"
#include "../world/fixtures.hpp"
#include "cambium/behavior.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"

using namespace fixtures;

namespace {

template <class Behavior>
using World = cb::World<cb::BehaviorSet<Behavior>, cb::InterpolateExecution, cb::SingleTrack>;

/// Something of `length` [m] that stands across lane -1 of `straight_road`, from `x` on.
cb::geometry::Polygon block(double x, double length = 1.0) {
  return cb::geometry::Polygon({{x, -3.0}, {x + length, -3.0}, {x + length, -0.5}, {x, -0.5}});
}

template <class Behavior>
World<Behavior> three_before(double x) {
  World<Behavior> world(straight_road(1, 500.0));
  for (double const begin : {60.0, 30.0, 5.0}) world.add({.position = {begin, -1.75}, .speed = 12.0});
  world.add_object(block(x));
  return world;
}

template <class World>
void drive(World& world, double duration) {
  for (double t = 0.0; t < duration; t += 0.2) {
    CAPTURE(t);
    REQUIRE(world.step(0.2));
    for (auto const& record : world.frame().agents) REQUIRE(record.state.speed >= 0.0);
    REQUIRE_FALSE(cb::CollisionAny{}.evaluate(world).any_collision);
  }
}

}  // namespace

#define BEHAVIORS_THAT_FOLLOW                                                                                       \
  cb::IdmClassic, cb::IdmLaneTracking, cb::AdaptiveCruiseControl, cb::IdmStochastic, cb::Mobil,                     \
      cb::LaneChangeRuleBased, cb::ZipMerge, cb::Intersection, cb::MacroActions, cb::RssConformant<cb::IdmClassic>, \
      cb::RssConformant<cb::Mobil>, cb::RssConformant<cb::IdmLaneTracking>

TEST_CASE_TEMPLATE("every behaviour that follows others stops before what stands in its lane", Behavior,
                   BEHAVIORS_THAT_FOLLOW) {
  auto world = three_before<Behavior>(200.0);
  drive(world, 60.0);
  double ahead = 200.0;
  for (auto const& record : world.frame().agents) {
    double const gap = ahead - (record.state.x + 3.6);
    CHECK(record.state.speed < 0.3);
    CHECK(gap > 0.0);
    CHECK(gap < 12.0);
    ahead = record.state.x - 0.9;
  }
}

TEST_CASE_TEMPLATE("every behaviour that follows others drives on once the way is free", Behavior,
                   BEHAVIORS_THAT_FOLLOW) {
  World<Behavior> world(straight_road(1, 500.0));
  auto const id = world.add({.position = {60.0, -1.75}, .speed = 12.0});
  auto const object = world.add_object(block(150.0));
  drive(world, 40.0);
  CHECK(world.state(id).speed < 0.3);
  world.remove_object(object);
  drive(world, 10.0);
  CHECK(world.state(id).speed > 5.0);
}

TEST_CASE_TEMPLATE("every behaviour plans in a prediction as in the world, and allocates nothing once warm", Behavior,
                   BEHAVIORS_THAT_FOLLOW, cb::ConstantAcceleration, cb::ExternalInput, cb::MotionPrimitives,
                   cb::RandomMacroActions, cb::Safety) {
  auto const start = three_before<Behavior>(300.0);
  auto world = start;
  using Set = cb::BehaviorSet<Behavior>;
  auto prediction = world.observe(static_cast<cb::AgentId>(1)).predict(cb::predict_all_as<Set>(Behavior{}));
  auto const begin = prediction;
  auto const run = [&] {
    prediction = begin;
    for (int k = 0; k < 60; ++k) prediction.step(0.2);
  };
  run();
  auto const first = prediction.frame();
  auto const before = support::allocations();
  run();
  CHECK(support::allocations() == before);
  CHECK(prediction.frame() == first);
  if constexpr (!std::is_same_v<Behavior, cb::IdmStochastic> && !std::is_same_v<Behavior, cb::RandomMacroActions>) {
    for (int k = 0; k < 60; ++k) world.step(0.2);  // where nothing is drawn, the prediction comes true
    for (std::size_t i = 0; i < world.size(); ++i) {
      CHECK(prediction.frame().agents[i].state.x == world.frame().agents[i].state.x);
      CHECK(prediction.frame().agents[i].state.speed == world.frame().agents[i].state.speed);
    }
  }
}
