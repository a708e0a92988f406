#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <boost/container/small_vector.hpp>

#include "cambium/core/constants.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/moving_box.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/world/frame.hpp"
#include "cambium/world/static_object.hpp"

namespace cambium::inline v0_1 {

/// Whether the agent at `slot` drives, rather than having left or not yet entered.
template <class World>
[[nodiscard]] bool in_traffic(World const& world, Slot slot) {
  return world.frame().agents[slot].status == AgentStatus::driving;
}

/// The box that the agent at `slot` covers.
template <class World>
[[nodiscard]] geometry::OrientedBox box_at(World const& world, Slot slot) {
  return geometry::box_of(world.roster().agents[slot].shape, world.frame().agents[slot].state);
}

namespace detail {

/// The state of the agent at `slot` before the last step, see `World::before_step`; null if no step led here, or if it
/// did not drive then.
template <class World>
[[nodiscard]] auto const* state_before(World const& world, Slot slot) {
  auto const* const before = world.before_step();
  bool const drove = before != nullptr && (*before)[slot].status == AgentStatus::driving;
  return drove ? &(*before)[slot].state : nullptr;
}

}  // namespace detail

/// The motion of the box of the agent at `slot` in the last step, see `World::before_step`. It rests where it is if the
/// agent was not in traffic before, or if no step led to the world's frame. Enlarged by `margin` [m] on all sides.
template <class World>
[[nodiscard]] geometry::MovingBox motion_at(World const& world, Slot slot, double margin = 0.0) {
  auto shape = world.roster().agents[slot].shape;
  for (auto* const side : {&shape.front, &shape.rear, &shape.left, &shape.right}) *side += margin;
  auto const& now = world.frame().agents[slot].state;
  if (auto const* const from = detail::state_before(world, slot)) return {shape, *from, now};
  return {shape, geometry::Pose{now.x, now.y, now.heading}};
}

namespace detail {

/// An agent in traffic as the broad phase sees it: a circle about its reference point.
struct Circle {
  double x, y, radius;

  [[nodiscard]] bool meets(Circle const& other) const {
    double const dx = x - other.x, dy = y - other.y, reach = radius + other.radius;
    return dx * dx + dy * dy <= reach * reach;
  }
};

/// A circle that moves from (x, y) minus its half way to (x, y) plus it.
struct MovingCircle {
  double x, y, radius;
  double low;  ///< lower bound along the sorted axis
  double half_x, half_y;
  double deviation;  ///< bound on that from an even motion [m]; part of the radius
  Slot slot;

  /// Bound on half the way [m] relative to another one that also moves evenly.
  [[nodiscard]] double half_way(MovingCircle const& other) const {
    return std::abs(half_x - other.half_x) + std::abs(half_y - other.half_y);
  }

