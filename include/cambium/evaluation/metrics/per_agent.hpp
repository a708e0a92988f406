#pragma once

#include <map>
#include <span>
#include <utility>

#include "cambium/core/ids.hpp"

namespace cambium::inline v0_1 {

/// The same metric of several agents: of those given, or of all that are in the world or come into it. Keeps the values
/// of those that have left.
template <class M>
class PerAgent {
 public:
  /// One metric for each agent that it meets, each a copy of `metric`; or for `agents` only.
  explicit PerAgent(M metric = {}) : start_(std::move(metric)), takes_all_(true) {}
  PerAgent(std::span<AgentId const> agents, M const& metric) {
    for (auto const id : agents) add(id, metric);
  }

  /// Watches an agent by a metric of its own, such as the `Displacement` from its recording.
  void add(AgentId id, M metric) { of_.insert_or_assign(id, std::move(metric)); }

  /// As `observe` of a metric, for each agent. O(agents log agents).
  template <class World>
  void observe(World& world, double dt) {
    auto const& agents = world.roster().agents;
    for (Slot slot{}; index_of(slot) < agents.size(); ++slot) {
      auto at = of_.find(agents[slot].id);
      if (at == of_.end() && takes_all_) at = of_.emplace(agents[slot].id, start_).first;
      if (at != of_.end()) at->second.observe(world, slot, dt);
    }
  }

  /// The metrics by agent, in the order of ids.
  [[nodiscard]] std::map<AgentId, M> const& each() const { return of_; }

 private:
  std::map<AgentId, M> of_;
  M start_{};
  bool takes_all_ = false;
};

}  // namespace cambium::inline v0_1
