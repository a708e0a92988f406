#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/world/frame.hpp"

namespace cambium {

/// Post-encroachment time [s]: the least time between one of two road users leaving a place and the other one reaching
/// it, where their ways cross or meet (Allen, Shin, Cooper 1978). Places are those that bodies cover at the steps: the
/// grid of its times is that of the steps. Vehicles that follow each other in one direction (less than `crossing_angle`
/// apart) do not count, nor what happened more than `longest` [s] ago. 0 where the two touch; NaN without an encounter.
/// O(agents * steps in `longest`) per step.
class PostEncroachmentTime {
 public:
  double longest = 5.0;         ///< [s]
  double crossing_angle = 0.5;  ///< [rad]

  template <class World>
  void observe(World& world, Slot slot, double) {
    auto const now = world.time();
    while (!trail_.empty() && now - trail_.front().time > longest) trail_.pop_front();
    for (std::size_t i = 0; i < others_.size();)
      if (now - others_[i].time > longest) {
        others_[i] = others_.back();
        others_.pop_back();
      } else {
        ++i;
      }
    bool const is_there = in_traffic(world, slot);
    auto const own = footprint(world, slot);
    if (is_there) meet(own, others_);
    for (Slot other{}; index_of(other) < world.size(); ++other) {
      if (other == slot || !in_traffic(world, other)) continue;
      auto const its = footprint(world, other);
      meet(its, trail_);
      if (is_there) meet(its, std::array{own});
      if (is_there) others_.push_back(its);
    }
    if (is_there) trail_.push_back(own);
  }

  [[nodiscard]] double value() const {
    return std::isfinite(least_) ? least_ : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  struct Footprint {
    double time;
    geometry::OrientedBox box;
    double heading;
  };

  template <class World>
  [[nodiscard]] static Footprint footprint(World const& world, Slot slot) {
    auto const& state = world.frame().agents[slot].state;
    return {world.time(), box_at(world, slot), state.heading};
  }

  /// Whoever is here now, and whoever was here earlier.
  template <class Earlier>
  void meet(Footprint const& now, Earlier const& earlier) {
    for (auto const& before : earlier) {
      double const since = now.time - before.time;
      if (since >= least_ || !geometry::intersects(now.box, before.box)) continue;
      bool const crosses = portable::cos(now.heading - before.heading) <= portable::cos(crossing_angle);
      if (crosses || since == 0.0) least_ = since;
    }
  }

  double least_ = std::numeric_limits<double>::infinity();
  std::deque<Footprint> trail_;
  std::vector<Footprint> others_;
};

}  // namespace cambium
