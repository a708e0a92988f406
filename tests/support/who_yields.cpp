#include "who_yields.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/evaluation/rules/relative_place.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/world/world.hpp"
#include "maps.hpp"

using namespace cambium;

namespace support {

WhoYields::WhoYields(std::string const& file) : map(own_map(file)) {
  auto const through = [&](LaneId inside) -> map::Route {
    auto const& lane = map->lane(inside);
    return {{lane.predecessors.front(), inside, lane.successors.front()}, 0.0};
  };
  for (auto const& lane : map->lanes()) {
    if (!lane.drivable() || !lane.predecessors.empty()) continue;
    for (auto const inside : lane.successors) {
      World<BehaviorSet<ConstantAcceleration>, InterpolateExecution, SingleTrack> world(map);
      own = through(inside);
      auto const pose = lane.path.pose(5.0);
      world.add({.position = pose.position(), .heading = pose.heading, .speed = 5, .route = own});
      for (auto const& conflict : detail::corridor_of(world, Slot{0}).conflicts) {
        bool const crosses = conflict.right_of_way == map::RightOfWay::yields && !conflict.zones[0][0].empty() &&
                             conflict.kind == map::OverlapKind::crossing;
        if (!crosses || map->lane(conflict.other).predecessors.empty()) continue;
        zone = conflict.zones[0][0];
        light = conflict.other_light;
        other = through(conflict.other);
        return;
      }
    }
  }
  throw std::runtime_error(file + ": nobody yields");
}

namespace {

std::pair<LaneId, double> place(Map const& map, map::Route const& route, double s) {
  auto const before = map.lane(route.lanes[0]).length();
  return s < before ? std::pair(route.lanes[0], s) : std::pair(route.lanes[1], s - before);
}

}  // namespace

std::pair<LaneId, double> WhoYields::own_place(double way) const { return place(*map, own, zone.begin - way); }
std::pair<LaneId, double> WhoYields::other_place(double way) const {
  return place(*map, other, map->lane(other.lanes[0]).length() + zone.other_begin - way);
}

}  // namespace support
