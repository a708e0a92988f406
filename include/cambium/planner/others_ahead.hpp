#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "cambium/planner/predicted.hpp"

namespace cambium {

/// A prediction of the other agents, made once, step by step. It does not depend on what ego does.
template <class World>
struct OthersAhead {
  std::optional<World> world;
  std::vector<typename World::FrameType> frames;  ///< now and after each step
  std::vector<geometry::OrientedBox> boxes;       ///< of the agents in `to_avoid`, step by step
  std::vector<Slot> to_avoid;                     ///< agents that ego has to keep clear of, see `agents_to_avoid`
  double step{};                                  ///< [s]

  /// Predicts from `now` to `horizon` [s] in steps of `length` [s].
  void predict(World now, Slot ego, double horizon, double length) {
    world = std::move(now);
    step = length;
    agents_to_avoid(*world, ego, to_avoid);
    auto const steps = static_cast<std::size_t>(std::max(1L, std::lround(horizon / step)));
    frames.resize(steps + 1);
    boxes.clear();
    for (std::size_t k = 0; k <= steps; ++k) {
      if (k > 0) (void)world->step(step);
      frames[k] = world->frame();
      for (auto const i : to_avoid) {
        auto box = box_at(*world, i);
        if (!in_traffic(*world, i)) box.half_length = -1e9;  // touches nobody
        boxes.push_back(box);
      }
    }
  }

  /// Whether `box` touches an object, or, after step `k`, an agent in `to_avoid`. O(agents + objects).
  [[nodiscard]] bool touched(geometry::OrientedBox const& box, std::size_t k) const {
    for (std::size_t i = 0; i < to_avoid.size(); ++i)
      if (geometry::intersects(box, boxes[k * to_avoid.size() + i])) return true;
    return std::ranges::any_of(world->roster().objects,
                               [&](auto const& object) { return geometry::intersects(box, object.outline); });
  }

  /// Distance [m] that an agent covers in `time` [s], and its speed then; the speed is constant past the horizon.
  /// O(steps).
  [[nodiscard]] std::pair<double, double> way_of(Slot slot, double time) const {
    double way = 0.0, speed = frames[0].agents[slot].state.speed, left = time;
    for (std::size_t k = 1; k < frames.size() && left > 0.0; ++k, left -= step) {
      double const next = frames[k].agents[slot].state.speed;
      way += 0.5 * (speed + next) * std::min(step, left);
      speed = next;
    }
    return {way + speed * std::max(0.0, left), speed};
  }
};

}  // namespace cambium
