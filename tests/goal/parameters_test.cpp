#include <cambium/cambium.hpp>
#include <doctest/doctest.h>

#include "../support/parameter_rows.hpp"

namespace cb = cambium;

TEST_CASE("defaults, units and ranges are those of the file beside") {
  support::check_parameter_rows<cb::ReachPolygon, cb::ReachLane, cb::StateLimits, cb::LaneLimits, cb::ReachLaneEnd,
                                cb::ReachLaneBeside, cb::AllGoals, cb::AnyGoal, cb::GoalSequence>("goal");
}