  [[nodiscard]] bool meets(MovingCircle const& other) const {
    double const dx = x - other.x, dy = y - other.y, reach = radius + other.radius + half_way(other);
    return dx * dx + dy * dy <= reach * reach;
  }
};

template <class World>
[[nodiscard]] inline Circle circle_of(World const& world, Slot slot) {
  auto const& shape = world.roster().agents[slot].shape;
  auto const& state = world.frame().agents[slot].state;
  double const along = std::max(shape.front, shape.rear), across = std::max(shape.left, shape.right);
  return {state.x, state.y, along + across};  // the sum of the legs bounds the diagonal without a root
}

/// The circle of the agent at `slot` over the last step. `before`: `World::before_step`.
template <class World, class Before>
[[nodiscard]] MovingCircle moving_circle_of(World const& world, Before const* before, Slot slot) {
  auto const [x, y, radius] = circle_of(world, slot);
  if (!before || (*before)[slot].status != AgentStatus::driving) return {x, y, radius, 0.0, 0.0, 0.0, 0.0, slot};
  auto const &from = (*before)[slot].state, &to = world.frame().agents[slot].state;
  double const half_x = 0.5 * (to.x - from.x), half_y = 0.5 * (to.y - from.y);
  double const deviation = geometry::MovingBox::deviation(radius, from, to);
  return {x - half_x, y - half_y, radius + deviation, 0.0, half_x, half_y, deviation, slot};
}

/// The box of the agent at `slot` after `time` [s] at constant velocity.
template <class World>
[[nodiscard]] geometry::OrientedBox box_after(World const& world, Slot slot, double time) {
  auto box = box_at(world, slot);
  double const way = world.frame().agents[slot].state.speed * time;
  box.x += way * box.cos;
  box.y += way * box.sin;
  return box;
}

/// How far the middle of `other` lies ahead of the reference point of the agent at `slot`, along its heading [m].
template <class World>
[[nodiscard]] double distance_ahead(World const& world, Slot slot, geometry::OrientedBox const& other) {
  auto const& state = world.frame().agents[slot].state;
  auto const along = portable::sin_cos(state.heading);
  return (other.x - state.x) * along.cos + (other.y - state.y) * along.sin;
}

/// 150 degrees: who is farther off an agent's heading, seen from its rear axle, is behind it, as in nuPlan's metrics.
inline constexpr double behind_bearing = 5.0 / 6.0 * geometry::pi;

/// How far off the heading of the agent at `slot` the middle of `other` is, seen from its reference point [rad].
template <class World>
[[nodiscard]] double bearing_of(World const& world, Slot slot, geometry::OrientedBox const& other) {
  auto const& state = world.frame().agents[slot].state;
  return std::abs(geometry::angle_difference(portable::atan2(other.y - state.y, other.x - state.x), state.heading));
}

/// Whether the middle of `other` is behind a vehicle that covers `own`.
[[nodiscard]] inline bool is_behind(geometry::Shape const& shape, geometry::OrientedBox const& own,
                                    geometry::OrientedBox const& other) {
  double const ahead = 0.5 * (shape.front - shape.rear), left = 0.5 * (shape.left - shape.right);
  double const dx = other.x - own.x, dy = other.y - own.y;
  return std::abs(portable::atan2(dy * own.cos - dx * own.sin + left, dx * own.cos + dy * own.sin + ahead)) >
         behind_bearing;
}

/// The higher of an agent's speeds before and after the last step [m/s].
template <class World>
[[nodiscard]] double speed_in_step(World const& world, Slot slot) {
  double const now = world.frame().agents[slot].state.speed;
  auto const* const before = state_before(world, slot);
  return before != nullptr ? std::max(now, double{before->speed}) : now;
}

/// Whether the agent's body is between the borders of its lane, at its rear, its reference point and its front; it may
/// be beyond them by `tolerance` [m]. O(1).
template <class World>
[[nodiscard]] bool within_lane(World const& world, Slot slot, double tolerance = 0.0) {
  auto const& place = world.frame().agents[slot].lane;
  auto const& agent = world.roster().agents[slot];
  auto const& corridor = agent.road->corridors[place.corridor];
  auto const& state = world.frame().agents[slot].state;
  auto const heads = portable::sin_cos(state.heading);
  auto const fits = [&](double s, std::uint32_t segment, double lateral) {
    auto const sides = corridor.widths_at(std::clamp(s, 0.0, corridor.length()), segment);
    return lateral + agent.shape.left <= sides.left + tolerance &&
           agent.shape.right - lateral <= sides.right + tolerance;
  };
  auto const fits_at = [&](double along) {
    auto const foot =
        corridor.center.project({state.x + along * heads.cos, state.y + along * heads.sin}, place.segment);
    return fits(foot.s, foot.segment, foot.lateral);
  };
  return fits(place.s, place.segment, place.lateral) && fits_at(-agent.shape.rear) && fits_at(agent.shape.front);
}

/// The first static object that a box or a moving box touches, or nothing. O(objects).
template <class World, class AnyBox>
[[nodiscard]] StaticObject const* touched_object(World const& world, AnyBox const& box) {
  auto const& objects = world.roster().objects;
  auto const around = box.bounding_box();
  auto const touched = std::ranges::find_if(objects, [&](StaticObject const& object) {
    return around.intersects(object.outline.bounding_box()) && geometry::intersects(box, object.outline);
  });
  return touched == objects.end() ? nullptr : &*touched;
}

/// Whether the agent at `slot` drives, or has left traffic in the last step after driving in it.
template <class World>
[[nodiscard]] bool drove_in_step(World const& world, Slot slot) {
  auto const* const before = world.before_step();
  return in_traffic(world, slot) ||
         (before != nullptr && drove((*before)[slot].status, world.frame().agents[slot].status));
}

/// Calls `f(other)` for the slot of each agent that the one at `slot` touches or touched during the last step, in which
/// both may have left traffic. A distance below `margin` [m] counts as contact. O(agents).
template <class World, class F>
void for_each_touched(World const& world, Slot slot, F const& f, double margin = 0.0) {
  if (!drove_in_step(world, slot)) return;
  auto const* const before = world.before_step();
  auto own = moving_circle_of(world, before, slot);
  own.radius += 2.0 * margin;
  for (Slot other{}; index_of(other) < world.size(); ++other)
    if (other != slot && drove_in_step(world, other) && own.meets(moving_circle_of(world, before, other)) &&
        geometry::intersects(motion_at(world, slot, margin), motion_at(world, other)))
      f(other);
}

/// The first static object that the agent at `slot` touches or touched during the last step, or nothing. O(objects).
template <class World>
[[nodiscard]] StaticObject const* touched_object_in_step(World const& world, Slot slot) {
  if (world.roster().objects.empty() || !drove_in_step(world, slot)) return nullptr;
  return touched_object(world, motion_at(world, slot));
}

}  // namespace detail

/// What an agent touches: another agent or a static object.
struct Contact {
  AgentId agent = none<AgentId>;
  ObjectId object = none<ObjectId>;
};

/// Whether an agent in traffic touches another agent or a static object. With a `margin` [m], the agent's box is
/// enlarged by it on all sides. O(agents + objects).
struct Collision {
  double margin = 0.0;

