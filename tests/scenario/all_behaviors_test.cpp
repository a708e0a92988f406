// Laws that hold for every shipped behaviour, whatever else it does.
#include <doctest/doctest.h>

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
constexpr bool draws = std::is_same_v<Behavior, cb::IdmStochastic> || std::is_same_v<Behavior, cb::RandomMacroActions>;

}  // namespace

TEST_CASE_TEMPLATE("every behaviour can predict, allocates nothing once warm, and where it draws nothing comes true",
                   Behavior, cb::IdmClassic, cb::IdmLaneTracking, cb::AdaptiveCruiseControl, cb::IdmStochastic,
                   cb::Mobil, cb::LaneChangeRuleBased, cb::ZipMerge, cb::Intersection,
                   cb::RssConformant<cb::IdmClassic>, cb::RssConformant<cb::Mobil>, cb::Safety,
                   cb::ConstantAcceleration, cb::ExternalInput, cb::MotionPrimitives, cb::MacroActions,
                   cb::RandomMacroActions, cb::IdmHypotheses, cb::IdmProposal) {
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
