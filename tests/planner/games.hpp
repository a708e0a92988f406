#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cambium/core/distributions.hpp"
#include "cambium/planner/search/search_domain.hpp"

// Small games with known solutions, to test searches.

namespace games {

using cambium::AgentOutcome;
using cambium::RandomStream;

/// Checks that two searches found the same.
template <class Result>
void check_equal(Result const& a, Result const& b) {
  CHECK(a.iterations == b.iterations);
  CHECK(a.nodes == b.nodes);
  CHECK(a.depths == b.depths);
  CHECK(a.variation == b.variation);
  CHECK(std::ranges::equal(a.arms, b.arms, [](auto const& p, auto const& q) {
    return p.visits == q.visits && p.mean_return == q.mean_return && p.mean_cost == q.mean_cost && p.share == q.share;
  }));
}

/// What games of one agent have in common that chooses a number below `count`.
template <int count>
struct Solo {
  static constexpr std::size_t max_actions = count;
  using State = int;
  using Action = int;
  std::size_t agents() const { return 1; }
  bool is_terminal(State) const { return false; }
  std::size_t actions(State, std::size_t, std::span<int> out) const {
    for (int i = 0; i < count; ++i) out[static_cast<std::size_t>(i)] = i;
    return count;
  }
};

/// Two players, one simultaneous move. The first gets p = `payoff[row][column]`, the second 1 - p.
struct MatrixGame {
  static constexpr bool is_deterministic = true;
  static constexpr std::size_t max_actions = 3;
  struct State {
    bool over = false;
    bool operator==(State const&) const = default;
  };
  using Action = int;
  std::size_t rows = 2, columns = 2;
  std::array<std::array<double, 3>, 3> payoff{};

  std::size_t agents() const { return 2; }
  bool is_terminal(State const& s) const { return s.over; }
  std::size_t actions(State const&, std::size_t agent, std::span<int> out) const {
    auto const count = agent == 0 ? rows : columns;
    for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<int>(i);
    return count;
  }
  bool step(State& s, std::span<int const> a, RandomStream&, std::span<AgentOutcome> out) const {
    out[0].reward = payoff[std::size_t(a[0])][std::size_t(a[1])];
    out[1].reward = 1.0 - out[0].reward;
    return s.over = true;
  }
};

inline MatrixGame const matching_pennies{2, 2, {{{1, 0}, {0, 1}}}};
/// Mixed equilibrium: the row player is indifferent at 1 q + 0.25 (1 - q) = 0.5 (1 - q), so q = 0.2; the column player
/// at 1 - p = 0.5 + 0.25 p, so p = 0.4.
inline MatrixGame const uneven{2, 2, {{{1.0, 0.25}, {0.0, 0.5}}}};
inline MatrixGame const rock_paper_scissors{3, 3, {{{0.5, 0, 1}, {1, 0.5, 0}, {0, 1, 0.5}}}};

/// Noughts and crosses: players 0 and 1 alternate. The player not to move has a single action without effect (-1).
struct TicTacToe {
  static constexpr bool is_deterministic = true;
  static constexpr std::size_t max_actions = 9;
  struct State {
    std::array<std::int8_t, 9> board{};  ///< 1, -1, or 0 where empty
    int moves = 0;
    bool operator==(State const&) const = default;
  };
  using Action = int;

  static int winner(State const& s) {
    constexpr int lines[8][3] = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {0, 3, 6},
                                 {1, 4, 7}, {2, 5, 8}, {0, 4, 8}, {2, 4, 6}};
    for (auto const& l : lines) {
      auto const at = [&](int i) { return s.board[static_cast<std::size_t>(l[i])]; };
      if (at(0) != 0 && at(0) == at(1) && at(1) == at(2)) return at(0);
    }
    return 0;
  }
  std::size_t agents() const { return 2; }
  bool is_terminal(State const& s) const { return s.moves == 9 || winner(s) != 0; }
  std::size_t actions(State const& s, std::size_t agent, std::span<int> out) const {
    if (static_cast<std::size_t>(s.moves % 2) != agent) {
      out[0] = -1;
      return 1;
    }
    std::size_t count = 0;
    for (int i = 0; i < 9; ++i)
      if (s.board[static_cast<std::size_t>(i)] == 0) out[count++] = i;
    return count;
  }
  bool step(State& s, std::span<int const> actions, RandomStream&, std::span<AgentOutcome> out) const {
    auto const mover = static_cast<std::size_t>(s.moves % 2);
    s.board[static_cast<std::size_t>(actions[mover])] = mover == 0 ? 1 : -1;
    ++s.moves;
    int const won = winner(s);
    out[0].reward = won;
    out[1].reward = -won;
    return won != 0 || s.moves == 9;
  }

  /// The joint action if the player to move takes that place.
  static std::array<int, 2> joint(State const& s, int place) {
    return s.moves % 2 == 0 ? std::array{place, -1} : std::array{-1, place};
  }
  void move(State& s, int place) const {
    std::array<AgentOutcome, 2> outcomes{};
    RandomStream none(0, 0, 0);
    (void)step(s, joint(s, place), none, outcomes);
  }

  /// Value of the game for player 0 under perfect play.
  static int solution(State const& s) {
    if (int const won = winner(s); won != 0) return won;
    if (s.moves == 9) return 0;
    int const sign = s.moves % 2 == 0 ? 1 : -1;
    int best = -2;
    for (std::size_t i = 0; i < 9; ++i) {
      if (s.board[i] != 0) continue;
      State next = s;
      TicTacToe{}.move(next, static_cast<int>(i));
      best = std::max(best, sign * solution(next));
    }
    return sign * best;
  }
};

