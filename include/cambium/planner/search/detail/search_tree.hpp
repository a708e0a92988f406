#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "cambium/core/distributions.hpp"
#include "cambium/core/hash.hpp"
#include "cambium/planner/search/search_domain.hpp"
#include "cambium/planner/search/selection_policy.hpp"

namespace cambium::inline v0_1::detail {

inline constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();

/// The nodes and arms of a search, in a few flat arrays, addressed by 32-bit numbers. A node stands for the joint
/// action of all agents at its parent. A child's number is greater than its parent's.
///
///     nodes_    [root][  1 ][  2 ][  3 ]...       parent, visits; states_[n] and, per agent, joints_ and outcomes_
///                  |                              (which arms led here, and what they brought)
///     blocks_   [a0 a1][a0 a1]...                 per node and agent: where its arms are
///                 |  '---------.
///     arms_     [a0: 7 arms ...][a1: 7 arms ...]...
///
///     table_    hash of (parent, joint action) -> first node; `next_outcome` chains the other outcomes of that action
///
/// Memory is kept from search to search. States of former searches are assigned to rather than destroyed, so the heap
/// memory that they own is reused as well.
template <class State, class Arm>
class SearchTree {
 public:
  struct Node {
    std::uint32_t parent = no_node;
    std::uint32_t next_outcome = no_node;  ///< next of the other states to which the same actions led
    std::uint32_t visits = 0;              ///< number of courses through this node
    std::uint32_t draws = 1;               ///< number of steps that led here
    bool terminal = false;
  };

  /// The maximum size of a tree.
  struct Limits {
    std::size_t agents = 1, nodes = 1, bytes = 0;
    std::size_t first_nodes = nodes;  ///< number of nodes reserved at the start
    std::size_t arms_per_node = 1;    ///< estimate, for all agents together
    std::size_t state_bytes = 0;      ///< per node; 0: nodes have no states
  };

  /// Removes all nodes and reserves memory for a new tree.
  void reset(Limits const& limits) {
    clear();
    reserve(limits);
    begin_epoch();
  }

  /// Removes all nodes, including the root.
  void clear() {
    nodes_.clear();
    arms_.clear();
  }

  /// Reserves memory and keeps the nodes; `limits.agents` must not change. The reserved memory stays within
  /// `limits.bytes`, with three exceptions: a root alone, nodes kept from a larger tree, and arrays while they grow. If
  /// not everything fits, arms get at most as much memory as nodes.
  void reserve(Limits const& limits) {
    limits_ = limits;
    agents_ = limits.agents;
    auto& most = limits_.nodes;
    auto const with_arms = node_bytes() + std::min(limits.arms_per_node * sizeof(Arm), node_bytes());
    most = std::max<std::size_t>(1, std::min({most, limits.bytes / with_arms, std::size_t{no_node - 1}}));
    most_arms_ = (limits.bytes - std::min(limits.bytes, most * node_bytes())) / sizeof(Arm);
    make_room(std::clamp<std::size_t>(limits.first_nodes, 1, most));
  }

  [[nodiscard]] std::size_t agents() const { return agents_; }
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  [[nodiscard]] Node& node(std::uint32_t n) { return nodes_[n]; }
  [[nodiscard]] Node const& node(std::uint32_t n) const { return nodes_[n]; }
  [[nodiscard]] State& state(std::uint32_t n) { return states_[n]; }
  [[nodiscard]] State const& state(std::uint32_t n) const { return states_[n]; }
  [[nodiscard]] bool stores_states() const { return limits_.state_bytes > 0; }

  /// The arms that the agents took to get here, and the outcomes of that step.
  [[nodiscard]] std::span<std::uint16_t const> joint(std::uint32_t n) const {
    return {joints_.data() + n * agents_, agents_};
  }
  [[nodiscard]] std::span<AgentOutcome const> outcomes(std::uint32_t n) const {
    return {outcomes_.data() + n * agents_, agents_};
  }

  [[nodiscard]] std::span<Arm> arms(std::uint32_t n, std::size_t agent) {
    auto const& block = blocks_[n * agents_ + agent];
    return {arms_.data() + block.first, block.count};
  }
  [[nodiscard]] std::span<Arm const> arms(std::uint32_t n, std::size_t agent) const {
    auto const& block = blocks_[n * agents_ + agent];
    return {arms_.data() + block.first, block.count};
  }

  /// Whether all agents have their arms at the node. They get them in order, so the last one tells.
  [[nodiscard]] bool has_arms(std::uint32_t n) const { return blocks_[n * agents_ + agents_ - 1].count > 0; }

  /// Whether another node, or `count` more arms, fit into memory. A root alone always gets its arms.
  [[nodiscard]] bool has_room() const { return nodes_.size() < limits_.nodes; }
  [[nodiscard]] bool has_room_for_arms(std::size_t count) const {
    return nodes_.size() == 1 || arms_.size() + count <= most_arms_;
  }

