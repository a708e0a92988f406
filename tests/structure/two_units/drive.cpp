// Uses a map that another translation unit makes: worlds, routes, corridors and areas need nothing more.

#include <cambium/cambium.hpp>

namespace cb = cambium;

using Set = cb::BehaviorSet<cb::IdmClassic, cb::Mobil>;
using World = cb::World<Set, cb::InterpolateExecution, cb::SingleTrack>;

/// How far a car drives on the map in 10 s [m]; negative where a step is not valid.
double drive(std::shared_ptr<cb::Map const> const& map) {
  auto const start = map->find_lane("1", 10.0, -1);
  auto const route = cb::map::straight_route(*map, start);
  if (cb::map::build_road_corridor(*map, route)->corridors.empty()) return -1.0;
  for (auto const& junction : map->junctions())
    if (!cb::map::conflict_areas(*map, junction.id).empty() && !cb::map::junction_area(*map, junction.id)) return -1.0;
  World world(map, {.seed = 1});
  auto const at = map->lane(start).path.pose(10.0).position();
  auto const car = world.add({.position = at, .speed = 10.0, .behavior = cb::Mobil{}});
  for (int i = 0; i < 50; ++i)
    if (!world.step(0.2)) return -1.0;
  return (cb::geometry::Point(world.state(car).x, world.state(car).y) - at).norm();
}