/// One agent on a 4 x 3 grid with a wall, a goal (+1) and a pit (-1). A step costs 0.04 and slips to either side with a
/// probability of 10 % each (Russell, Norvig, "Artificial Intelligence", 17.1).
struct GridWorld {
  static constexpr std::size_t max_actions = 4;
  static constexpr int width = 4, height = 3;
  struct State {
    int x = 0, y = 0;
    bool operator==(State const&) const = default;
  };
  using Action = int;  ///< 0 right, 1 up, 2 left, 3 down

  static bool is_over(State const& s) { return s.x == 3 && s.y >= 1; }
  static State moved(State s, int direction) {
    constexpr int dx[] = {1, 0, -1, 0}, dy[] = {0, 1, 0, -1};
    State const to{s.x + dx[direction], s.y + dy[direction]};
    bool const is_free = to.x >= 0 && to.x < width && to.y >= 0 && to.y < height && !(to.x == 1 && to.y == 1);
    return is_free ? to : s;
  }
  static double reward(State const& s) { return !is_over(s) ? -0.04 : s.y == 2 ? 1.0 : -1.0; }

  std::size_t agents() const { return 1; }
  bool is_terminal(State const& s) const { return is_over(s); }
  std::size_t actions(State const&, std::size_t, std::span<int> out) const {
    for (int i = 0; i < 4; ++i) out[static_cast<std::size_t>(i)] = i;
    return 4;
  }
  bool step(State& s, std::span<int const> actions, RandomStream& random, std::span<AgentOutcome> out) const {
    double const u = cambium::uniform01(random);
    s = moved(s, (actions[0] + (u < 0.1 ? 1 : u < 0.2 ? 3 : 0)) % 4);
    out[0].reward = reward(s);
    return is_over(s);
  }

  /// Q(state, action) by value iteration.
  static double solution(State const& from, int action, double discount) {
    std::array<std::array<double, height>, width> value{};
    auto const of = [&](State const& s) {
      return reward(s) +
             (is_over(s) ? 0.0 : discount * value[static_cast<std::size_t>(s.x)][static_cast<std::size_t>(s.y)]);
    };
    auto const q = [&](State const& s, int a) {
      return 0.8 * of(moved(s, a)) + 0.1 * of(moved(s, (a + 1) % 4)) + 0.1 * of(moved(s, (a + 3) % 4));
    };
    for (int sweep = 0; sweep < 200; ++sweep)
      for (int x = 0; x < width; ++x)
        for (int y = 0; y < height; ++y)
          if (!is_over({x, y}))
            value[static_cast<std::size_t>(x)][static_cast<std::size_t>(y)] =
                std::max({q({x, y}, 0), q({x, y}, 1), q({x, y}, 2), q({x, y}, 3)});
    return q(from, action);
  }
};

/// The crossing of mamcts (Bernhard; default parameters of its CrossingState<int>). Ego and the others move on lines
/// that all cross at 11. Ego moves by -1 to 2 per step and has to pass 12. The others move by -3 to 3 to keep a gap of
/// 4 to 6 behind ego; the gap is drawn anew in every step.
struct Crossing {
  static constexpr bool is_deterministic = false;
  static constexpr std::size_t max_actions = 4, most_others = 4;
  static constexpr int start = 5, crossing_point = 11, goal = 12;
  struct Mover {
    std::int16_t x = start, last = 2;
    bool operator==(Mover const&) const = default;
  };
  struct State {
    Mover ego{};
    std::array<Mover, most_others> others{};
    bool over = false;
    bool operator==(State const&) const = default;
  };
  using Action = std::int8_t;

  std::size_t others = 2;

  std::size_t agents() const { return 1; }
  bool is_terminal(State const& s) const { return s.over; }
  std::size_t actions(State const&, std::size_t, std::span<Action> out) const {
    for (std::size_t i = 0; i < 4; ++i) out[i] = static_cast<Action>(static_cast<int>(i) - 1);
    return 4;
  }
  static int reaction(Mover const& other, Mover const& ego, int gap) {
    if (other.x >= crossing_point) return other.last;
    return std::clamp(ego.x + ego.last - other.x - gap, -3, 3);
  }
  bool step(State& s, std::span<Action const> actions, RandomStream& random, std::span<AgentOutcome> out) const {
    auto const ego = s.ego;
    s.ego = {static_cast<std::int16_t>(ego.x + actions[0]), actions[0]};
    bool collides = false;
    for (std::size_t i = 0; i < others; ++i) {
      auto& other = s.others[i];
      auto const before = other.x;
      int const by = reaction(other, ego, 4 + static_cast<int>(cambium::uniform_index(random, 3)));
      other = {static_cast<std::int16_t>(std::max(0, before + by)), static_cast<std::int16_t>(by)};
      collides = collides || (s.ego.x >= crossing_point && ego.x <= crossing_point && other.x >= crossing_point &&
                              before <= crossing_point);
    }
    bool const off = s.ego.x < 0;
    bool const reached = s.ego.x >= goal && !collides;
    out[0] = {(reached ? 100.0 : 0.0) - (collides || off ? 1000.0 : 0.0), collides ? 1.0 : 0.0};
    return s.over = reached || collides || off;
  }
};

}  // namespace games
