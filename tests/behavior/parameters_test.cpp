#include <cambium/cambium.hpp>
#include <doctest/doctest.h>

#include "../support/parameter_rows.hpp"

namespace cb = cambium;

TEST_CASE("defaults, units and ranges are those of the file beside") {
  support::check_parameter_rows<
      cb::IdmClassic, cb::IdmLaneTracking, cb::AdaptiveCruiseControl, cb::IdmStochastic, cb::Mobil,
      cb::LaneChangeRuleBased, cb::ZipMerge, cb::Intersection, cb::UrbanDriver, cb::RssConformant<cb::IdmClassic>,
      cb::HumanDriver<cb::IdmClassic>, cb::Pedestrian, cb::Safety, cb::ConstantAcceleration, cb::ConstantTurn,
      cb::StaticTrajectory, cb::ExternalInput, cb::MotionPrimitives, cb::MacroActions, cb::RandomMacroActions,
      cb::DriverActions<cb::Intersection>, cb::HeadwayHypotheses<cb::IdmClassic>, cb::IdmProposal, cb::Idm,
      cb::ImprovedIdm, cb::Acc, cb::LaneChangeCourse, cb::LaneEnd, cb::Yielding<>, cb::RssParameters,
      cb::MotionPrimitive, cb::MacroAction, cb::SocialForceParameters, cb::CrossingParameters, cb::FreeSpace,
      cb::RemainingLength, cb::SpeedLimitAtLeast, cb::Population>("behavior");
}
