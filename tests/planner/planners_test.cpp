// Laws that hold for every planner that simulates or samples courses.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>

#include "cambium/behavior/following/idm_classic.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/observer/parametric.hpp"
#include "cambium/planner/frenet/frenet_planner.hpp"
#include "cambium/planner/planner_model.hpp"
#include "cambium/planner/policy/policy_tree_planner.hpp"
#include "cambium/planner/policy/proposal_planner.hpp"
#include "cambium/world/world.hpp"
#include "support/maps.hpp"

using namespace cambium;

namespace {

using PredictionWorld =
    World<BehaviorSet<MacroActions, IdmProposal, IdmClassic, ConstantAcceleration>, InterpolateExecution, SingleTrack>;

template <class Planner, class Observer = PerfectObserver>
using Sim = World<BehaviorSet<Planner, IdmClassic>, InterpolateExecution, SingleTrack, Observer>;

constexpr AgentId ego{0};

/// On two lanes of a wide bend: ego on the right one, six others about it.
template <class World, class Planner>
World traffic(std::uint64_t seed, Planner const& planner, typename World::Observer const& observer = {}) {
  constexpr double curvature = 0.004, radius = 1.0 / curvature;
  World world(support::straight_road(2, 900.0, curvature), {.seed = seed});
  auto const place = [&](double s, double lateral) {
    double const turn = s * curvature, r = radius - lateral;
    return geometry::Point(r * std::sin(turn), radius - r * std::cos(turn));
  };
  RandomStream random(seed, 0, 0);
  world.add({.position = place(80, -5.25), .speed = 11.0, .behavior = planner, .observer = observer});
  for (int i = 0; i < 6; ++i) {
    double const desired = Uniform{6.0, 15.0}(random), s = 20.0 + 40.0 * (i / 2) + Uniform{0.0, 12.0}(random);
    world.add({.position = place(i % 2 == 0 ? s : s + (s > 70.0 ? 25.0 : 0.0), i % 2 == 0 ? -1.75 : -5.25),
               .speed = 0.8 * desired,
               .behavior = IdmClassic{.desired_speed = desired}});
  }
  return world;
}

template <class Planner>
constexpr bool is_planner = PlannerModel<Planner, typename Sim<Planner>::View>;
static_assert(is_planner<FrenetPlanner<PredictionWorld>> && is_planner<PolicyTreePlanner<PredictionWorld>> &&
              is_planner<ProposalPlanner<PredictionWorld>>);

}  // namespace

TEST_CASE_TEMPLATE("in random traffic it hits nobody, stays on the road and gets on, whatever the step", Planner,
                   ProposalPlanner<PredictionWorld>, PolicyTreePlanner<PredictionWorld>,
                   FrenetPlanner<PredictionWorld>) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    CAPTURE(seed);
    double const dt = seed % 3 == 0 ? 0.1 : seed % 3 == 1 ? 0.2 : 0.5;
    auto world = traffic<Sim<Planner>>(seed, Planner{});
    double way = 0.0;
    for (int i = 0; i < std::lround(25.0 / dt); ++i) {
      REQUIRE(world.step(dt));
      REQUIRE_FALSE(AnyCollision{}(world));
      REQUIRE_FALSE(OffRoad{}(world, world.slot_of(ego)));
      way += world.state(ego).speed * dt;
    }
    CHECK(way > 100.0);
  }
}

TEST_CASE_TEMPLATE("it can be what a prediction assumes, of itself and of others, and then comes true", Planner,
                   ProposalPlanner<PredictionWorld>, PolicyTreePlanner<PredictionWorld>,
                   FrenetPlanner<PredictionWorld>) {
  auto world = traffic<Sim<Planner>>(1, Planner{});
  using Set = typename Sim<Planner>::Behaviors;
  for (auto const& agent : world.roster().agents) world.set_behavior(agent.id, Planner{});
  auto prediction = world.observe(ego).predict(predict_all_as<Set>(Planner{}));
  for (int i = 0; i < 10; ++i) {
    REQUIRE(world.step(0.2));
    REQUIRE(prediction.step(0.2));
  }
  for (std::size_t i = 0; i < world.size(); ++i)
    CHECK(world.frame().agents[i].state == prediction.frame().agents[i].state);
}

TEST_CASE_TEMPLATE("where it sees with noise it plans all the same", Planner, ProposalPlanner<PredictionWorld>,
                   PolicyTreePlanner<PredictionWorld>, FrenetPlanner<PredictionWorld>) {
  ObservationNoise const noise{.along = 0.2, .across = 0.05, .heading = 0.01, .speed = 0.2};
  auto world = traffic<Sim<Planner, ParametricObserver>>(2, Planner{}, {.own = noise, .others = noise});
  for (int i = 0; i < 50; ++i) {
    REQUIRE(world.step(0.2));
    REQUIRE_FALSE(Collision{}(world, world.slot_of(ego)));
  }
  CHECK(world.state(ego).speed > 2.0);
}
