#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <boost/container/small_vector.hpp>

#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/world/frame.hpp"

namespace cambium {

namespace detail {

/// An agent in traffic as the broad phase sees it: a circle about its reference point.
struct Circle {
  double x, y, radius;
  double low;  ///< lower bound along the sorted axis
  Slot slot;

  [[nodiscard]] bool meets(Circle const& other) const {
    double const dx = x - other.x, dy = y - other.y, reach = radius + other.radius;
    return dx * dx + dy * dy <= reach * reach;
  }
};

template <class World>
[[nodiscard]] Circle circle_of(World const& world, Slot slot) {
  auto const& shape = world.roster().agents[slot].shape;
  auto const& state = world.frame().agents[slot].state;
  double const along = std::max(shape.front, shape.rear), across = std::max(shape.left, shape.right);
  return {state.x, state.y, along + across, 0.0, slot};  // the sum of the legs bounds the diagonal without a root
}

template <class World>
[[nodiscard]] geometry::OrientedBox box_at(World const& world, Slot slot) {
  return geometry::box_of(world.roster().agents[slot].shape, world.frame().agents[slot].state);
}

template <class World>
[[nodiscard]] bool in_traffic(World const& world, Slot slot) {
  return world.frame().agents[slot].status == AgentStatus::driving;
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
    if (!detail::in_traffic(world, slot)) return std::nullopt;
    auto const own = [&] {
      auto box = detail::box_at(world, slot);
      box.half_length += margin;
      box.half_width += margin;
      return box;
    };
    auto circle = detail::circle_of(world, slot);
    circle.radius += 2.0 * margin;
    for (Slot i{}; index_of(i) < world.size(); ++i) {
      if (i == slot || !detail::in_traffic(world, i) || !circle.meets(detail::circle_of(world, i))) continue;
      if (geometry::intersects(own(), detail::box_at(world, i))) return Contact{.agent = world.roster().agents[i].id};
    }
    if (world.roster().objects.empty()) return std::nullopt;
    auto const box = own();
    auto const around = box.bounding_box();
    for (auto const& object : world.roster().objects)
      if (around.intersects(object.outline.bounding_box()) && geometry::intersects(box, object.outline))
        return Contact{.object = object.id};
    return std::nullopt;
  }
};

/// Whether an agent causes a collision: it touches a static object, or while it moves an agent that is not behind it
/// (after the at-fault collisions of Dauner et al. 2023). O(agents + objects).
struct AtFaultCollision {
  double standing_speed = 0.05;  ///< a slower vehicle counts as stopped [m/s]

