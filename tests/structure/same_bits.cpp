// Prints a hash of where traffic drives, for each of several drivers, on a map with bends, a junction and a lane that
// ends. It links no library but the standard one, so that any compiler and any libm can run it: see same_bits.sh.

#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "cambium/behavior.hpp"
#include "cambium/execution/lqr.hpp"
#include "cambium/execution/stanley.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/building/road_plan.hpp"
#include "cambium/map/road/curve_layout.hpp"

#include "../../bench/yardstick/driven.hpp"

namespace cb = cambium;
namespace m = cambium::map;

namespace {

/// Four arms with bends around a junction, one of them with a lane that ends.
std::shared_ptr<cb::Map const> crossing() {
  m::MapBuilder builder;
  builder.add_junction("100");
  constexpr auto end = m::opendrive::ContactPoint::end;
  for (int i = 0; i < 4; ++i) {
    double const angle = 0.3 + 0.5 * cb::geometry::pi * i;
    auto const at = cb::geometry::to_map({0.0, 0.0, angle}, {25.0, 0.0});
    m::RoadPlan arm{.id = std::to_string(i + 1),
                    .line = m::lay_to({at.x(), at.y(), angle + cb::geometry::pi},
                                      {{60.0, 0.0, 0.01}, {50.0, 0.01, -0.004}, {40.0}}),
                    .sections = {{.left = m::equal_lanes(2), .right = m::equal_lanes(2)}},
                    .speed_limit = 14.0};
    if (i == 3)
      arm.sections.push_back({.s = 60.0, .left = m::equal_lanes(2), .right = {{}, {.end_width = 0.0, .next = 0}}});
    if (i == 3) arm.sections.push_back({.s = 110.0, .left = m::equal_lanes(2), .right = m::equal_lanes(1)});
    builder.add_road(std::move(arm));
  }
  for (int i = 0; i < 4; ++i) {
    auto const arm = [i](int further) { return m::RoadEnd{std::to_string((i + further) % 4 + 1), end}; };
    builder.add_turn("100", arm(0), arm(2), {.lanes = {{-1, 1}}});
    builder.add_turn("100", arm(0), arm(1), {.lanes = {{i == 3 ? -1 : -2, 2}}});
    builder.add_turn("100", arm(0), arm(3), {.lanes = {{-1, 1}}});
  }
  return builder.build();
}

template <class... Behaviors>
void print(std::shared_ptr<cb::Map const> const& map) {
  (std::printf("%s\n", yardstick::driven<Behaviors>("crossing", map).c_str()), ...);
}

}  // namespace

int main() {
  auto const map = crossing();
  for (auto const& lane : map->lanes())
    for (auto const& segment : lane.path.segments()) std::printf("%a %a %a\n", segment.x, segment.y, segment.heading);
  print<cb::UrbanDriver, cb::AdaptiveCruiseControl, cb::IdmStochastic, cb::HumanDriver<cb::Mobil>,
        cb::RssConformant<cb::IdmClassic>, cb::Pedestrian>(map);
  std::printf("%s\n", yardstick::driven<cb::IdmLaneTracking, cb::StanleyExecution>("crossing, Stanley", map).c_str());
  std::printf("%s\n", yardstick::driven<cb::Mobil, cb::LqrExecution>("crossing, LQR", map).c_str());
}