  /// Adds a node; the first one is the root. Precondition: `has_room()`.
  std::uint32_t add(std::uint32_t parent, std::span<std::uint16_t const> joint, std::span<AgentOutcome const> outcomes,
                    bool terminal, State const& state) {
    auto const n = static_cast<std::uint32_t>(nodes_.size());
    if (n == room_) make_room(std::min(2 * room_, limits_.nodes));
    nodes_.push_back({parent, no_node, 0, 1, terminal});
    std::copy(joint.begin(), joint.end(), joints_.begin() + static_cast<std::ptrdiff_t>(n * agents_));
    std::copy(outcomes.begin(), outcomes.end(), outcomes_.begin() + static_cast<std::ptrdiff_t>(n * agents_));
    std::fill_n(blocks_.begin() + static_cast<std::ptrdiff_t>(n * agents_), agents_, Block{});
    if (stores_states()) {
      if (n < states_.size())
        states_[n] = state;
      else
        states_.push_back(state);
    }
    if (parent != no_node) link(n);
    return n;
  }

  /// Adds an arm for the agent at the node. `expected`: the number of arms that it will probably get.
  Arm& add_arm(std::uint32_t n, std::size_t agent, std::size_t expected) {
    auto& block = blocks_[n * agents_ + agent];
    if (block.count == block.room) {  // a full block moves to the end and doubles
      auto const room = std::max<std::size_t>(expected, 2u * block.room);
      auto const first = arms_.size();
      if (auto const capacity = arms_.capacity(); first + room > capacity)
        arms_.reserve(std::max(first + room, std::min(2 * capacity, most_arms_)));
      arms_.resize(first + room);
      std::copy_n(arms_.begin() + block.first, block.count, arms_.begin() + static_cast<std::ptrdiff_t>(first));
      block.first = static_cast<std::uint32_t>(first);
      block.room = static_cast<std::uint16_t>(room);
    }
    return arms_[block.first + block.count++];
  }

  /// The first node to which the joint action `joint` led from `parent`, or `no_node`. Expected O(1).
  [[nodiscard]] std::uint32_t find(std::uint32_t parent, std::span<std::uint16_t const> joint) const {
    for (auto at = hash(parent, joint) & (table_.size() - 1); table_[at].epoch == epoch_;
         at = (at + 1) & (table_.size() - 1))
      if (auto const n = table_[at].node; nodes_[n].parent == parent && std::ranges::equal(this->joint(n), joint))
        return n;
    return no_node;
  }

  /// The first of the outcomes of the same actions, from node `first` on, for which `is_it(node)` holds; else
  /// `no_node`.
  template <class F>
  [[nodiscard]] std::uint32_t find_outcome(std::uint32_t first, F&& is_it) const {
    while (first != no_node && !is_it(first)) first = nodes_[first].next_outcome;
    return first;
  }

  /// The number of outcomes of the same actions, of which node `first` is the first, and the courses through them.
  struct Outcomes {
    std::size_t count = 0;
    std::uint32_t visits = 0;
  };
  [[nodiscard]] Outcomes outcomes_of_actions(std::uint32_t first) const {
    Outcomes all;
    for (; first != no_node; first = nodes_[first].next_outcome, ++all.count) all.visits += nodes_[first].visits;
    return all;
  }

  /// A random one of these outcomes, with a probability in proportion to the steps that led to it. (Visits instead
  /// would reinforce themselves.)
  [[nodiscard]] std::uint32_t drawn_outcome(std::uint32_t first, RandomStream& random) const {
    std::uint32_t draws = 0;
    for (auto n = first; n != no_node; n = nodes_[n].next_outcome) draws += nodes_[n].draws;
    auto left = uniform_index(random, draws);
    return find_outcome(first, [&](std::uint32_t n) {
      bool const is_it = left < nodes_[n].draws;
      left -= nodes_[n].draws;
      return is_it;
    });
  }

  /// Makes node `root` the root and drops everything that is not below it. O(n log n) in the nodes; no allocation once
  /// warm.
  void keep_below(std::uint32_t root) {
    moved_to_.assign(nodes_.size(), no_node);
    std::uint32_t kept = 0;
    for (std::uint32_t n = root; n < nodes_.size(); ++n) {
      bool const is_root = n == root;
      if (!is_root && (nodes_[n].parent < root || moved_to_[nodes_[n].parent] == no_node)) continue;
      moved_to_[n] = kept;
      move_node(n, kept);
      nodes_[kept].parent = is_root ? no_node : moved_to_[nodes_[kept].parent];
      ++kept;
    }
    nodes_.resize(kept);
    pack_arms();
    rehash(table_.size());
  }

