#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "full.hpp"
#include "road.hpp"

// Yardstick of tree search: UCT with nothing around it. Vehicle 0 chooses among three accelerations at every step of
// the L2 world; a node stores its world, and roll-outs are random.

namespace yardstick {

/// A search from one world of up to `capacity` - 1 iterations; its memory is used again.
class Uct {
 public:
  static constexpr std::array<double, 3> accelerations{0.0, 1.5, -2.0};

  Uct(FullWorld const& root, std::size_t capacity) : nodes_(capacity, Node{root}), work_(root) {}

  /// Returns the visits of the most visited action.
  std::uint32_t run(FullWorld const& root, std::size_t iterations, int horizon, std::uint64_t seed) {
    used_ = 1;
    nodes_[0].world = root;
    nodes_[0].clear();
    random_ = seed * 0x9E3779B97F4A7C15u + 1;
    for (std::size_t i = 0; i < iterations; ++i) iterate(horizon);
    std::uint32_t most = 0;
    for (auto const& arm : nodes_[0].arms) most = std::max(most, arm.visits);
    return most;
  }

 private:
  struct Arm {
    std::uint32_t visits = 0, child = 0;
    double total = 0.0;
  };
  struct Node {
    FullWorld world;
    std::array<Arm, 3> arms{};
    double reward = 0.0;
    bool over = false;

    void clear() {
      arms = {};
      reward = 0.0;
      over = false;
    }
  };

  std::uint64_t draw() {
    random_ ^= random_ << 13;
    random_ ^= random_ >> 7;
    random_ ^= random_ << 17;
    return random_;
  }

  // Progress, and an end where boxes overlap.
  static double step(FullWorld& world, std::size_t action, bool& over) {
    over = world.step_with(accelerations[action]) > 0;
    return over ? -100.0 : 0.1 * world.vehicles()[0].speed;
  }

  std::size_t select(Node const& node) {
    double visits = 0.0;
    for (auto const& arm : node.arms) visits += arm.visits;
    std::size_t best = 0;
    double best_score = -std::numeric_limits<double>::infinity();
    double const log_visits = std::log(visits + 1.0);
    auto const first = draw() % 3;
    for (std::size_t k = 0; k < 3; ++k) {
      auto const i = (first + k) % 3;
      if (node.arms[i].visits == 0) return i;
      double const score =
          node.arms[i].total / node.arms[i].visits / 30.0 + 0.7 * std::sqrt(log_visits / node.arms[i].visits);
      if (score > best_score) {
        best_score = score;
        best = i;
      }
    }
    return best;
  }

  void iterate(int horizon) {
    std::array<std::uint32_t, 64> path{};
    std::array<std::uint8_t, 64> taken{};
    std::size_t depth = 0;
    std::uint32_t node = 0;
    bool is_new = false;
    while (!is_new && !nodes_[node].over && depth < static_cast<std::size_t>(horizon)) {
      auto const action = select(nodes_[node]);
      path[depth] = node;
      taken[depth++] = static_cast<std::uint8_t>(action);
      auto& child = nodes_[node].arms[action].child;
      is_new = child == 0;
      if (is_new) {
        child = static_cast<std::uint32_t>(used_++);
        nodes_[child].clear();
        nodes_[child].world = nodes_[node].world;
        nodes_[child].reward = step(nodes_[child].world, action, nodes_[child].over);
      }
      node = child;
    }
    double value = 0.0;
    bool over = nodes_[node].over;
    if (!over) work_ = nodes_[node].world;
    for (auto left = static_cast<std::size_t>(horizon) - depth; left > 0 && !over; --left)
      value += step(work_, draw() % 3, over);
    for (; depth-- > 0;) {
      auto& arm = nodes_[path[depth]].arms[taken[depth]];
      value += nodes_[arm.child].reward;
      ++arm.visits;
      arm.total += value;
    }
  }

  std::vector<Node> nodes_;
  FullWorld work_;
  std::size_t used_ = 1;
  std::uint64_t random_ = 1;
};

}  // namespace yardstick
