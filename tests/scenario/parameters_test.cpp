#include <cambium/cambium.hpp>
#include <cambium/scenario/lane_flow.hpp>
#include <cambium/scenario/recipe.hpp>
#include <cambium/scenario/traffic_inflow.hpp>
#include <doctest/doctest.h>

#include "../support/parameter_rows.hpp"

namespace cb = cambium;

TEST_CASE("defaults, units and ranges are those of the file beside") {
  using World = cb::World<cb::BehaviorSet<cb::IdmClassic>, cb::InterpolateExecution, cb::SingleTrack>;
  support::check_parameter_rows<cb::ScenarioRecipe<World>, cb::MergingTraffic, cb::JunctionTraffic, cb::VehicleMix,
                                cb::LaneFlow<World>, cb::LaneTraffic, cb::InflowRules>("scenario");
}
