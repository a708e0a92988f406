/// The room `behavior`: what drivers and pedestrians do next. A behaviour is a struct of parameters with one function,
/// `plan(view, memory, dt)`. A driver consists of three parts:
///
///                constraints it heeds                    car-following law        lane choice
///   View  ->  leader, lane end, conflict, ...  ->  strictest one -> motion  ->  own lane, or  ->  Plan: states over dt
///             (gap, speed)                          ^                ^          lane change
///             speed limit ----- desired speed ------'                |
///             bend, stop line ------------- bound of the motion -----'
///
/// - `View` is what the agent sees: its own state and lane corridor, and queries for others; view.hpp lists all of it.
///   A query returns a `RoadUser` (an agent or a static object, with gap and speed). `Look` holds the options of a
///   query along a lane. `LanePlace` is a place on a lane corridor: position s, lateral offset, heading error.
/// - `Constraint` is anything ahead that bounds the motion, as a gap and a speed. `IdmLaw` and `AccLaw` are the laws;
///   `Strictest` keeps the constraint to which the law responds with the lowest acceleration.
/// - `RoadRules` holds what all drivers can heed besides road users: limits, bends, signals, lane ends, merges.
/// - `LaneChanging` carries out lane changes safely; a model such as MOBIL only decides when and to which side.
///
/// `Driver<Law, Lateral, Heeds...>` composes a driver of a law, a part that keeps or changes its lane, and what it heeds;
/// `UrbanDriver` is one that changes lanes and gives way. The drivers below will become such compositions.
///
/// The families, each in a folder:
/// - driver/, heed/, lateral/: composed drivers, what they heed, and where across the road they drive
/// - law/: constraints, IDM, braking, road rules, lane ends: the parts that the models share
/// - following/: drivers that keep their lane (IDM, ACC, stochastic IDM, lane tracking, constant acceleration)
/// - lane_change/: drivers that change lanes (MOBIL, rule-based, macro actions), and that merge or pass within a lane
/// - human/: reaction time, estimation errors and inattention as a wrapper of any driver
/// - junction/: a driver that crosses junctions by right of way
/// - safety/: RSS as a wrapper of any behaviour; braking to a standstill
/// - pedestrian/: social forces, and crossing lanes
/// - open_loop/: recorded trajectories, and inputs from a search or from outside
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/course.hpp"
#include "cambium/behavior/driver/driver.hpp"
#include "cambium/behavior/driver/heeding.hpp"
#include "cambium/behavior/driver/limits.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/following/adaptive_cruise_control.hpp"
#include "cambium/behavior/following/constant_acceleration.hpp"
#include "cambium/behavior/following/headway_hypotheses.hpp"
#include "cambium/behavior/following/idm_classic.hpp"
#include "cambium/behavior/following/idm_lane_tracking.hpp"
#include "cambium/behavior/following/idm_stochastic.hpp"
#include "cambium/behavior/heed/bends.hpp"
#include "cambium/behavior/heed/conflicts.hpp"
#include "cambium/behavior/heed/lane_end.hpp"
#include "cambium/behavior/heed/pedestrians.hpp"
#include "cambium/behavior/heed/signals.hpp"
#include "cambium/behavior/heed/speed_limit.hpp"
#include "cambium/behavior/heed/zip.hpp"
#include "cambium/behavior/human/human_driver.hpp"
#include "cambium/behavior/human/human_view.hpp"
#include "cambium/behavior/junction/conflict_order.hpp"
#include "cambium/behavior/junction/intersection.hpp"
#include "cambium/behavior/lane_change/corridor_filters.hpp"
#include "cambium/behavior/lane_change/driver_actions.hpp"
#include "cambium/behavior/lane_change/idm_proposal.hpp"
#include "cambium/behavior/lane_change/lane_change.hpp"
#include "cambium/behavior/lane_change/lane_change_rule_based.hpp"
#include "cambium/behavior/lane_change/lane_changing.hpp"
#include "cambium/behavior/lane_change/macro_actions.hpp"
#include "cambium/behavior/lane_change/mobil.hpp"
#include "cambium/behavior/lane_change/random_macro_actions.hpp"
#include "cambium/behavior/lane_change/zip_merge.hpp"
#include "cambium/behavior/lateral/change_lanes.hpp"
#include "cambium/behavior/lateral/free_space_rule.hpp"
#include "cambium/behavior/lateral/keep_lane.hpp"
#include "cambium/behavior/lateral/mobil_rule.hpp"
#include "cambium/behavior/lateral/track_line.hpp"
#include "cambium/behavior/law/braking.hpp"
#include "cambium/behavior/law/constraint.hpp"
#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/behavior/law/follow_motion.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/law/lane_ends.hpp"
#include "cambium/behavior/law/lane_option.hpp"
#include "cambium/behavior/law/lane_reach.hpp"
#include "cambium/behavior/law/linear_stability.hpp"
#include "cambium/behavior/law/passing.hpp"
#include "cambium/behavior/law/road_rules.hpp"
#include "cambium/behavior/law/stepping_out.hpp"
#include "cambium/behavior/open_loop/external_input.hpp"
#include "cambium/behavior/open_loop/motion_primitives.hpp"
#include "cambium/behavior/open_loop/static_trajectory.hpp"
#include "cambium/behavior/pedestrian/crossing.hpp"
#include "cambium/behavior/pedestrian/pedestrian.hpp"
#include "cambium/behavior/pedestrian/social_force.hpp"
#include "cambium/behavior/presets.hpp"
#include "cambium/behavior/safety/rss.hpp"
#include "cambium/behavior/safety/rss_conformant.hpp"
#include "cambium/behavior/safety/safety.hpp"
#include "cambium/behavior/view.hpp"
