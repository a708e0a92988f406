#include "cambium/planner/search/tree_search.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "cambium/planner/mcts/belief.hpp"
#include "cambium/planner/search/exp3.hpp"
#include "cambium/planner/search/parallel_tree_search.hpp"
#include "cambium/planner/search/puct.hpp"
#include "cambium/planner/search/regret_matching.hpp"
#include "cambium/planner/search/tree_export.hpp"
#include "planner/games.hpp"
#include "support/allocations.hpp"

using namespace cambium;
using namespace games;

namespace {

template <class Selection>
auto solve(MatrixGame const& game, std::size_t iterations, std::uint64_t seed, Selection selection = {}) {
  TreeSearch<MatrixGame, Selection, NoRollout> search(game, {.horizon = 1}, selection, {}, {iterations});
  return search.run({}, seed);
}

}  // namespace

TEST_CASE("regret matching and Exp3 play the mixed equilibria of matrix games") {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    auto const check = [](auto const& result, double row, double column, double tolerance) {
      CHECK(std::abs(result.of(0)[0].share - row) < tolerance);
      CHECK(std::abs(result.of(1)[0].share - column) < tolerance);
    };
    check(solve<RegretMatching>(matching_pennies, 20'000, seed), 0.5, 0.5, 0.05);
    check(solve<RegretMatching>(uneven, 200'000, seed, RegretMatching{0.02}), 0.4, 0.2, 0.05);
    check(solve<Exp3>(matching_pennies, 50'000, seed, Exp3{0.05}), 0.5, 0.5, 0.08);
    check(solve<Exp3>(uneven, 200'000, seed, Exp3{0.05}), 0.4, 0.2, 0.08);
    auto const rock = solve<RegretMatching>(rock_paper_scissors, 50'000, seed);
    for (auto const& arm : rock.of(0)) CHECK(std::abs(arm.share - 1.0 / 3) < 0.05);
  }
}

TEST_CASE_TEMPLATE("a dominant action is played nearly always", Selection, RegretMatching, Exp3) {
  MatrixGame const dominated{2, 2, {{{0.2, 0.4}, {0.6, 0.8}}}};  // the second row and the first column
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    auto const result = solve<Selection>(dominated, 20'000, seed, Selection{0.05});
    CHECK(result.of(0)[1].share > 0.9);
    CHECK(result.of(1)[0].share > 0.9);
  }
}

TEST_CASE_TEMPLATE("searches play noughts and crosses perfectly", Selection, Ucb1, Ucb1Tuned, Puct, RegretMatching) {
  RandomStream random(3, 0, 0);
  TicTacToe const game;
  for (int position = 0; position < 30; ++position) {
    TicTacToe::State state;
    std::array<int, 9> moves{};
    for (int i = 0; i < 2 + position % 5 && !game.is_terminal(state); ++i) {
      auto const count = game.actions(state, static_cast<std::size_t>(state.moves % 2), moves);
      game.move(state, moves[uniform_index(random, static_cast<std::uint32_t>(count))]);
    }
    if (game.is_terminal(state)) continue;
    Selection selection;
    if constexpr (std::is_same_v<Selection, Puct>) selection.exploration = 6.0;  // a game without priors
    TreeSearch<TicTacToe, Selection> search(game, {.horizon = 9, .discount = 1.0}, selection, {}, {20'000});
    auto const mover = static_cast<std::size_t>(state.moves % 2);
    auto next = state;
    game.move(next, search.run(state, 1).choice(mover).action);
    CAPTURE(position);
    CHECK(TicTacToe::solution(next) == TicTacToe::solution(state));
  }
}

TEST_CASE("the values of a grid world match value iteration") {
  for (GridWorld::State const from : {GridWorld::State{2, 2}, {2, 1}, {1, 2}, {2, 0}, {0, 2}}) {
    TreeSearchParameters const parameters{.horizon = 60, .discount = 0.95};
    TreeSearch<GridWorld> search({}, parameters, {}, {}, {200'000});
    auto const& result = search.run(from, 5);
    double best = -1e9;
    for (int a = 0; a < 4; ++a) best = std::max(best, GridWorld::solution(from, a, 0.95));
    CAPTURE(from.x);
    CAPTURE(from.y);
    CHECK(GridWorld::solution(from, result.choice(0).action, 0.95) == doctest::Approx(best).epsilon(0.02));
    CHECK(result.choice(0).mean_return == doctest::Approx(best).epsilon(0.1));
  }
}

namespace {

/// Either 0.5 for sure, or 1 with a probability of 70 %.
struct Gamble : Solo<2> {
  bool step(State& s, std::span<int const> a, RandomStream& random, std::span<AgentOutcome> out) const {
    s = uniform01(random) < 0.7;
    out[0].reward = a[0] == 0 ? 0.5 : s;
    return true;
  }
};

}  // namespace

TEST_CASE("one unlucky outcome does not decide the value of an action") {
  int wrong = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    TreeSearch<Gamble> search({}, {.horizon = 1}, {}, {}, {1000});
    wrong += search.run(0, seed).choice(0).action != 1;
  }
  CHECK(wrong <= 10);
}

TEST_CASE("ego crosses if the others keep their gap") {
  int reached = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Crossing const game{2};
    TreeSearch<Crossing> search(game, {.horizon = 12, .discount = 0.9}, {}, {}, {2000});
    Crossing::State state;
    for (std::uint32_t step = 0; step < 30 && !state.over; ++step) {
      Crossing::Action const action = search.run(state, seed).choice(0).action;
      RandomStream random(seed, 1, step);
      std::array<AgentOutcome, 1> outcome{};
      (void)game.step(state, {&action, 1}, random, outcome);
      reached += outcome[0].reward > 0.0;
    }
  }
  CHECK(reached == 20);
}

TEST_CASE("a search is a function of state, parameters and seed and does not allocate once warm") {
  Crossing const game{3};
  TreeSearch<Crossing> search(game, {.horizon = 12}, {}, {}, {3000});
  auto const first = search.run({}, 7);
  auto const before = support::allocations();
  auto const& again = search.run({}, 7);
  CHECK(support::allocations() == before);
  TreeSearch<Crossing> other(game, {.horizon = 12}, {}, {}, {3000});
  CHECK(first.iterations == 3000);
  check_equal(again, first);
  check_equal(other.run({}, 7), first);
  CHECK(other.run({}, 8).depths != first.depths);
  auto const warm = support::allocations();
  for (std::uint64_t seed = 9; seed < 60; ++seed) (void)other.run({}, seed);
  CHECK(support::allocations() == warm);
}

TEST_CASE("a search continues on a tree that cannot grow") {
  Crossing const game{2};
  TreeSearch<Crossing> small(game, {.horizon = 12, .memory = 20'000}, {}, {}, {5000});
  TreeSearch<Crossing> large(game, {.horizon = 12}, {}, {}, {5000});
  auto const& result = small.run({}, 1);
  CHECK(result.is_full);
  CHECK(result.iterations == 5000);
  CHECK(result.nodes > 10);
  CHECK(result.nodes * sizeof(Crossing::State) < 20'000);
  CHECK(result.choice(0).action == large.run({}, 1).choice(0).action);
  CHECK_FALSE(large.result().is_full);
}

namespace {

/// An `IterationBudget` for which the tree reserves little memory at first.
struct GrowingBudget : IterationBudget {
  std::size_t expected() const { return 2; }
  GrowingBudget part(std::size_t i, std::size_t n) const { return {IterationBudget::part(i, n)}; }
};

}  // namespace

TEST_CASE("a tree that grows on demand equals one that had room from the start") {
  Crossing const game{2};
  TreeSearch<Crossing> ready(game, {.horizon = 12}, {}, {}, {5000});
  TreeSearch<Crossing, Ucb1, RandomRollout, GrowingBudget> growing(game, {.horizon = 12}, {}, {}, {{5000}});
  for (std::uint64_t seed = 1; seed < 4; ++seed) check_equal(ready.run({}, seed), growing.run({}, seed));
}

TEST_CASE("a search with little time does one iteration, and does not spend it on reserving a million nodes") {
  auto const before = support::allocated_bytes();
  TreeSearch<TicTacToe, Ucb1, RandomRollout, TimeBudget> search({}, {.horizon = 9}, {}, {}, {.duration = 1e-6});
  CHECK(search.run({}, 1).iterations >= 1);
  CHECK(search.result().iterations < 64);
  CHECK(support::allocated_bytes() - before < 1'000'000);
}

TEST_CASE("a tree has its root with all arms, however little memory it gets") {
  for (std::size_t memory = 4096; memory < 9000; memory += 64) {
    TreeSearch<TicTacToe> search({}, {.horizon = 9, .memory = memory}, {}, {}, {300});
    auto const& result = search.run({}, 1);
    CHECK(result.iterations == 300);
    CHECK(result.of(0).size() == 9);
    CHECK(result.variation.size() >= 2);
    CHECK(result.variation.size() % 2 == 0);
  }
  struct Large : Crossing {
    std::size_t heap_bytes(State const&) const { return 100'000; }
  };
  TreeSearch<Large> search({}, {.horizon = 5, .memory = 4096}, {}, {}, {50});
  CHECK(search.run({}, 1).of(0).size() == 4);
  CHECK(search.result().nodes == 1);
}

TEST_CASE("a kept tree is continued if it still holds, else dropped") {
  TicTacToe const game;
  TreeSearch<TicTacToe> search(game, {.horizon = 9, .discount = 1.0}, {}, {}, {5000});
  TicTacToe::State state;
  auto const result = search.run(state, 1);
  auto const move = result.choice(0).action;
  auto const visits = result.choice(0).visits;
  REQUIRE(search.keep(game.joint(state, move)));
  game.move(state, move);
  auto const& next = search.run(state, 2);
  CHECK(next.kept_nodes > 100);
  CHECK(next.nodes > next.kept_nodes);
  CHECK(detail::total_visits(next.of(1)) == visits - 1 + 5000);  // the first visit made the node
  // All its moves are legal here: the tree belongs to this position, not to the one before.
  for (auto const& arm : next.of(1)) CHECK(state.board[static_cast<std::size_t>(arm.action)] == 0);
  REQUIRE(search.keep(std::array<int, 2>{-1, next.choice(1).action}));
  CHECK(search.run({}, 3).kept_nodes == 0);
  CHECK_FALSE(search.keep(std::array<int, 2>{-1, -1}));
  CHECK_FALSE(search.keep(std::array<int, 1>{0}));
}

TEST_CASE("the outcome that came true is kept among several of the same actions, and may grow") {
  TreeSearch<Crossing> search(Crossing{2}, {.horizon = 12}, {}, {}, {1900});
  int most_visited = 0;
  for (std::size_t outcome = 0;; ++outcome) {
    auto const action = search.run({}, 1).choice(0).action;
    auto const& tree = search.tree();
    auto const arm = static_cast<std::uint16_t>(search.result().best[0]);
    std::vector<std::uint32_t> nodes;
    for (auto n = tree.find(0, {&arm, 1}); n != detail::no_node; n = tree.node(n).next_outcome) nodes.push_back(n);
    REQUIRE(nodes.size() > 2);
    if (outcome == nodes.size()) break;
    auto const visits = tree.node(nodes[outcome]).visits;
    auto const state = tree.state(nodes[outcome]);
    most_visited += std::ranges::all_of(nodes, [&](auto n) { return tree.node(n).visits <= visits; }) ? 1 : 0;
    REQUIRE(search.keep(std::array{action}));
    auto const& next = search.run(state, 2);
    CHECK(next.kept_nodes > 10);
    CHECK(next.iterations == 1900);
    CHECK(search.tree().state(0) == state);
    CHECK(detail::total_visits(next.of(0)) == visits - 1 + 1900);
  }
  CHECK(most_visited == 1);
  REQUIRE(search.keep(std::array{search.result().choice(0).action}));
  Crossing::State other;
  other.ego.x = 9;
  CHECK(search.run(other, 2).kept_nodes == 0);
}

TEST_CASE("parallel trees each keep their own subtree") {
  ParallelTreeSearch parallel(TreeSearch<TicTacToe>({}, {.horizon = 9}, {}, {}, {3000}), 3);
  TicTacToe::State state;
  auto const move = parallel.run(state, 1).choice(0).action;
  REQUIRE(parallel.keep(TicTacToe::joint(state, move)));
  TicTacToe{}.move(state, move);
  auto const kept = parallel.run(state, 2).kept_nodes;
  CHECK(kept > 100);
  std::size_t sum = 0;
  for (auto const& each : parallel.searches()) {
    CHECK(each.result().kept_nodes > 0);
    sum += each.result().kept_nodes;
  }
  CHECK(sum == kept);
}

TEST_CASE("the variation of parallel trees is that of the tree which visited their choice most") {
  int agree = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    ParallelTreeSearch parallel(TreeSearch<TicTacToe>({}, {.horizon = 9}, {}, {}, {60}), 3);
    auto const& result = parallel.run({}, seed);
    std::uint32_t most = 0;
    std::vector<TicTacToe::Action> expected{result.choice(0).action, result.choice(1).action};
    for (auto const& search : parallel.searches()) {
      auto const& own = search.result();
      bool const agrees =
          own.choice(0).action == result.choice(0).action && own.choice(1).action == result.choice(1).action;
      if (!agrees || own.choice(0).visits <= most) continue;
      most = own.choice(0).visits;
      expected = own.variation;
    }
    agree += most > 0 ? 1 : 0;
    CHECK(result.variation == expected);
  }
  CHECK(agree > 5);
}

TEST_CASE("a tree reserves no more than its memory limit") {
  for (std::size_t const memory : {std::size_t{1} << 16, std::size_t{1} << 20, std::size_t{5} << 20}) {
    CAPTURE(memory);
    TreeSearch<TicTacToe> search({}, {.horizon = 9, .memory = memory}, {}, {}, {200'000});
    auto const before = support::allocated_bytes();
    auto const& result = search.run({}, 1);
    CHECK(support::allocated_bytes() - before <= memory + 4096);  // plus the working memory of a run
    CHECK(result.is_full);
    CHECK(result.nodes > memory / 1500);
  }
}

namespace {

/// Plays the first `moves` of a game against itself and keeps the tree in between. Returns how many nodes were kept.
std::size_t play_on(TreeSearch<TicTacToe>& search, std::uint64_t moves) {
  TicTacToe::State state;
  std::size_t kept = 0;
  for (std::uint64_t move = 0; move < moves; ++move) {
    auto const& result = search.run(state, move);
    kept += result.kept_nodes;
    auto const place = result.choice(move % 2).action;
    REQUIRE(search.keep(TicTacToe::joint(state, place)));
    TicTacToe{}.move(state, place);
  }
  return kept;
}

}  // namespace

TEST_CASE("a tree kept from move to move reserves no more than its memory limit") {
  for (std::size_t const memory : {std::size_t{1} << 16, std::size_t{1} << 20}) {
    CAPTURE(memory);
    TreeSearch<TicTacToe> search({}, {.horizon = 9, .memory = memory}, {}, {}, {50'000});
    auto const before = support::allocated_bytes();
    CHECK(play_on(search, 3) > 10);
    CHECK(support::allocated_bytes() - before <= memory + 4096);
    if (memory < 100'000) CHECK(search.result().is_full);
  }
}

TEST_CASE("warm searches with kept trees do not allocate") {
  TreeSearch<TicTacToe> search({}, {.horizon = 9}, {}, {}, {2000});
  std::uint64_t counted = 0;
  for (int round = 0; round < 3; ++round) {
    auto const before = support::allocations();
    (void)play_on(search, 4);
    counted = support::allocations() - before;
  }
  CHECK(counted == 0);
}

TEST_CASE("parallel trees are merged by visits, with the same result on every run") {
  Crossing const game{2};
  TreeSearch<Crossing> const search(game, {.horizon = 12}, {}, {}, {4000});
  ParallelTreeSearch<TreeSearch<Crossing>> parallel(search, 3);
  auto const first = parallel.run({}, 5);
  CHECK(first.iterations == 4000);  // the trees share the budget
  std::array<std::uint32_t, 4> visits{};
  double total = 0.0;
  for (auto const& each : parallel.searches())
    for (std::size_t i = 0; i < 4; ++i) {
      visits[i] += each.result().of(0)[i].visits;
      total += each.result().of(0)[i].visits * each.result().of(0)[i].mean_return;
    }
  double merged = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(first.of(0)[i].visits == visits[i]);
    merged += first.of(0)[i].visits * first.of(0)[i].mean_return;
  }
  CHECK(merged == doctest::Approx(total));
  CHECK(parallel.searches()[0].result().depths != parallel.searches()[1].result().depths);
  auto const& again = parallel.run({}, 5);
  for (std::size_t i = 0; i < 4; ++i) CHECK(again.of(0)[i].mean_return == first.of(0)[i].mean_return);
  CHECK(first.choice(0).action == first.variation.front());
  CHECK_THROWS_AS(ParallelTreeSearch(search, 0), ParameterError);
  CHECK_THROWS_AS(ParallelTreeSearch(search, 1025), ParameterError);
  ParallelTreeSearch const two(search, 2);
  for (auto const& each : two.searches()) CHECK(each.parameters().memory == search.parameters().memory / 2);
  ParallelTreeSearch few(TreeSearch<Crossing>(game, {.horizon = 12}, {}, {}, {2}), 5);
  CHECK(few.run({}, 5).iterations == 2);
}

TEST_CASE("a faulty game or search is reported") {
  struct Broken : Crossing {
    int fault = 0;
    std::size_t agents() const { return fault == 1 ? 0 : 1; }
    std::size_t actions(State const& s, std::size_t k, std::span<Action> out) const {
      return fault == 2 ? 0 : Crossing::actions(s, k, out);
    }
    bool step(State& s, std::span<Action const> a, RandomStream& r, std::span<AgentOutcome> out) const {
      bool const over = Crossing::step(s, a, r, out);
      if (fault == 3) out[0].reward = std::numeric_limits<double>::quiet_NaN();
      if (fault == 4) out[0].cost = std::numeric_limits<double>::infinity();
      if (fault == 5) out[0].cost = 1.5;
      if (fault == 6) out[0].cost = -0.1;
      return over;
    }
  };
  auto const problem = [](int fault, Crossing::State const& state = {}) {
    Broken game;
    game.fault = fault;
    TreeSearch<Broken> search(game, {.horizon = 5}, {}, {}, {100});
    auto const& result = search.run(state, 1);
    if (result.problem != SearchProblem::none) CHECK_THROWS_AS(throw_if(result.problem), SearchError);
    return result.problem;
  };
  using enum SearchProblem;
  constexpr SearchProblem of_fault[] = {none,       no_agents,         no_actions,       not_finite,
                                        not_finite, cost_out_of_range, cost_out_of_range};
  for (int fault = 0; fault < 7; ++fault) CHECK(problem(fault) == of_fault[fault]);
  Crossing::State over;
  over.over = true;
  CHECK(problem(0, over) == terminal_root);
  CHECK_THROWS_AS(TreeSearch<Crossing>(Crossing{}, {}, {}, {}, {0}), ParameterError);
  CHECK_THROWS_AS(TreeSearch<Crossing>(Crossing{}, {.discount = std::nan("")}), ParameterError);
  CHECK_THROWS_AS(TreeSearch<Crossing>(Crossing{}, {.horizon = 0}), ParameterError);
  TreeSearch<Crossing> search({}, {}, {}, {}, {10});
  search.budget().iterations = 0;
  CHECK(search.run({}, 1).problem == SearchProblem::no_budget);
}

namespace {

/// Pays 1 a step, without end.
struct Wages : Solo<1> {
  static constexpr bool is_deterministic = true;
  double value(State, std::size_t) const { return 0.0; }
  bool step(State&, std::span<int const>, RandomStream&, std::span<AgentOutcome> out) const {
    out[0].reward = 1.0;
    return false;
  }
  int policy_action(State, std::size_t, RandomStream&) const { return 0; }
};

/// A single choice between two rewards.
struct TwoPrices : Solo<2> {
  static constexpr bool is_deterministic = true;
  double first, second;
  bool step(State& s, std::span<int const> joint, RandomStream&, std::span<AgentOutcome> out) const {
    out[0].reward = joint[0] == 0 ? first : second;
    return ++s > 0;
  }
};

}  // namespace

TEST_CASE_TEMPLATE("a roll-out ends at the horizon: the return of equal rewards is a geometric series", Rollout,
                   RandomRollout, PolicyRollout, TruncatedRollout<RandomRollout>) {
  for (int horizon = 1; horizon <= 12; ++horizon)
    for (double const discount : {1.0, 0.9, 0.5}) {
      double series = 0.0;
      for (int step = horizon; step > 0; --step) series = 1.0 + discount * series;
      TreeSearch<Wages, Ucb1, Rollout> search({}, {.horizon = horizon, .discount = discount}, {}, {}, {20});
      CHECK(search.run(0, 1).of(0)[0].mean_return == doctest::Approx(series).epsilon(1e-12));
    }
}

TEST_CASE("returns whose total or difference overflows are a problem, and such a search keeps nothing") {
  for (auto const& [low, high] : {std::pair{-1e308, 1e308}, {5e307, 1e308}, {-1e308, 0.0}}) {
    TreeSearch<TwoPrices, Ucb1, NoRollout> search({{}, low, high}, {.horizon = 1}, {}, {}, {100});
    CHECK(search.run(0, 1).problem == SearchProblem::not_finite);
    CHECK_FALSE(search.keep(std::array{1}));
  }
  TreeSearch<TwoPrices, Ucb1, NoRollout> search({{}, -1e289, 1e289}, {.horizon = 1}, {}, {}, {100});
  CHECK(search.run(0, 1).choice(0).action == 1);
}

TEST_CASE("refused parameters leave a search unchanged") {
  TreeSearch<TicTacToe> search({}, {.horizon = 9}, {}, {}, {300});
  auto const nodes = search.run({}, 1).nodes;
  CHECK_THROWS_AS(search.set({.horizon = -1}, {}, {}, {300}), ParameterError);
  CHECK(search.parameters().horizon == 9);
  CHECK(search.run({}, 1).nodes == nodes);
}

namespace {

/// Two throws at a target on [0, 1]; actions from a continuum.
struct Target {
  static constexpr bool is_deterministic = true;
  struct State {
    int throws = 0;
    bool operator==(State const&) const = default;
  };
  using Action = double;
  std::size_t agents() const { return 1; }
  bool is_terminal(State const& s) const { return s.throws == 2; }
  double sample_action(State const&, std::size_t, RandomStream& random) const { return uniform01(random); }
  bool step(State& s, std::span<double const> a, RandomStream&, std::span<AgentOutcome> out) const {
    out[0].reward = 1.0 - std::abs(a[0] - 0.3);
    return ++s.throws == 2;
  }
};

/// A coin is drawn for each iteration. Left wins 1 on heads (80 %) and loses 2 on tails; right always wins 0.25.
struct Coin : Solo<2> {
  double chance = 0.8;
  void sample_root(State& heads, RandomStream& random) const { heads = uniform01(random) < chance; }
  bool step(State& heads, std::span<int const> a, RandomStream&, std::span<AgentOutcome> out) const {
    out[0] = {a[0] == 1 ? 0.25 : heads ? 1.0 : -2.0, a[0] == 0 && !heads ? 1.0 : 0.0};
    return true;
  }
};

/// One action; the third step costs 1.
struct Debt : Solo<1> {
  bool step(State& s, std::span<int const>, RandomStream&, std::span<AgentOutcome> out) const {
    out[0].cost = ++s == 3 ? 1.0 : 0.0;
    return s == 3;
  }
};

}  // namespace

TEST_CASE("actions from a continuum are added gradually") {
  TreeSearch<Target> search({}, {.horizon = 2, .discount = 1.0, .action_widening = {1.0, 0.5}}, {0.2}, {}, {10'000});
  auto const& result = search.run({}, 4);
  CHECK(result.of(0).size() == 100);
  CHECK(std::abs(result.choice(0).action - 0.3) < 0.05);
  CHECK(result.choice(0).mean_return > 1.8);
  // Where the memory ends, it goes on with the actions that it has, and says so.
  TreeSearch<Target> small({}, {.horizon = 2, .discount = 1.0, .memory = 20'000, .action_widening = {20.0, 0.5}}, {0.2},
                           {}, {10'000});
  CHECK(small.run({}, 4).is_full);
  CHECK(small.result().iterations == 10'000);
  // The trees of a parallel search try the same actions at the root.
  ParallelTreeSearch parallel(search, 2);
  auto const& merged = parallel.run({}, 4);
  CHECK(merged.of(0).size() == parallel.searches()[0].result().of(0).size());
}

TEST_CASE("unknowns at the root are drawn anew for each iteration") {
  TreeSearch<Coin> search({}, {.horizon = 1, .constraint = {.weight = 0.0}}, {}, {}, {20'000});
  auto const& result = search.run({}, 1);
  CHECK(result.of(0)[0].mean_return == doctest::Approx(0.4).epsilon(0.1));
  CHECK(result.of(0)[0].mean_cost == doctest::Approx(0.2).epsilon(0.1));
  CHECK(result.choice(0).action == 0);
  CHECK_FALSE(search.keep(std::array<int, 1>{0}));
}

TEST_CASE("costs count beside returns by their weight") {
  for (double const weight : {0.1, 2.0}) {  // left pays 0.15 of the range of returns more, and costs 0.1
    TreeSearch<Coin> search({{}, 0.9}, {.horizon = 1, .constraint = {.weight = weight}}, {}, {}, {20'000});
    CHECK(search.run({}, 1).choice(0).action == (weight < 1.0 ? 0 : 1));
  }
}

TEST_CASE("costs are discounted in the tree and beyond it") {
  for (std::size_t const iterations : {1u, 20u}) {
    TreeSearch<Debt> search({}, {.horizon = 3, .constraint = {.discount = 0.5}}, {}, {}, {iterations});
    CHECK(search.run(0, 1).of(0)[0].mean_cost == doctest::Approx(0.25));
    // A limit bounds a probability: then they count in full.
    TreeSearch<Debt> bounded({}, {.horizon = 3, .constraint = {.discount = 0.5, .limit = 0.4}}, {}, {}, {iterations});
    CHECK(bounded.run(0, 1).of(0)[0].mean_cost == doctest::Approx(1.0));
  }
}

TEST_CASE("a cost constraint rules out actions that pay but cost too much") {
  for (double const limit : {0.1, 0.3}) {
    TreeSearch<Coin> search({}, {.horizon = 1, .constraint = {.limit = limit}}, {}, {}, {5000});
    auto const& result = search.run({}, 1);
    CHECK(result.choice(0).action == (limit < 0.2 ? 1 : 0));
    if (limit < 0.2) CHECK(search.scales()[0].multiplier > 0.1);
    if (limit > 0.2) CHECK(search.scales()[0].multiplier == 0.0);
  }
}

TEST_CASE("priors guide a search and are checked") {
  struct Guided : TicTacToe {
    double weight = 50.0;
    void priors(State const&, std::size_t, std::span<int const> actions, std::span<double> out) const {
      for (std::size_t i = 0; i < actions.size(); ++i) out[i] = actions[i] == 1 ? weight : 1.0;
    }
  };
  TreeSearch<Guided, Puct> search({}, {.horizon = 9}, {}, {}, {60});
  auto const& result = search.run({}, 1);
  std::uint32_t most = 0;
  for (auto const& arm : result.of(0)) most = std::max(most, arm.visits);
  CHECK(result.of(0)[1].visits == most);
  search.domain().weight = -1.0;
  CHECK(search.run({}, 1).problem == SearchProblem::bad_priors);
}

namespace {

/// A walk to the right. From 5 on, it claims to have `listed` actions where there is room for 2, and a step has `cost`.
struct Walk : Solo<2> {
  static constexpr bool is_deterministic = true;
  int listed = 2;
  double cost = 0.0;

  int actions(int x, std::size_t agent, std::span<int> out) const {
    auto const both = static_cast<int>(Solo::actions(x, agent, out));
    return x < 5 ? both : listed;
  }
  bool step(int& x, std::span<int const> a, RandomStream&, std::span<AgentOutcome> out) const {
    x += 1;
    out[0] = {static_cast<double>(a[0]), x > 5 ? cost : 0.0};
    return false;
  }
};

}  // namespace

TEST_CASE("missing or too many actions are found in roll-outs too, and a faulty result has no choice") {
  for (int const listed : {0, 3, -1}) {
    TreeSearch<Walk> search(Walk{{}, listed}, {.horizon = 10}, {}, {}, {1});
    auto const& result = search.run(0, 1);
    CHECK(result.problem == SearchProblem::no_actions);
    CHECK_THROWS_AS((void)result.choice(0), SearchError);
    CHECK_THROWS_AS((void)result.of(0), SearchError);
  }
  for (double const cost : {1.5, -0.5}) {
    for (std::size_t const iterations : {1u, 3000u}) {  // in the roll-out, in the tree
      TreeSearch<Walk> costly(Walk{{}, 2, cost}, {.horizon = 10}, {}, {}, {iterations});
      CHECK(costly.run(iterations == 1 ? 0 : 5, 1).problem == SearchProblem::cost_out_of_range);
      auto const where = iterations == 1 ? std::string("search, at step 6") : "search, at step 1";
      CHECK_THROWS_WITH_AS((void)costly.result().choice(0),
                           (where + ": a cost is not between 0 and 1; return the probability of the event that must "
                                    "not happen, or 1 once it happened")
                               .c_str(),
                           SearchError);
    }
  }
  TreeSearch<Walk> search(Walk{}, {.horizon = 10}, {}, {}, {20});
  CHECK(search.run(0, 1).choice(0).action == 1);
  CHECK_THROWS_WITH_AS((void)search.result().of(1), "search result: has no agent 1; it has 1", SearchError);
  // A failed run removes the tree of the previous one.
  TreeSearch<TicTacToe> game({}, {.horizon = 9}, {}, {}, {50});
  (void)game.run({}, 1);
  TicTacToe::State won;
  won.board = {1, 1, 1, -1, -1, 0, 0, 0, 0};
  won.moves = 5;
  CHECK(game.run(won, 1).problem == SearchProblem::terminal_root);
  CHECK(game.tree().size() == 0);
  CHECK(tree_as_json(game).find("\"id\"") == std::string::npos);
}

TEST_CASE("under a constraint an arm with few visits does not count as safe") {
  std::array<RootArm<int>, 2> const arms{{{0, 97, 1.0, 0.06, 0.97}, {1, 3, -10.0, 0.0, 0.03}}};
  CHECK(detail::final_choice<int>(arms, ReturnScale{}, FinalMove::most_visits, 0.05) == 0);
}

namespace {

/// Ends by itself, without an upper limit on the number of iterations.
struct Endless {
  void start() {}
  std::size_t most() const { return std::numeric_limits<std::size_t>::max(); }
  bool goes_on(std::size_t iterations) const { return iterations < 500; }
  Endless part(std::size_t, std::size_t) const { return *this; }
};

}  // namespace

TEST_CASE("under an unlimited budget the tree grows to its memory limit") {
  TreeSearch<TicTacToe, Ucb1, RandomRollout, Endless> search({}, {.horizon = 9, .memory = 1u << 20});
  auto const& result = search.run({}, 1);
  CHECK(result.iterations == 500);
  CHECK(result.nodes > 300);
}

TEST_CASE("trees are exported as JSON and DOT") {
  TreeSearch<TicTacToe> search({}, {.horizon = 9}, {}, {}, {50});
  (void)search.run({}, 1);
  auto const json = tree_as_json(search);
  auto const count = [](std::string const& text, std::string const& what) {
    std::size_t n = 0;
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
  };
  CHECK(count(json, "\"id\":") == search.tree().size());
  CHECK(count(json, "\"parent\": null") == 1);
  CHECK(count(json, "\"action\": \"-1\"") == search.tree().size() - 1);
  CHECK(count(json, "{") == count(json, "}"));
  auto const dot = tree_as_dot(search, 3);
  CHECK(dot.find("digraph search {") == 0);
  CHECK(count(dot, "->") < search.tree().size() - 1);
  CHECK(count(dot, "->") + 1 == count(dot, "[label=\"") - count(dot, "->"));
}

TEST_CASE("UCB1 selects the arm that its published formula names") {
  using Arm = cambium::Arm<int, Ucb1::Statistics>;
  RandomStream random(7, 0, 0);
  int not_greedy = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::vector<Arm> arms(2 + uniform_index(random, 6));
    ReturnScale scale;
    scale.include(-20.0);
    scale.include(30.0);
    std::uint32_t all = 0;
    for (auto& arm : arms) {
      arm.visits = 1 + uniform_index(random, 200);
      arm.total_return = arm.visits * Uniform{-20.0, 30.0}(random);
      all += arm.visits;
    }
    Ucb1 const policy{.exploration = Uniform{0.1, 2.0}(random)};
    std::size_t best = 0, greedy = 0;
    double highest = -1e300, highest_mean = -1e300;
    for (std::size_t i = 0; i < arms.size(); ++i) {
      double const n = arms[i].visits, mean = arms[i].total_return / n;
      double const index =
          (mean + 20.0) / 50.0 + policy.exploration * std::sqrt(std::log(static_cast<double>(all)) / n);
      if (index > highest) best = i;
      if (mean > highest_mean) greedy = i;
      highest = std::max(highest, index);
      highest_mean = std::max(highest_mean, mean);
    }
    CHECK(policy.select(std::span<Arm const>(arms), all, scale, random) == best);
    not_greedy += best != greedy;
  }
  CHECK(not_greedy > 500);
}

TEST_CASE("beliefs forget at their rate, towards equal probabilities") {
  Belief belief(4);
  belief.update(std::array<double, 4>{0.7, 0.1, 0.1, 0.1}, {.forgetting = 0.0, .floor = 0.0});
  double expected = 0.7;
  for (int i = 0; i < 20; ++i) {
    belief.update(std::array<double, 4>{1.0, 1.0, 1.0, 1.0}, {.forgetting = 0.1, .floor = 0.0});
    expected = 0.9 * expected + 0.1 / 4;
    CHECK(belief.probability(0) == doctest::Approx(expected).epsilon(1e-5));
  }
  CHECK(expected < 0.35);
}

TEST_CASE("beliefs follow Bayes' rule") {
  Belief belief(3);
  BeliefParameters const exact{0.0, 0.0};
  std::array<double, 3> const likelihoods{0.5, 0.25, 0.25};
  belief.update(likelihoods, exact);
  CHECK(belief.probability(0) == doctest::Approx(0.5));
  belief.update(likelihoods, exact);
  CHECK(belief.probability(0) == doctest::Approx(2.0 / 3));
  CHECK(belief.most_likely() == 0);
  auto const before = belief;
  belief.update(std::array<double, 3>{0, 0, 0}, exact);
  belief.update(std::array<double, 3>{1, std::nan(""), 1}, exact);
  CHECK(belief == before);
  CHECK_THROWS_AS(belief.update(std::array<double, 2>{1, 1}, exact), ParameterError);
  CHECK_THROWS_AS(Belief(0), ParameterError);
  CHECK_THROWS_AS(Belief(9), ParameterError);
  std::array<int, 3> counts{};
  RandomStream random(1, 2, 3);
  for (int i = 0; i < 30'000; ++i) ++counts[belief.sample(random)];
  CHECK(counts[0] == doctest::Approx(20'000).epsilon(0.03));
  for (int i = 0; i < 50; ++i) belief.update(std::array<double, 3>{0, 0, 1});
  CHECK(belief.probability(0) > 1e-4);  // the hypothesis can recover
  for (int i = 0; i < 5; ++i) belief.update(std::array<double, 3>{1, 0, 0.01});
  CHECK(belief.most_likely() == 0);
}