  static constexpr char const* name = "at_fault_collision";
  static constexpr char const* summary = "touches an object, or while it moves an agent that is not behind it";
  static constexpr auto parameters() {
    return parameter_list(parameter("standing_speed", &AtFaultCollision::standing_speed, "m/s", Range{0, 10},
                                    "a slower vehicle counts as stopped"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    if (!detail::in_traffic(world, slot)) return false;
    auto const& ego = world.frame().agents[slot].state;
    double const rear = world.roster().agents[slot].shape.rear;
    auto const own = detail::box_at(world, slot);
    for (auto const& object : world.roster().objects)
      if (geometry::intersects(own, object.outline)) return true;
    if (ego.speed < standing_speed) return false;
    for (Slot i{}; index_of(i) < world.size(); ++i) {
      if (i == slot || !detail::in_traffic(world, i)) continue;
      auto const box = detail::box_at(world, i);
      double const ahead = (box.x - ego.x) * own.cos + (box.y - ego.y) * own.sin;
      if (ahead > -rear && geometry::intersects(own, box)) return true;
    }
    return false;
  }
};

/// Whether any two agents in traffic touch each other, or an agent touches a static object. O(n log n); allocates only
/// for more than 1024 agents.
struct AnyCollision {
  /// Two agents in contact; `second` is none if the contact is with an object.
  struct Pair {
    AgentId first = none<AgentId>, second = none<AgentId>;
  };

  static constexpr char const* name = "any_collision";
  static constexpr char const* summary = "any two agents touch, or an agent and an object";
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
        if (detail::in_traffic(world, i) && touches_object(world, i)) return Pair{world.roster().agents[i].id};
    return world.size() <= few ? compare_all(world) : sweep(world);
  }

 private:
  static constexpr std::size_t few = 32;

  /// The first pair in contact, in the order of the agents. Compares every pair in loops that become SIMD code: for few
  /// agents, this is faster than sorting.
  template <class World>
  [[nodiscard]] static std::optional<Pair> compare_all(World const& world) {
    std::array<double, few> x, y, radius, heading, sin, cos;
    std::array<Slot, few> slots;
    std::size_t count = 0;
    bool bounded = true;
    for (Slot slot{}; index_of(slot) < world.size(); ++slot) {
      if (!detail::in_traffic(world, slot)) continue;
      auto const circle = detail::circle_of(world, slot);
      x[count] = circle.x;
      y[count] = circle.y;
      radius[count] = circle.radius;
      heading[count] = world.frame().agents[slot].state.heading;
      bounded = bounded && std::abs(heading[count]) <= 1e5;  // see sin_cos_bounded
      slots[count++] = slot;
    }
    if (!bounded) return sweep(world);
    auto const meet = [&](std::size_t i, std::size_t j) {
      double const dx = x[j] - x[i], dy = y[j] - y[i], reach = radius[j] + radius[i];
      return dx * dx + dy * dy <= reach * reach;
    };
    auto const box = [&](std::size_t i) {
      return geometry::box_of(world.roster().agents[slots[i]].shape, x[i], y[i], cos[i], sin[i]);
    };
    bool has_directions = false;
    for (std::size_t i = 0; i < count; ++i) {
      std::int64_t near = 0;
      for (std::size_t j = i + 1; j < count; ++j) near += meet(i, j) ? 1 : 0;
      if (near == 0) continue;
      for (std::size_t k = has_directions ? count : 0; k < count; ++k) {
        auto const direction = geometry::sin_cos_bounded(heading[k]);
        sin[k] = direction.sin;
        cos[k] = direction.cos;
      }
      has_directions = true;
      auto const own = box(i);
      for (std::size_t j = i + 1; j < count; ++j)
        if (meet(i, j) && geometry::intersects(own, box(j))) return ordered(world, slots[i], slots[j]);
    }
    return std::nullopt;
  }

  /// The first pair in contact along the axis with the wider spread (sweep and prune).
  template <class World>
  [[nodiscard]] static std::optional<Pair> sweep(World const& world) {
    boost::container::small_vector<detail::Circle, 1024> circles;
    circles.reserve(world.size());
    geometry::Box scene;
    for (Slot slot{}; index_of(slot) < world.size(); ++slot) {
      if (!detail::in_traffic(world, slot)) continue;
      auto const& circle = circles.emplace_back(detail::circle_of(world, slot));
      scene.add(circle.x, circle.y);
    }
    sort_along(circles, scene.max_y - scene.min_y > scene.max_x - scene.min_x);
    for (std::size_t i = 0; i < circles.size(); ++i) {
      auto const& a = circles[i];
      for (std::size_t j = i + 1; j < circles.size() && circles[j].low <= a.x + a.radius; ++j)
        if (a.meets(circles[j]) && touch(world, a.slot, circles[j].slot))
          return ordered(world, a.slot, circles[j].slot);
    }
    return std::nullopt;
  }

  template <class World>
  [[nodiscard]] static bool touches_object(World const& world, Slot slot) {
    auto const box = detail::box_at(world, slot);
    auto const around = box.bounding_box();
    return std::ranges::any_of(world.roster().objects, [&](auto const& object) {
      return around.intersects(object.outline.bounding_box()) && geometry::intersects(box, object.outline);
    });
  }

  template <class World>
  [[nodiscard]] static bool touch(World const& world, Slot a, Slot b) {
    return geometry::intersects(detail::box_at(world, a), detail::box_at(world, b));
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
      if (y) std::swap(c.x, c.y);
      c.low = c.x - c.radius;
    }
    std::sort(circles.begin(), circles.end(),
              [](auto const& a, auto const& b) { return a.low < b.low || (a.low == b.low && a.slot < b.slot); });
  }
};

}  // namespace cambium
