#include <cambium/cambium.hpp>
#include <cambium/map/building/map_builder.hpp>

namespace cb = cambium;

/// Where a car is after a second on a straight road [m].
double place_after_a_second(double speed) {
  cb::MapBuilder builder;
  builder.add_road({.line = cb::map::lay_from({}, {{500.0}}), .sections = {{.right = cb::map::equal_lanes(1)}}});
  cb::World<cb::BehaviorSet<cb::ConstantAcceleration>, cb::InterpolateExecution, cb::SingleTrack> world(builder.build());
  auto const car = world.add({.position = {10.0, -1.75}, .speed = speed});
  return world.step(1.0) ? world.state(car).x : -1.0;
}
