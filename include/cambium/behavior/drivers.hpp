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
#include "cambium/behavior/law/acc.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/lateral/change_lanes.hpp"
#include "cambium/behavior/lateral/free_space_rule.hpp"
#include "cambium/behavior/lateral/keep_lane.hpp"
#include "cambium/behavior/lateral/mobil_rule.hpp"
#include "cambium/behavior/lateral/track_line.hpp"

namespace cambium::inline v0_1 {

/// Drivers composed of the parts in law/, lateral/ and heed/. `UrbanDriver` and `AdaptiveCruiseControl` drive like
/// people by default, those that follow by IDM with BARK's parameters. Further heeds are added by `Also`, as in
/// `IdmClassic::Also<SpeedLimit, Signals>`.

/// Follows its lane and the next vehicle in it by IDM; defaults are BARK's.
using IdmClassic = Driver<Idm, KeepLane, Pedestrians>;
static_assert(BehaviorModel<IdmClassic>);

/// Follows its lane and the next vehicle in it by the ACC model.
using AdaptiveCruiseControl = Driver<Acc, KeepLane, Pedestrians>;
static_assert(BehaviorModel<AdaptiveCruiseControl>);

/// Follows by IDM and steers its front axle to the lane's centre line through its vehicle model.
using IdmLaneTracking = Driver<Idm, TrackLine, BendsFor<340>, Pedestrians>;
static_assert(BehaviorModel<IdmLaneTracking>);

/// Changes lanes by MOBIL as published; with `Filters`, under further conditions.
template <class... Filters>
using BasicMobil = Driver<Idm, ChangeLanes<MobilRule<Filters...>>, BendsFor<300>, Pedestrians>;
using Mobil = BasicMobil<>;
static_assert(BehaviorModel<Mobil>);

/// Changes to the lane with the most free space ahead.
using LaneChangeRuleBased = Driver<Idm, ChangeLanes<FreeSpaceRule>, BendsFor<300>, Pedestrians>;
static_assert(BehaviorModel<LaneChangeRuleBased>);

/// Lets one vehicle of the other lane in before itself at a merge.
using ZipMerge = Driver<Idm, KeepLane, Pedestrians, Zip>;
static_assert(BehaviorModel<ZipMerge>);

/// Keeps its lane and crosses junctions by the rules of the road.
using Intersection = Driver<Idm, KeepLane, SpeedLimit, Bends, Signals, Pedestrians, Conflicts>;
static_assert(BehaviorModel<Intersection>);

/// A driver for town: changes lanes for its route and for speed by MOBIL, obeys limits, slows down for bends, stops at
/// lights and stop signs and for pedestrians, passes cyclists, and gives way at junctions. `Law`: how it follows.
template <class Law = Acc>
using BasicUrbanDriver = Driver<Law, ChangeLanes<MobilRule<>>, SpeedLimit, Bends, Signals, Pedestrians, Conflicts>;
using UrbanDriver = BasicUrbanDriver<>;
static_assert(BehaviorModel<UrbanDriver>);

}  // namespace cambium::inline v0_1
