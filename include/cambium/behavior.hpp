/// The room `behavior`: what drivers and pedestrians do next. A behaviour is a struct of parameters with one function,
/// `plan(view, memory, dt)`. Drivers are compositions, `Driver<Law, Lateral, Heeds...>`:
///
///   View --> desired speed, lowered by heeds --> law at that speed
///              lateral.look: leader, lanes that merge, lane changes --.
///              heeds: lane end, bends, signals, conflicts, ...      ----> Limits --> lateral.drive --> Plan
///
/// - `View` is what the agent sees: its own state and lane corridor, and queries for others; view.hpp lists all of it.
///   A query returns a `RoadUser` (an agent or a static object, with gap and speed). `Look` holds the options of a
///   query along a lane. `LanePlace` is a place on a lane corridor: position s, lateral offset, heading error.
/// - `Constraint` is anything ahead to which a law responds, as a gap and a speed. `Limits` keeps the strictest one,
/// and
///   the shortest motion that bends, stop lines and conflicts permit.
/// - `ChangeLanes` carries out lane changes safely; a rule such as MOBIL only decides when and to which side.
///
/// The families, each in a folder:
/// - law/: car-following laws (IDM, improved IDM, ACC), constraints, braking, lane ends: the parts that the others
/// share
/// - heed/: what a driver heeds besides the road users in its lane
/// - lateral/: where across the road it drives: keeps its lane, tracks its line, changes lanes by a rule
/// - driver/: how these make a driver; drivers.hpp has the usual ones (`IdmClassic`, `Mobil`, `UrbanDriver`, ...)
/// - actions/: what a search or a planner chooses from: macro actions, proposals
/// - wrap/: reaction time and errors, RSS, drawn parameters, hypotheses: wrappers of drivers
/// - pedestrian/: social forces, and crossing lanes
/// - open_loop/: recorded trajectories, constant acceleration and turn, inputs from a search or from outside
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

#include "cambium/behavior/actions/driver_actions.hpp"
#include "cambium/behavior/actions/idm_proposal.hpp"
#include "cambium/behavior/actions/macro_actions.hpp"
#include "cambium/behavior/actions/random_macro_actions.hpp"
#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/course.hpp"
#include "cambium/behavior/driver/driver.hpp"
#include "cambium/behavior/driver/driver_text.hpp"
#include "cambium/behavior/driver/heeding.hpp"
#include "cambium/behavior/driver/limits.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/heed/bends.hpp"
#include "cambium/behavior/heed/conflict_order.hpp"
#include "cambium/behavior/heed/conflicts.hpp"
#include "cambium/behavior/heed/lane_end.hpp"
#include "cambium/behavior/heed/pedestrians.hpp"
#include "cambium/behavior/heed/signals.hpp"
#include "cambium/behavior/heed/speed_limit.hpp"
#include "cambium/behavior/heed/yielding.hpp"
#include "cambium/behavior/heed/zip.hpp"
#include "cambium/behavior/lateral/change_lanes.hpp"
#include "cambium/behavior/lateral/corridor_filters.hpp"
#include "cambium/behavior/lateral/free_space_rule.hpp"
#include "cambium/behavior/lateral/keep_lane.hpp"
#include "cambium/behavior/lateral/lane_change.hpp"
#include "cambium/behavior/lateral/mobil_rule.hpp"
#include "cambium/behavior/lateral/track_line.hpp"
#include "cambium/behavior/law/acc.hpp"
#include "cambium/behavior/law/braking.hpp"
#include "cambium/behavior/law/constraint.hpp"
#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/behavior/law/follow_motion.hpp"
#include "cambium/behavior/law/gap_before_merge.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/law/improved_idm.hpp"
#include "cambium/behavior/law/lane_ends.hpp"
#include "cambium/behavior/law/lane_option.hpp"
#include "cambium/behavior/law/lane_reach.hpp"
#include "cambium/behavior/law/linear_stability.hpp"
#include "cambium/behavior/law/passing.hpp"
#include "cambium/behavior/law/slowing.hpp"
#include "cambium/behavior/law/stepping_out.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/behavior/open_loop/constant_turn.hpp"
#include "cambium/behavior/open_loop/external_input.hpp"
#include "cambium/behavior/open_loop/motion_primitives.hpp"
#include "cambium/behavior/open_loop/static_trajectory.hpp"
#include "cambium/behavior/pedestrian/crossing.hpp"
#include "cambium/behavior/pedestrian/pedestrian.hpp"
#include "cambium/behavior/pedestrian/social_force.hpp"
#include "cambium/behavior/pedestrian/surroundings.hpp"
#include "cambium/behavior/people.hpp"
#include "cambium/behavior/presets.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/behavior/wrap/headway_hypotheses.hpp"
#include "cambium/behavior/wrap/human_driver.hpp"
#include "cambium/behavior/wrap/human_view.hpp"
#include "cambium/behavior/wrap/idm_stochastic.hpp"
#include "cambium/behavior/wrap/rss.hpp"
#include "cambium/behavior/wrap/rss_conformant.hpp"
#include "cambium/behavior/wrap/safety.hpp"
