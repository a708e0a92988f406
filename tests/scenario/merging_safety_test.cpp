// Dense traffic with many trucks merges without a collision, whatever the driver model and the step.
// CAMBIUM_MERGING_RUNS is how many situations are drawn for each map, model and step.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <type_traits>
#include <variant>

#include "../support/maps.hpp"
#include "cambium/behavior/following/adaptive_cruise_control.hpp"
#include "cambium/behavior/following/idm_lane_tracking.hpp"
#include "cambium/behavior/lane_change/mobil.hpp"
#include "cambium/behavior/lane_change/zip_merge.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/scenario/merging_site.hpp"

using namespace cambium;

namespace {

std::uint32_t runs() {
  char const* const asked = std::getenv("CAMBIUM_MERGING_RUNS");
  return asked ? static_cast<std::uint32_t>(std::strtoul(asked, nullptr, 10)) : 150;
}

/// The sampled driver as another model.
template <class Behavior>
Behavior driver(IdmClassic const& idm) {
  if constexpr (std::is_same_v<Behavior, IdmClassic>) {
    return idm;
  } else {
    Behavior behavior;
    behavior.idm = {.desired_speed = idm.desired_speed,
                    .time_headway = idm.time_headway,
                    .minimum_gap = idm.minimum_gap,
                    .maximum_acceleration = idm.maximum_acceleration,
                    .comfortable_deceleration = idm.comfortable_deceleration};
    return behavior;
  }
}

}  // namespace

TEST_CASE_TEMPLATE("dense traffic with a third of trucks merges without a collision", Behavior, IdmClassic,
                   AdaptiveCruiseControl, IdmLaneTracking, Mobil, ZipMerge) {
  using Sim = World<BehaviorSet<Behavior>, InterpolateExecution, SingleTrack>;
  for (std::string const name : {"merging.xodr", "lane_drop.xodr"}) {
    auto site = find_merging_site(support::own_map(name));
    site.truck_share = 0.35;
    for (double const dt : {0.1, 0.2, 0.5}) {
      std::uint32_t collisions = 0, merged = 0;
      for (std::uint32_t number = 0; number < runs(); ++number) {
        auto const scenario = with_behaviors<Sim>(site.sample(20, number), [](auto const& agent) {
          return driver<Behavior>(std::get<IdmClassic>(agent.behavior));
        });
        auto world = scenario.make_world();
        bool hit = false;
        for (int step = 0; step * dt < 40.0 && !hit; ++step) {
          REQUIRE(world.step(dt));
          hit = AnyCollision{}(world);
        }
        collisions += hit;
        merged += world.status(scenario.ego) != AgentStatus::driving || world.state(scenario.ego).speed > 1.0;
      }
      CAPTURE(name);
      CAPTURE(dt);
      CHECK(collisions == 0);
      CHECK(merged > 0.8 * runs());
    }
  }
}
