#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/world/frame.hpp"

namespace cambium {

/// Whether an agent, while it takes part in traffic, has left the drivable lanes of the map: a corner of its box or the
/// middle of a side lies in none. Throws `WorldError` if the world does not have the agent. O(log lanes); O(1) well
/// inside the own lane.
struct DrivableArea {
  struct Result {
    bool off_road = false;
  };

  AgentId agent = none<AgentId>;

  template <class World>
  [[nodiscard]] Result evaluate(World const& world) const {
    return {off_road(world, world.slot_of(agent))};
  }

  /// The same for the agent at `slot` of the roster.
  template <class World>
  [[nodiscard]] static bool off_road(World const& world, std::size_t slot) {
    auto const& record = world.frame().agents[slot];
    if (record.status != AgentStatus::driving || inside_own_lane(world, slot)) return false;
    auto const& s = record.state;
    auto const box = geometry::box_of(world.roster().agents[slot].shape, {s.x, s.y, s.heading});
    auto const corners = box.corners();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      auto const& corner = corners[i];
      geometry::Point const middle = 0.5 * (corner + corners[(i + 1) % corners.size()]);
      if (beyond_road(world, slot, corner) || beyond_road(world, slot, middle)) return true;
    }
    return false;
  }

 private:
  /// A box within the narrower of the lane's widths at its rear and front, and straight enough, is inside. [m, rad]
  template <class World>
  [[nodiscard]] static bool inside_own_lane(World const& world, std::size_t slot) {
    auto const& agent = world.roster().agents[slot];
    auto const& at = world.frame().agents[slot].lane;
    auto const& corridor = agent.road->corridors[at.corridor];
    auto const& shape = agent.shape;
    double const rear = at.s - shape.rear, front = at.s + shape.front;
    if (rear < 0 || front > corridor.length()) return false;
    double const reach = std::max(shape.front, shape.rear);
    double bend = 0.0;  // all turns between rear and front, to whichever side
    auto const segments = corridor.center.segments();
    for (auto i = corridor.center.find(rear); i < segments.size() && segments[i].s < front; ++i)
      bend += std::abs(segments[i].curvature) * segments[i].length;
    double const margin = (std::abs(at.heading_error) + bend) * reach + 0.1;
    auto const fits = [&](double s) {
      auto const widths = corridor.widths_at(s, corridor.center.find(s));
      return at.lateral + shape.left + margin < widths.left && at.lateral - shape.right - margin > -widths.right;
    };
    return fits(at.s) && fits(rear) && fits(front);
  }

  /// In no lane; past the end of the agent's own road does not count: the map ends there, not the road.
  template <class World>
  [[nodiscard]] static bool beyond_road(World const& world, std::size_t slot, geometry::Point const& p) {
    if (world.map().on_drivable_lane(p)) return false;
    auto const& at = world.frame().agents[slot].lane;
    auto const& corridor = world.roster().agents[slot].road->corridors[at.corridor];
    auto const foot = corridor.center.project(p, at.segment);
    if (foot.s > 0.0 && foot.s < corridor.length()) return true;
    auto const end = foot.s <= 0.0 ? corridor.widths.front() : corridor.widths.back();
    return foot.lateral > end.left || foot.lateral < -end.right;
  }
};

}  // namespace cambium
