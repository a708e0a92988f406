// Lane tracking on real maps: from many lanes of each, through whatever curves and junctions come.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "../support/corpus.hpp"
#include "../support/maps.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/following/idm_lane_tracking.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/world/world.hpp"

namespace cb = cambium;

TEST_CASE("lane tracking stays near the centre line on every map of the corpus") {
  auto const root = corpus::root();
  if (!root) return;
  using World = cb::World<cb::BehaviorSet<cb::IdmLaneTracking>, cb::InterpolateExecution, cb::SingleTrack>;
  std::size_t drives = 0, steps = 0, off = 0;
  double worst = 0.0;
  for (auto const& file : corpus::maps(*root / "opendrive")) {
    std::shared_ptr<cb::Map const> map;
    try {
      map = cambium::load_opendrive(file.string()).map;
    } catch (cb::Error const&) {
      continue;  // files that are wrong on purpose
    }
    auto const& lanes = map->lanes();
    std::size_t const stride = std::max<std::size_t>(1, lanes.size() / 15);
    for (std::size_t i = 0; i < lanes.size(); i += stride) {
      if (!lanes[i].drivable() || lanes[i].length() < 15.0) continue;
      World world(map);
      auto const pose = lanes[i].path.pose(2.0);
      auto const id = world.add({.position = pose.position(), .heading = pose.heading, .speed = 3.0});
      ++drives;
      for (int k = 0; k < 100 && world.status(id) == cb::AgentStatus::driving; ++k) {
        CAPTURE(file.string());
        CAPTURE(i);
        REQUIRE(world.step(0.2));
        auto const& at = world.record(id).lane;
        ++steps;
        off += std::abs(at.lateral) > 0.8;
        worst = std::max(worst, std::abs(at.lateral));
      }
    }
  }
  MESSAGE(drives << " drives of " << steps << " steps; rear axle off the centre line by at most " << worst
                 << " m, by more than 0.8 m in " << off << " steps");
  CHECK(drives > 100);
  CHECK(static_cast<double>(off) < 0.002 * static_cast<double>(steps));
}
