#include "cambium/observer/perfect.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "observed_traffic.hpp"
#include "cambium/behavior/wrap/idm_stochastic.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/actions/idm_proposal.hpp"
#include "cambium/behavior/pedestrian/pedestrian.hpp"
#include "cambium/behavior/wrap/rss_conformant.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/observer/parametric.hpp"

using namespace fixtures;
using cb::AgentId;

namespace {

/// Misjudges the others' places and speeds; knows its own.
struct Blurred {
  static constexpr bool perfect = false;
  double deviation = 0.3;

  template <cb::MotionState S>
  [[nodiscard]] S observe(S const& truth, bool own, cb::RandomStream random) const {
    if (own) return truth;
    cb::Normal const error{0.0, deviation};
    S seen = truth;
    seen.x += error(random);
    seen.y += error(random);
    seen.speed = std::max(0.0, seen.speed + error(random));
    return seen;
  }
};
static_assert(cb::ObserverModel<Blurred>);

/// Believes to be 1 m further east and 0.25 m further north than it is; sees the others as they are.
struct Misplaced {
  static constexpr bool perfect = false;

  template <cb::MotionState S>
  [[nodiscard]] S observe(S truth, bool own, cb::RandomStream const&) const {
    if (!own) return truth;
    truth.x += 1.0;
    truth.y += 0.25;
    return truth;
  }
};

using Noisy = Observed<Blurred>;

template <class World>
double largest_error(World& world, AgentId id) {
  double largest = 0;
  for (auto const& [other, state] : seen_by(world, id))
    largest = std::max(largest, std::hypot(state.x - world.state(other).x, state.y - world.state(other).y));
  return largest;
}

}  // namespace

TEST_CASE("a perfect observer sees the truth itself, not a copy of it") {
  auto world = traffic(cb::PerfectObserver{});
  CHECK(&world.observe(traffic_ego).state() == &world.state(traffic_ego));
  auto const seen = seen_by(world, traffic_ego);
  CHECK(seen.size() == 7);
  for (auto const& [id, state] : seen) CHECK(state == world.state(id));
}

TEST_CASE(
    "a view shows the others as the agent's observer has them, the agent itself as it is, and leaves the truth alone") {
  auto world = traffic(Blurred{});
  auto const truth = world.frame();
  auto const seen = seen_by(world, traffic_ego);
  CHECK(seen.size() == 7);
  for (auto const& [id, state] : seen) {
    CHECK(state != world.state(id));
    CHECK(std::hypot(state.x - world.state(id).x, state.y - world.state(id).y) < 2.0);
  }
  CHECK(world.observe(traffic_ego).state() == world.state(traffic_ego));
  CHECK(world.frame() == truth);
  auto const front = world.observe(traffic_ego).ahead();
  REQUIRE(front.has_value());
  CHECK(front->speed == seen.at(front->agent).speed);
  auto const& own = world.state(traffic_ego);
  CHECK(front->gap == doctest::Approx(seen.at(front->agent).x - own.x - 3.6 - 0.9));
  auto const rear = world.observe(traffic_ego).behind();
  REQUIRE(rear.has_value());
  CHECK(rear->gap == doctest::Approx(own.x - seen.at(rear->agent).x - 3.6 - 0.9));
}

TEST_CASE("an agent that errs about itself errs about its lane position and its gaps alike") {
  Observed<Misplaced> world(straight_road(2, 1000.0));
  auto const ego = world.add({.position = {100, -1.75}, .speed = 10});
  world.add({.position = {130, -1.75}, .speed = 10});
  world.add({.position = {80, -1.75}, .speed = 10});
  world.add_object(cb::geometry::Polygon({{150, -6}, {151, -6}, {151, -4.5}, {150, -4.5}}));
  auto const view = world.observe(ego);
  CHECK(view.place().s == doctest::Approx(101.0));
  CHECK(view.place().lateral == doctest::Approx(0.25));
  CHECK(view.ahead()->gap == doctest::Approx(30 - 4.5 - 1.0));
  CHECK(view.behind()->gap == doctest::Approx(20 - 4.5 + 1.0));
  auto const beside = static_cast<cb::CorridorId>(1 - index_of(view.place().corridor));
  CHECK(view.ahead(view.place(beside))->gap == doctest::Approx(50 - 3.6 - 1.0));
}