  static constexpr char const* name = "collision";
  static constexpr char const* summary = "touches another agent or a static object";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("margin", &Collision::margin, "m", Range{0, 100}, "a smaller distance counts as contact"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    return contact(world, slot).has_value();
  }

  /// The first contact: agents in the order of their ids, then objects.
  template <class World>
  [[nodiscard]] std::optional<Contact> contact(World const& world, Slot slot) const {
    if (!in_traffic(world, slot)) return std::nullopt;
    auto const own = [&] {
      auto box = box_at(world, slot);
      box.half_length += margin;
      box.half_width += margin;
      return box;
    };
    auto circle = detail::circle_of(world, slot);
    circle.radius += 2.0 * margin;
    for (Slot i{}; index_of(i) < world.size(); ++i) {
      if (i == slot || !in_traffic(world, i) || !circle.meets(detail::circle_of(world, i))) continue;
      if (geometry::intersects(own(), box_at(world, i))) return Contact{.agent = world.roster().agents[i].id};
    }
    if (world.roster().objects.empty()) return std::nullopt;
    auto const* const object = detail::touched_object(world, own());
    return object ? std::optional(Contact{.object = object->id}) : std::nullopt;
  }

  /// Whether an agent touches anything, or touched it during the last step, also between its two frames; of objects,
  /// without the margin. O(agents + objects).
  template <class World>
  [[nodiscard]] bool in_last_step(World const& world, Slot slot) const {
    bool touches = false;
    detail::for_each_touched(
        world, slot, [&](Slot) { touches = true; }, margin);
    return touches || detail::touched_object_in_step(world, slot) != nullptr;
  }
};

/// Whether an agent is to blame for what it touches, by the rules of nuPlan (Karnchanachari et al. 2024) and of PDM
/// (Dauner et al. 2023). The first that fits decides:
///
/// | | at fault |
/// |---|---|
/// | the agent stands, slower than `blameless_speed` | no |
/// | the other stands, or is a static object | yes |
/// | the other's middle is more than 150 degrees off the agent's heading, seen from its rear axle | no |
/// | the front side of the agent touches the other | yes |
/// | they touch otherwise | if the agent is not within its lane |
///
/// Neither the right of way counts, nor whether there was time to react. `in_last_step` judges by where two touched
/// first in a step, and by the higher of their speeds before and after it: a stop in that step hides nothing. With a
/// `look_ahead`, whether it will touch an object, or an agent that is ahead of its reference point now, if all keep
/// their velocities. O(agents + objects).
struct AtFaultCollision {
  double blameless_speed = cambium::blameless_speed;
  double look_ahead = 0.0;

