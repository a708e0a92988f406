#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "cambium/planner/predicted.hpp"

namespace cambium::detail {

/// A prediction of the other agents, made once, step by step. It does not depend on what ego does.
template <class World>
struct OthersAhead {
  std::optional<World> world;
  std::vector<typename World::FrameType> frames;  ///< now and after each step
  std::vector<geometry::OrientedBox> boxes;       ///< of the agents in `counting`, step by step
  std::vector<Slot> counting;                     ///< agents that ego has to keep clear of, see `choose_counting`
  double step{};                                  ///< [s]

  /// Predicts from `now` to `horizon` [s] in steps of `length` [s].
  void predict(World now, Slot ego, double horizon, double length) {
    world = std::move(now);
    step = length;
    choose_counting(*world, ego, counting);
    auto const steps = static_cast<std::size_t>(std::max(1L, std::lround(horizon / step)));
    frames.resize(steps + 1);
    boxes.clear();
    for (std::size_t k = 0; k <= steps; ++k) {
      if (k > 0) (void)world->step(step);
      frames[k] = world->frame();
      for (auto const i : counting) {
        auto box = box_at(*world, i);
        if (!in_traffic(*world, i)) box.half_length = -1e9;  // touches nobody
        boxes.push_back(box);
      }
    }
  }

  /// Whether `box` touches an object, or, after step `k`, an agent in `counting`. O(agents + objects).
  [[nodiscard]] bool touched(geometry::OrientedBox const& box, std::size_t k) const {
    for (std::size_t i = 0; i < counting.size(); ++i)
      if (geometry::intersects(box, boxes[k * counting.size() + i])) return true;
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

/// Whether `box`, the box of `shape` at corridor position `s`, `offset` [m] and `heading_error` [rad], reaches beyond
/// the drivable lanes or into an oncoming lane. False past the ends of the corridor, where the road is unknown.
[[nodiscard]] inline bool leaves_road(Map const& map, map::LaneCorridor const& corridor, double s, double offset,
                                      double heading_error, geometry::Shape const& shape,
                                      geometry::OrientedBox const& box) {
  if (s < 0.0 || s > corridor.length()) return false;
  auto segment = corridor.center.find(s);
  auto const sides = corridor.widths_at(s, segment);
  // Quick test: it fits into the narrowest of the widths at its rear, middle and front.
  double const longer = std::max(shape.front, shape.rear);
  double const bend = 0.5 * std::abs(corridor.center.segments()[segment].curvature) * longer;
  double const reach = box.half_width + (std::abs(heading_error) + bend) * longer + 0.05;  // [m]
  bool is_inside = true;
  for (double const at : {s, s + shape.front, s - shape.rear}) {
    corridor.center.segment_at(at, segment);
    auto const here = corridor.widths_at(at, segment);
    is_inside = is_inside && offset + reach < here.left && -offset + reach < here.right;
  }
  if (is_inside) return false;
  if ((offset > sides.left || -offset > sides.right) && is_against_traffic(map, box)) return true;
  return std::ranges::any_of(box.corners(), [&](geometry::Point const& corner) {
    double const at = corridor.center.project(corner, corridor.center.find(s)).s;
    return at > 0.0 && at < corridor.length() && !map.on_drivable_lane(corner);
  });
}

}  // namespace cambium::detail