TEST_CASE(
    "errors are an agent's own: the same when it looks again, others for another agent, another step and another "
    "seed") {
  auto world = traffic(Blurred{}), other_seed = traffic(Blurred{}, 2);
  auto const first = seen_by(world, traffic_ego);
  CHECK(seen_by(world, traffic_ego) == first);
  Noisy copy = world;
  CHECK(seen_by(copy, traffic_ego) == first);
  CHECK(seen_by(other_seed, traffic_ego) != first);
  AgentId const another = static_cast<AgentId>(5), both_see = static_cast<AgentId>(0),
                neighbor = static_cast<AgentId>(1);
  CHECK(first.at(both_see).x - world.state(both_see).x !=
        doctest::Approx(first.at(neighbor).x - world.state(neighbor).x));
  CHECK(seen_by(world, another).at(both_see) != first.at(both_see));
  REQUIRE(world.step(0.2));
  auto const before = first.at(both_see).x - 100.0,
             after = seen_by(world, traffic_ego).at(both_see).x - world.state(both_see).x;
  CHECK(before != doctest::Approx(after));
}

TEST_CASE("a prediction begins with what the agent sees, and goes on without errors") {
  auto world = traffic(Blurred{});
  auto const seen = seen_by(world, traffic_ego);
  auto future = world.observe(traffic_ego).predict(cb::predict_all_as<Noisy::Behaviors>(cb::ConstantAcceleration{}));
  CHECK(future.state(traffic_ego) == world.state(traffic_ego));
  for (auto const& [id, state] : seen) {
    CHECK(future.state(id) == state);
    auto const& at = future.record(id).lane;
    CHECK(at.s == doctest::Approx(state.x));
    CHECK(at.lateral == doctest::Approx(state.y - (at.corridor == cb::CorridorId{} ? -1.75 : -5.25)));
  }
  CHECK(largest_error(future, traffic_ego) == 0.0);
  REQUIRE(future.step(0.5));
  for (auto const& [id, state] : seen) CHECK(future.state(id).x == doctest::Approx(state.x + 0.5 * state.speed));
}

TEST_CASE("each agent of a world has an observer of its own") {
  Noisy world(straight_road(2, 1000.0), {.seed = 3});
  auto const sharp = world.add({.position = {100, -1.75}, .observer = {.deviation = 0.0}});
  auto const blurred = world.add({.position = {150, -1.75}, .observer = {.deviation = 1.0}});
  CHECK(seen_by(world, sharp).at(blurred) == world.state(blurred));
  CHECK(seen_by(world, blurred).at(sharp) != world.state(sharp));
}

TEST_CASE("traffic with noisy observers drives on") {
  auto world = traffic(Blurred{});
  for (int i = 0; i < 50; ++i) CHECK(world.step(0.2));
  for (auto const& record : world.frame().agents) CHECK(record.status == cb::AgentStatus::driving);
}

TEST_CASE_TEMPLATE("every kind of behaviour plans behind an observer that errs", Behavior, cb::Pedestrian,
                   cb::RssConformant<cb::Mobil>, cb::IdmProposal, cb::Intersection, cb::ZipMerge, cb::IdmStochastic) {
  cb::World<cb::BehaviorSet<Behavior>, cb::InterpolateExecution, cb::SingleTrack, cb::ParametricObserver> world(
      straight_road(2, 500.0), {.seed = 3});
  for (int i = 0; i < 6; ++i)
    world.add({.position = {40.0 + 20.0 * i, i % 2 == 0 ? -1.75 : -5.25}, .speed = 8.0 + i, .behavior = Behavior{}});
  for (int k = 0; k < 50; ++k) REQUIRE(world.step(0.2));
}
