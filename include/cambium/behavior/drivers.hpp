#pragma once

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/driver/driver.hpp"
#include "cambium/behavior/heed/bends.hpp"
#include "cambium/behavior/heed/conflicts.hpp"
#include "cambium/behavior/heed/lane_end.hpp"
#include "cambium/behavior/heed/pedestrians.hpp"
#include "cambium/behavior/heed/signals.hpp"
#include "cambium/behavior/heed/speed_limit.hpp"
#include "cambium/behavior/heed/zip.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/lateral/change_lanes.hpp"
#include "cambium/behavior/lateral/free_space_rule.hpp"
#include "cambium/behavior/lateral/keep_lane.hpp"
#include "cambium/behavior/lateral/mobil_rule.hpp"
#include "cambium/behavior/lateral/track_line.hpp"

namespace cambium {

/// A driver for town: changes lanes for its route and for speed by MOBIL, obeys limits, slows down for bends, stops at
/// lights and stop signs and for pedestrians, passes cyclists, and gives way at junctions. `Law`: how it follows.
template <CarFollowing Law = Idm>
using BasicUrbanDriver = Driver<Law, ChangeLanes<MobilRule<>>, SpeedLimit, Bends, Signals, Pedestrians, Conflicts>;
using UrbanDriver = BasicUrbanDriver<>;

}  // namespace cambium