  static constexpr char const* name = "at_fault_collision";
  static constexpr char const* summary = "is to blame for what it touches, by the rules of nuPlan";
  static constexpr char const* source = "Karnchanachari et al. 2024; Dauner et al. 2023";
  static constexpr auto parameters() {
    using P = AtFaultCollision;
    return parameter_list(
        parameter("blameless_speed", &P::blameless_speed, "m/s", Range{0, 10}, "a slower vehicle counts as stopped"),
        parameter("look_ahead", &P::look_ahead, "s", Range{0, 60}, "time from now, at constant velocities"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    if (!in_traffic(world, slot)) return false;
    if (hits_object(world, slot)) return true;
    for (Slot other{}; index_of(other) < world.size(); ++other)
      if (other != slot && hits(world, slot, other)) return true;
    return false;
  }

  /// The same, but of the other agents only those at the slots `others` count.
  template <class World>
  [[nodiscard]] bool among(World const& world, Slot slot, std::span<Slot const> others) const {
    return in_traffic(world, slot) && (hits_object(world, slot) || std::ranges::any_of(others, [&](Slot other) {
                                         return hits(world, slot, other);
                                       }));
  }

  /// Whether an agent is to blame for anything that it touched during the last step, also between its two frames.
  template <class World>
  [[nodiscard]] bool in_last_step(World const& world, Slot slot) const {
    if (detail::speed_in_step(world, slot) <= blameless_speed) return false;
    bool is_to_blame = detail::touched_object_in_step(world, slot) != nullptr;
    detail::for_each_touched(world, slot, [&](Slot other) {
      if (is_to_blame) return;
      is_to_blame = detail::speed_in_step(world, other) <= blameless_speed;
      if (is_to_blame) return;
      auto const own = motion_at(world, slot), its = motion_at(world, other);
      double const first = first_touch(own, its);
      is_to_blame = blames(world, slot, own.at(first), its.at(first));
    });
    return is_to_blame;
  }

 private:
  /// When two moving boxes touch first, as a share of their motion, by at most 1 cm; 1 if they do not before. Advances
  /// by their gap (Mirtich 1996).
  [[nodiscard]] static double first_touch(geometry::MovingBox const& a, geometry::MovingBox const& b) {
    constexpr double depth = 0.01;  // [m]
    double const way = longest_way(a, b);
    double time = 0.0;
    for (int step = 0; time < 1.0 && step < 10'000; ++step) {
      double const gap = geometry::separation(a.at(time), b.at(time));
      if (gap <= 0.0) break;
      time = std::min(1.0, time + (gap + depth) / way);
    }
    return time;
  }

  template <class World>
  [[nodiscard]] bool stands(World const& world, Slot slot) const {
    return world.frame().agents[slot].state.speed <= blameless_speed;
  }

  template <class World>
  [[nodiscard]] bool hits_object(World const& world, Slot slot) const {
    if (world.roster().objects.empty() || stands(world, slot)) return false;
    return detail::touched_object(world, detail::box_after(world, slot, look_ahead)) != nullptr;
  }

  template <class World>
  [[nodiscard]] bool hits(World const& world, Slot slot, Slot other) const {
    if (stands(world, slot) || !in_traffic(world, other)) return false;
    auto const own = box_at(world, slot), its = box_at(world, other);
    if (look_ahead > 0.0)
      return detail::distance_ahead(world, slot, its) > 0.0 &&
             geometry::intersects(detail::box_after(world, slot, look_ahead),
                                  detail::box_after(world, other, look_ahead));
    if (!geometry::intersects(own, its)) return false;
    return stands(world, other) || blames(world, slot, own, its);
  }

  /// The last three rules, where the two touch.
  template <class World>
  [[nodiscard]] static bool blames(World const& world, Slot slot, geometry::OrientedBox const& own,
                                   geometry::OrientedBox const& its) {
    if (detail::is_behind(world.roster().agents[slot].shape, own, its)) return false;
    auto front = own;
    front.x += own.half_length * own.cos;
    front.y += own.half_length * own.sin;
    front.half_length = 0.0;
    return geometry::intersects(front, its) || !detail::within_lane(world, slot);
  }
};

/// Whether any two agents in traffic touch each other or did so during the last step, or an agent and a static object.
/// O(n log n); allocates only for more than 1024 agents.
struct AnyCollision {
  /// Two agents in contact; `second` is none if the contact is with an object.
  struct Pair {
    AgentId first = none<AgentId>, second = none<AgentId>;
  };

  static constexpr char const* name = "any_collision";
  static constexpr char const* summary = "any two agents touch or did in the last step, or an agent and an object";
  static constexpr auto parameters() { return parameter_list(); }

  /// The same for every slot.
  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot = {}) const {
    return pair(world).has_value();
  }

  template <class World>
  [[nodiscard]] std::optional<Pair> pair(World const& world) const {
    if (!world.roster().objects.empty())
      for (Slot i{}; index_of(i) < world.size(); ++i)
        if (in_traffic(world, i) && detail::touched_object(world, motion_at(world, i)))
          return Pair{world.roster().agents[i].id};
    return world.size() <= few ? compare_all(world) : sweep(world);
  }

 private:
  static constexpr std::size_t few = 32;

  /// The first pair in contact, in the order of the agents. Compares every pair in loops that become SIMD code: for few
  /// agents, this is faster than sorting.
  template <class World>
  [[nodiscard]] static std::optional<Pair> compare_all(World const& world) {
    std::array<double, few> x, y, half_x, half_y, radius, deviation, heading, sin, cos;
    std::array<Slot, few> slots;
    std::size_t count = 0;
    bool bounded = true;
    auto const* const before = world.before_step();
    for (Slot slot{}; index_of(slot) < world.size(); ++slot) {
      if (!in_traffic(world, slot)) continue;
      auto const circle = detail::moving_circle_of(world, before, slot);
      x[count] = circle.x;
      y[count] = circle.y;
      half_x[count] = circle.half_x;
      half_y[count] = circle.half_y;
      radius[count] = circle.radius;
      deviation[count] = circle.deviation;
      heading[count] = world.frame().agents[slot].state.heading;
      bounded = bounded && std::abs(heading[count]) <= 1e5;  // see sin_cos_bounded
      slots[count++] = slot;
    }
    if (!bounded) return sweep(world);
    auto const half_way = [&](std::size_t i, std::size_t j) {
      return std::abs(half_x[j] - half_x[i]) + std::abs(half_y[j] - half_y[i]);
    };
    auto const meet = [&](std::size_t i, std::size_t j) {
      double const dx = x[j] - x[i], dy = y[j] - y[i], reach = radius[j] + radius[i] + half_way(i, j);
      return dx * dx + dy * dy <= reach * reach;
    };
    auto const box = [&](std::size_t i) {
      return geometry::box_of(world.roster().agents[slots[i]].shape, x[i] + half_x[i], y[i] + half_y[i], cos[i],
                              sin[i]);
    };
    bool has_directions = false;
    for (std::size_t i = 0; i < count; ++i) {
      std::int64_t near = 0;
      for (std::size_t j = i + 1; j < count; ++j) near += meet(i, j) ? 1 : 0;
      if (near == 0) continue;
      for (std::size_t k = has_directions ? count : 0; k < count; ++k) {
        auto const direction = portable::sin_cos_bounded(heading[k]);
        sin[k] = direction.sin;
        cos[k] = direction.cos;
      }
      has_directions = true;
      auto const own = box(i);
      for (std::size_t j = i + 1; j < count; ++j)
        if (meet(i, j) &&
            touch(world, slots[i], slots[j], own, box(j), 2.0 * half_way(i, j) + deviation[i] + deviation[j]))
          return ordered(world, slots[i], slots[j]);
    }
    return std::nullopt;
  }

  /// The first pair in contact along the axis with the wider spread (sweep and prune).
  template <class World>
  [[nodiscard]] static std::optional<Pair> sweep(World const& world) {
    boost::container::small_vector<detail::MovingCircle, 1024> circles;
    circles.reserve(world.size());
    geometry::Box scene;
    auto const* const before = world.before_step();
    for (Slot slot{}; index_of(slot) < world.size(); ++slot) {
      if (!in_traffic(world, slot)) continue;
      auto const& circle = circles.emplace_back(detail::moving_circle_of(world, before, slot));
      scene.add(circle.x, circle.y);
    }
    sort_along(circles, scene.max_y - scene.min_y > scene.max_x - scene.min_x);
    for (std::size_t i = 0; i < circles.size(); ++i) {
      auto const& a = circles[i];
      double const high = a.x + a.radius + std::abs(a.half_x);
      for (std::size_t j = i + 1; j < circles.size() && circles[j].low <= high; ++j)
        if (auto const& b = circles[j];
            a.meets(b) && touch(world, a.slot, b.slot, box_at(world, a.slot), box_at(world, b.slot),
                                2.0 * a.half_way(b) + a.deviation + b.deviation))
          return ordered(world, a.slot, b.slot);
    }
    return std::nullopt;
  }

  /// Whether two agents whose boxes are `a` and `b` now touch or did so during the last step, in which no point of one
  /// made more than `way` [m] relative to the other.
  template <class World>
  [[nodiscard]] static bool touch(World const& world, Slot i, Slot j, geometry::OrientedBox const& a,
                                  geometry::OrientedBox const& b, double way) {
    double const gap = geometry::separation(a, b);
    return gap <= 0.0 || (gap <= way && geometry::intersects(motion_at(world, i), motion_at(world, j)));
  }

  template <class World>
  [[nodiscard]] static Pair ordered(World const& world, Slot a, Slot b) {
    auto const& agents = world.roster().agents;
    return {agents[std::min(a, b)].id, agents[std::max(a, b)].id};
  }

  /// Sorts the circles by their lower bounds along x, or along y after swapping the axes; distances do not change.
  template <class Circles>
  static void sort_along(Circles& circles, bool y) {
    for (auto& c : circles) {
      if (y) std::swap(c.x, c.y), std::swap(c.half_x, c.half_y);
      c.low = c.x - c.radius - std::abs(c.half_x);
    }
    std::sort(circles.begin(), circles.end(),
              [](auto const& a, auto const& b) { return a.low < b.low || (a.low == b.low && a.slot < b.slot); });
  }
};

}  // namespace cambium::inline v0_1
