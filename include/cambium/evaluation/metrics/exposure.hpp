#pragma once

#include <algorithm>
#include <limits>

#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/evaluation/encounter.hpp"
#include "cambium/evaluation/evaluator.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

/// How long an agent is exposed to a collision: the time for which its time to collision (`TimeToCollision`) is below
/// `threshold` (time exposed TTC, TET), and by how much, summed over time (time integrated TTC, TIT; Minderhoud and
/// Bovy 2001). O(agents + objects) per step, on the grid of the steps.
struct Exposure {
  TimeToCollision time_to_collision{};
  double threshold = 2.0;

  static constexpr char const* name = "exposure";
  static constexpr char const* summary = "how long, and how much, its time to collision is too short [s, s^2]";
  static constexpr char const* source = "Minderhoud, Bovy 2001";
  static constexpr auto parameters() {
    using P = Exposure;
    return parameter_list(parameter("time_to_collision", &P::time_to_collision, "what is watched"),
                          parameter("threshold", &P::threshold, "s", Range{0, 1000}, "shorter times count"));
  }

  template <class World>
  void observe(World& world, Slot slot, double dt) {
    if (world.frame().agents[slot].status != AgentStatus::driving) return;
    double const time = time_to_collision(world, slot), missing = std::max(0.0, threshold - time);
    least_ = std::min(least_, time);
    exposed_ += missing > 0.0 ? dt : 0.0;
    integrated_ += missing * dt;
  }

  [[nodiscard]] double value() const { return exposed_; }          ///< TET [s]
  [[nodiscard]] double integrated() const { return integrated_; }  ///< TIT [s^2]
  /// Least time to collision [s], at most `TimeToCollision::longest`.
  [[nodiscard]] double least() const { return std::min(least_, time_to_collision.longest); }

 private:
  double exposed_ = 0.0, integrated_ = 0.0, least_ = std::numeric_limits<double>::infinity();
};

}  // namespace cambium::inline v0_1
