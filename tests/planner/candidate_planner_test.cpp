// Laws of the planners that compare candidates.
#include "cambium/planner/candidate_planner.hpp"

#include "planner/planner_fixtures.hpp"

using namespace planner_fixtures;

namespace {

static_assert(BehaviorModel<Proposal> && BehaviorModel<PolicyTree> && BehaviorModel<Frenet>);

template <class Planner>
constexpr bool is_frenet = std::is_same_v<Planner, Frenet>;

}  // namespace

TEST_CASE_TEMPLATE("it follows a slower leader and stops behind a standing one", Planner, Proposal, PolicyTree,
                   Frenet) {
  for (double const slow : {0.0, 2.0, 4.0, 6.0, 8.0, 10.0}) {
    CAPTURE(slow);
    auto world = road(1, 10.0 + 0.5 * slow, Planner{});
    world.add({.position = {110, -1.75}, .speed = slow, .behavior = ConstantAcceleration{}});
    drive(world, 150);
    CHECK(std::abs(world.state(ego).speed - slow) < (is_frenet<Planner> ? 0.3 : 0.7));
    CHECK(world.state(AgentId{1}).x - world.state(ego).x < (is_frenet<Planner> ? 40.0 : 60.0));
    CHECK(std::abs(world.state(ego).y + 1.75) < 0.1);
  }
}

TEST_CASE_TEMPLATE("it stops at an object that blocks the road, and changes lanes at one that blocks its own", Planner,
                   Proposal, PolicyTree, Frenet) {
  for (int const lanes : {1, 2}) {
    CAPTURE(lanes);
    auto world = road(lanes, 12.0, Planner{});
    world.add_object(obstacle(150, 1.75 - 3.5 * lanes, -1.7, 1.7));
    drive(world, 150);
    CHECK((world.state(ego).x > 160.0) == (lanes == 2));
    if (lanes == 1) CHECK(world.state(ego).speed < 0.05);
    if (lanes == 1) CHECK(world.state(ego).x > 125.0);
  }
}

TEST_CASE_TEMPLATE("it passes an object that leaves room in its lane", Planner, Proposal, Frenet) {
  Planner planner;
  planner.offsets = {0.0, -0.8, 0.8};  // farther to the right it would leave the road
  for (double const side : {-1.0, 1.0}) {
    CAPTURE(side);
    auto world = road(1, 12.0, planner);
    world.add_object(side < 0.0 ? obstacle(140, -1.75, -1.75, -0.6) : obstacle(140, -1.75, 0.6, 1.75));
    double farthest = 0.0;
    for (int i = 0; i < 24; ++i) {
      drive(world, 5);
      farthest = std::max(farthest, -side * (world.state(ego).y + 1.75));
    }
    CHECK(world.state(ego).x > 180.0);
    CHECK(farthest > 0.3);
    CHECK(std::abs(world.state(ego).y + 1.75) < 0.2);  // and returns to the middle
  }
}

TEST_CASE_TEMPLATE("it brakes as hard as it may if nothing else is left, and reports the stop as it drives it", Planner,
                   Proposal, Frenet) {
  CandidateSim world = road(2, 20.0, Planner{});
  put(world, ego, [](auto& state) { state.y = -4.9, state.heading = 0.02; });
  world.add_object(obstacle(68, -3.5, -3.5, 3.5));
  auto const report = report_of(Planner{}, world);
  CHECK_FALSE(report.chosen);
  CHECK(report.decidedness == 0.0);
  CHECK(report.is_emergency(ego));
  CHECK(report.course.back().agents[0].state.speed == 0.0);
  for (auto const& frame : report.course) {  // it is where its state says
    auto const &now = frame.agents[0], &start = report.course[0].agents[0];
    CHECK(now.lane.s - start.lane.s == doctest::Approx(now.state.x - start.state.x));
    CHECK(now.action.acceleration <= 0.0);
  }
  REQUIRE(world.step(Planner{}.step));
  CHECK(world.record(ego).action.acceleration == doctest::Approx(-6.0));
  auto const planned = report.course[1].agents[0].state;
  CHECK(world.state(ego).x == doctest::Approx(planned.x));
  CHECK(world.state(ego).y == doctest::Approx(planned.y));
  CHECK(world.state(ego).heading == doctest::Approx(planned.heading));
  CHECK(world.memory<Planner>(ego) == report.memory);
  for (auto const& candidate : report.candidates) CHECK_FALSE(candidate.refused.empty());
}

TEST_CASE_TEMPLATE("it drives into no oncoming lane", Planner, Proposal, Frenet) {
  CandidateSim world(support::two_way_road(600.0));
  world.add({.position = {40, -1.75}, .speed = 12, .behavior = IdmClassic{}});
  Planner planner;
  planner.offsets = {0.0, 3.5};
  int refused = 0;
  auto const report = report_of(planner, world);
  for (std::size_t i = 0; i < report.candidates.size(); ++i) {
    if (report.details[i].offset == 0.0) continue;
    CHECK(report.chosen != i);
    refused += report.candidates[i].refused == "off road";
  }
  CHECK(refused > 0);
}

TEST_CASE("an empty list or an action that is not there is reported") {
  auto const is_refused = [](auto const& planner) {
    auto world = road(1, 12.0, IdmClassic{});
    CHECK_THROWS_AS(world.add({.position = {300, -1.75}, .behavior = planner}), ParameterError);
    CHECK_THROWS_AS((void)report_of(planner, world), ParameterError);
  };
  PolicyTree tree;
  tree.actions.actions.clear();
  is_refused(tree);
  Proposal proposal;
  proposal.offsets.clear();
  is_refused(proposal);
  Frenet frenet;
  frenet.durations.clear();
  is_refused(frenet);
  tree.actions = MacroActions::of({{MacroAction::Kind::change_left, 0.0, true}});  // there is one lane
  CHECK_THROWS_AS((void)report_of(tree, road(1, 12.0, IdmClassic{})), SearchError);
}
