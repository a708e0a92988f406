#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

/// Post-encroachment time [s]: the least time between one of two road users leaving a place and the other one reaching
/// it, where their ways cross or meet (Allen, Shin, Cooper 1978). Places are those that bodies cover at the steps, and
/// within a step wherever they have moved on by their length: this is the grid of its times. Vehicles that follow each
/// other in one direction (less than `crossing_angle` apart) do not count, nor what happened more than `longest` [s]
/// ago. 0 where the two touch; NaN without an encounter. O(agents * places in `longest`) per step.
class PostEncroachmentTime {
 public:
  double longest = 5.0;         ///< [s]
  double crossing_angle = 0.5;  ///< [rad]

  static constexpr char const* name = "post_encroachment_time";
  static constexpr char const* summary = "from one road user's leaving a place to another's reaching it [s]";
  static constexpr char const* source = "Allen, Shin, Cooper 1978";
  static constexpr auto parameters() {
    using P = PostEncroachmentTime;
    return parameter_list(
        parameter("longest", &P::longest, "s", Range{0, 1000}, "what happened earlier does not count"),
        parameter("crossing_angle", &P::crossing_angle, "rad", Range{0, 3.2}, "between ways that cross"));
  }

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
    for (Slot other{}; index_of(other) < world.size(); ++other) {
      if (other == slot || !in_traffic(world, other)) continue;
      for_each_place(world, other, [&](Footprint const& its) {
        meet(its, trail_);
        if (is_there) others_.push_back(its);
      });
    }
    if (!is_there) return;
    for_each_place(world, slot, [&](Footprint const& own) {
      meet(own, others_);
      trail_.push_back(own);
    });
  }

  [[nodiscard]] double value() const {
    return std::isfinite(least_) ? least_ : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  struct Footprint {
    double time;
    geometry::OrientedBox box;
  };

  /// Calls `f(footprint)` for where the agent at `slot` is, and was since the last frame.
  template <class World, class F>
  static void for_each_place(World const& world, Slot slot, F const& f) {
    auto const& now = world.frame().agents[slot].state;
    int parts = 1;
    double dt = 0.0;
    if (auto const* const before = detail::state_before(world, slot)) {
      constexpr double most = 100.0;
      double const way = portable::hypot(now.x - before->x, now.y - before->y);
      parts = static_cast<int>(std::ceil(std::clamp(way / world.roster().agents[slot].shape.length(), 1.0, most)));
      dt = now.time - before->time;
    }
    auto const motion = motion_at(world, slot);
    for (int i = 1; i <= parts; ++i) {
      double const share = static_cast<double>(i) / parts;
      f(Footprint{world.time() - (1.0 - share) * dt, motion.at(share)});
    }
  }

  /// Of two road users, `one` is here, and all of `others` were here, or come in the same step.
  template <class Places>
  void meet(Footprint const& one, Places const& others) {
    for (auto const& other : others) {
      double const since = std::abs(one.time - other.time);
      if (since >= least_ || !geometry::intersects(one.box, other.box)) continue;
      double const along = one.box.cos * other.box.cos + one.box.sin * other.box.sin;
      if (along <= portable::cos(crossing_angle) || since == 0.0) least_ = since;
    }
  }

  double least_ = std::numeric_limits<double>::infinity();
  std::deque<Footprint> trail_;
  std::vector<Footprint> others_;
};

}  // namespace cambium::inline v0_1