 private:
  struct Block {
    std::uint32_t first = 0;
    std::uint16_t count = 0, room = 0;
  };
  struct Entry {
    std::uint32_t node = 0;
    std::uint32_t epoch = 0;
  };

  [[nodiscard]] std::size_t node_bytes() const {
    return sizeof(Node) + agents_ * (sizeof(std::uint16_t) + sizeof(AgentOutcome) + sizeof(Block)) +
           limits_.state_bytes + 4 * sizeof(Entry) + (1 + agents_) * sizeof(std::uint32_t);
  }

  [[nodiscard]] static std::size_t hash(std::uint32_t parent, std::span<std::uint16_t const> joint) {
    std::uint64_t hash = parent;
    for (auto const arm : joint) hash = cambium::detail::mixed(hash, arm);
    return static_cast<std::size_t>(hash);
  }

  /// Enters a node into the table, or appends it to the outcomes of the same actions.
  void link(std::uint32_t n) {
    if (auto const first = find(nodes_[n].parent, joint(n)); first != no_node) {
      auto const last = find_outcome(first, [&](std::uint32_t other) { return nodes_[other].next_outcome == no_node; });
      nodes_[last].next_outcome = n;
      return;
    }
    auto at = hash(nodes_[n].parent, joint(n)) & (table_.size() - 1);
    while (table_[at].epoch == epoch_) at = (at + 1) & (table_.size() - 1);
    table_[at] = {n, epoch_};
  }

  /// Reserves memory for `nodes` nodes and their arms.
  void make_room(std::size_t nodes) {
    room_ = nodes;
    nodes_.reserve(nodes);
    grow(joints_, nodes * agents_);
    grow(outcomes_, nodes * agents_);
    grow(blocks_, nodes * agents_);
    if (stores_states()) states_.reserve(nodes);
    arms_.reserve(std::min(nodes * limits_.arms_per_node, most_arms_));
    std::size_t entries = 16;
    while (entries < 2 * nodes) entries *= 2;
    if (table_.size() < entries) rehash(entries);
  }

  /// Resizes a list to at least `size`, without spare capacity.
  template <class T>
  static void grow(std::vector<T>& list, std::size_t size) {
    if (size <= list.size()) return;
    list.reserve(size);
    list.resize(size);
  }

  /// Invalidates all entries of the table in O(1): only those of the current epoch count.
  void begin_epoch() {
    if (++epoch_ != 0) return;
    std::fill(table_.begin(), table_.end(), Entry{});  // the counter wrapped: old entries would seem new
    epoch_ = 1;
  }

  void rehash(std::size_t entries) {
    if (entries == table_.size()) {
      begin_epoch();
    } else {
      table_.assign(entries, Entry{});
      epoch_ = 1;
    }
    for (auto& node : nodes_) node.next_outcome = no_node;
    for (std::uint32_t n = 1; n < nodes_.size(); ++n) link(n);
  }

  void move_node(std::uint32_t from, std::uint32_t to) {
    for (std::size_t k = 0; k < agents_; ++k) {
      blocks_[to * agents_ + k] = blocks_[from * agents_ + k];
      joints_[to * agents_ + k] = joints_[from * agents_ + k];
      outcomes_[to * agents_ + k] = outcomes_[from * agents_ + k];
    }
    nodes_[to] = nodes_[from];
    if (stores_states() && from != to) std::swap(states_[to], states_[from]);
  }

  /// Closes the gaps between the arms of all nodes.
  void pack_arms() {
    packed_.clear();
    packed_.reserve(blocks_.size());
    for (std::uint32_t b = 0; b < nodes_.size() * agents_; ++b) packed_.push_back(b);
    std::sort(packed_.begin(), packed_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return blocks_[a].first < blocks_[b].first; });
    std::size_t end = 0;
    for (auto const b : packed_) {
      auto& [first, count, room] = blocks_[b];
      if (first != end) std::copy_n(arms_.begin() + first, count, arms_.begin() + static_cast<std::ptrdiff_t>(end));
      first = static_cast<std::uint32_t>(end);
      room = count;
      end += count;
    }
    arms_.resize(end);
  }

  Limits limits_;
  std::size_t agents_ = 1, room_ = 0, most_arms_ = 0;
  std::uint32_t epoch_ = 0;
  std::vector<Node> nodes_;
  std::vector<std::uint16_t> joints_;  ///< by node and agent, like the next two
  std::vector<AgentOutcome> outcomes_;
  std::vector<Block> blocks_;
  std::vector<State> states_;  ///< by node; beyond `nodes_.size()`, states of former searches
  std::vector<Arm> arms_;
  std::vector<Entry> table_;  ///< open addressing, at most half full
  std::vector<std::uint32_t> moved_to_, packed_;
};

}  // namespace cambium::inline v0_1::detail
