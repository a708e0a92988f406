#include "cambium/planner/policy/policy_tree_planner.hpp"

#include <numeric>
#include <set>
#include <vector>

#include "planner/planner_fixtures.hpp"

using namespace planner_fixtures;

TEST_CASE("the tree has each sequence with at most one change exactly once") {
  for (std::size_t const actions : {1u, 2u, 9u})
    for (std::size_t const layers : {1u, 2u, 5u})
      for (std::uint8_t ongoing = 0; ongoing < actions; ++ongoing) {
        std::vector<std::uint8_t> choices(actions);
        std::iota(choices.begin(), choices.end(), std::uint8_t{0});
        auto const sequences = policy_sequences(choices, ongoing, layers);
        CHECK(sequences.size() == (actions - 1) * layers + 1);
        std::set<std::vector<std::size_t>> spelled;
        for (auto const& s : sequences) {
          std::vector<std::size_t> word;
          for (std::size_t layer = 0; layer < layers; ++layer)
            word.push_back(layer < s.layers_of_first ? s.first : s.then);
          CHECK((word[0] == ongoing || std::ranges::count(word, word[0]) == static_cast<std::ptrdiff_t>(layers)));
          spelled.insert(word);
        }
        CHECK(spelled.size() == sequences.size());
        CHECK(sequences[0].first == ongoing);
      }
}

TEST_CASE("the probability of a lane change follows from the lateral speed by Bayes' rule") {
  IntentionPrior const prior;
  auto const still = change_probabilities(prior, 0.0);
  CHECK(still.left == still.right);
  CHECK(still.left < prior.change);
  CHECK(change_probabilities(prior, 0.8).left > 0.5);
  CHECK(change_probabilities(prior, 0.8).right < 1e-6);
  CHECK(change_probabilities(prior, 100.0).left == doctest::Approx(1.0));
  for (double v = -2.0; v < 2.0; v += 0.1) {
    auto const p = change_probabilities(prior, v), mirrored = change_probabilities(prior, -v);
    CHECK(p.left == mirrored.right);
    CHECK(p.left + p.right <= 1.0);
    CHECK(change_probabilities(prior, v + 0.05).left >= p.left);
  }
}

TEST_CASE("before an object that appears close ahead, it stops hard and reports an emergency") {
  auto world = road(1, 14.0, PolicyTree{});
  CHECK_FALSE(report_of(PolicyTree{}, world).is_emergency(ego));
  double const x = world.state(ego).x + 22.0;  // a stop at 5 m/s^2, the hardest by car following, is too long
  world.add_object(obstacle(x, -1.75, -1.65, 1.65));
  auto const report = report_of(PolicyTree{}, world);
  CHECK(report.is_emergency(ego, 5.5));
  CHECK_FALSE(report.is_emergency(AgentId{99}));
  drive(world, 40);
  CHECK(world.state(ego).speed < 0.1);
}

TEST_CASE("branches are simulated under the intentions that matter to them") {
  auto world = road(2, 12.0, PolicyTree{});
  world.add({.position = {52, -1.75}, .speed = 11, .behavior = ConstantAcceleration{}});  // may cut in
  world.add({.position = {28, -1.75}, .speed = 13, .behavior = ConstantAcceleration{}});  // may not yield
  auto const report = report_of(PolicyTree{}, world);
  REQUIRE(report.intentions.size() == 2);
  CHECK(report.intentions[0].intention == Intention::change_right);
  CHECK(report.intentions[1].intention == Intention::not_yield);
  auto const kind = [](std::size_t action) { return PolicyTree{}.actions.actions[action].kind; };
  int changes = 0;
  for (auto const& branch : report.details) {
    bool const left = kind(branch.sequence.first) == MacroAction::Kind::change_left ||
                      kind(branch.sequence.then) == MacroAction::Kind::change_left;
    changes += left ? 1 : 0;
    CHECK(branch.scenarios == (left ? 3 : 2));
    CHECK(branch.worst >= branch.expected);
    CHECK(branch.cost >= branch.expected);
    CHECK(branch.cost >= report.details[*report.chosen].cost);
    CHECK(kind(branch.sequence.first) != MacroAction::Kind::change_right);  // there is no lane on the right
  }
  CHECK(changes > 10);
}

TEST_CASE("it expects a vehicle that is cutting in and lets it in") {
  auto const speed_beside = [](double heading) {
    auto world = road(2, 12.0, PolicyTree{});
    world.add({.position = {54, -2.6}, .heading = heading, .speed = 9, .behavior = ConstantAcceleration{}});
    auto const report = report_of(PolicyTree{}, world);
    REQUIRE(report.intentions.size() == 1);
    CHECK((report.intentions[0].probability > 0.5) == (heading < 0.0));
    return report.course[10].agents[0].state.speed;
  };
  CHECK(speed_beside(-0.09) < speed_beside(0.0) - 0.5);
}

TEST_CASE("it overtakes a slower leader and does not dither") {
  for (double const slow : {3.0, 5.0, 7.0}) {
    auto world = road(2, 12.0, PolicyTree{});
    auto const leader = world.add({.position = {90, -5.25}, .speed = slow, .behavior = ConstantAcceleration{}});
    int turns = 0, last = 0;
    for (int i = 0; i < 75; ++i) {
      double const before = world.state(ego).y;
      drive(world, 1);
      double const aside = world.state(ego).y - before;
      int const side = aside > 0.05 ? 1 : aside < -0.05 ? -1 : last;
      turns += side != last;
      last = side;
    }
    CAPTURE(slow);
    CHECK(world.state(ego).x > world.state(leader).x + 10.0);
    CHECK(turns <= 2);  // to the left, and perhaps back
  }
}

TEST_CASE("a lane change into the outermost lane remains available until it is completed") {
  auto world = road(2, 12.0, PolicyTree{});
  world.add({.position = {90, -5.25}, .speed = 5, .behavior = ConstantAcceleration{}});
  int crossing = 0;
  for (int i = 0; i < 40; ++i) {
    drive(world, 1);
    auto const& memory = world.memory<PolicyTree>(ego);
    bool const has_crossed = world.state(ego).y > -3.5 && world.state(ego).y < -2.0;
    if (!has_crossed || !memory.change.active() || memory.is_new) continue;
    auto const report = report_of(PolicyTree{}, world, memory);
    auto const& first = report.details.front().sequence;
    CHECK(first.first == memory.chosen);
    CHECK(first.then == memory.chosen);
    ++crossing;
  }
  CHECK(crossing > 0);
}

TEST_CASE("the weight of the worst case decides which risk is taken") {
  // Ego is behind a slow vehicle; a faster one approaches on the left.
  auto const best_changes = [](double not_yield, double worst_case, double least_odds = 0.0) {
    auto world = road(2, 10.0, PolicyTree{});
    world.add({.position = {80, -5.25}, .speed = 6, .behavior = ConstantAcceleration{}});
    world.add({.position = {26, -1.75}, .speed = 13, .behavior = ConstantAcceleration{}});
    PolicyTree planner;
    planner.intentions.not_yield = not_yield;
    planner.weights.worst_case = worst_case;
    planner.weights.least_odds = least_odds;
    planner.weights.reaction_time = 0.0;  // small gaps are safe, collisions are not
    planner.weights.braking = 50.0;
    planner.weights.courtesy = planner.weights.clearance = 0.0;
    planner.actions.safe_deceleration = 50.0;
    auto const report = report_of(planner, world);
    return report.candidates[*report.chosen].name.starts_with("change_left");
  };
  CHECK(best_changes(0.0, 0.0));
  CHECK(best_changes(0.0005, 0.0));
  CHECK_FALSE(best_changes(0.0005, 1.0));
  CHECK(best_changes(0.0005, 1.0, 0.001));
  CHECK_FALSE(best_changes(0.9, 0.0));
}
