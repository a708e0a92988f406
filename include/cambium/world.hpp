/// The room `world`: interacting road traffic as a value that a program copies, steps and asks.
///
/// **Three parts, by how often they change.** The `Map` never changes: roads, lanes, routes. The `Roster` changes when
/// an agent enters, leaves, or gets another road or behaviour: it holds each agent's shape, road, goal, models and
/// parameters. The `Frame` changes with every step: the time and one `AgentRecord` per agent (state, place on the lane,
/// last action, memory of the behaviour, status). Copies of a world share map and roster and own a frame:
///
///     world A --+--> Map                        shared, immutable
///               +--> Roster   [car 3][car 7][truck 9]   shared, copied on write
///     world B --+                |       |       |
///                             slot 0  slot 1  slot 2
///                                |       |       |
///     A owns     Frame k      [record][record][record]
///     B owns     Frame k      [record][record][record]
///
/// **Slot versus id.** An `AgentId` names an agent for as long as the world exists; users keep ids. A `Slot` is the
/// agent's position in the roster and in every frame of that roster, in the order of the ids. The step path works on
/// slots, because they index arrays directly. A slot is valid only until the next agent enters or leaves; the roster's
/// `revision` tells whether a frame still fits.
///
/// **The step.** `World::step(dt)` turns frame k into frame k + 1 in four phases, for all agents at once:
///
///     observe   build the traffic index of frame k; give each agent a view of frame k
///     plan      its behaviour reads the view and its own memory and returns a `Plan` (trajectory and action)
///     execute   its execution model drives the plan through its dynamics: the next state
///     commit    locate every agent on its road; then frame k + 1 replaces frame k
///
/// Nobody sees a part of frame k + 1 while the others still plan, so the order of agents does not matter.
///
/// **Lane corridor and place.** A route leads over roads; on it, an agent's `map::RoadCorridor` holds parallel lane
/// corridors, numbered by `CorridorId`. A `map::LaneCorridor` is a chain of lanes (its pieces), end to end, with one
/// continuous centre line. A `map::LanePlace` says where on it an agent is: the arc length `s` along the centre line,
/// the lateral offset (left positive), the heading error, the corridor and the piece. A step projects the new position
/// onto the centre line near the previous place, so that no search over the map is necessary.
///
///     corridor 1   |---- lane 21 ----|---- lane 24 ----|            route -->
///                                       ^ lateral offset
///     corridor 0   |---- lane 20 ----|--*-- lane 23 ---|
///                  0 -------- s -------->
///
/// **The traffic index.** Every lane of the map owns a range of one map-wide lane coordinate. `TrafficIndex` keeps all
/// agents in one list, sorted by this coordinate, and repairs the order once a step. The leader in the same lane is the
/// next entry of the list. At the end of a piece the search continues in the next piece's range, and lanes that merge
/// into the corridor (feeders) are searched as well. A vehicle that straddles a lane border has an entry in both lanes.
/// `PlaneIndex`, a grid, finds neighbours regardless of lanes; worlds without behaviours that look around do not build
/// it.
///
/// **The view.** A behaviour gets an `ObservedWorld`: a few pointers into the world, valid until the world changes. It
/// answers `state`, `ahead`, `behind`, `place`, `corridor`, `light` and so on as the agent's observer model shows them:
/// delayed, noisy or occluded. It never shows another agent's behaviour.
///
/// **Prediction.** `view.predict(predict_all_as<Set>(model))` returns another `World`, filled with what the agent sees
/// and with the behaviours that it assumes. The planner copies this world, steps the copies and judges them; the true
/// world remains untouched.
///
/// Read on in `world/world.hpp` (from `step` on), `world/frame.hpp`, `world/observed_world.hpp`,
/// `world/prediction.hpp`.
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

#include "cambium/world/agent_spec.hpp"
#include "cambium/world/driven_to.hpp"
#include "cambium/world/extern_world.hpp"
#include "cambium/world/frame.hpp"
#include "cambium/world/observed_world.hpp"
#include "cambium/world/plane_index.hpp"
#include "cambium/world/prediction.hpp"
#include "cambium/world/roster.hpp"
#include "cambium/world/static_object.hpp"
#include "cambium/world/step_result.hpp"
#include "cambium/world/traffic_index.hpp"
#include "cambium/world/traffic_query.hpp"
#include "cambium/world/world.hpp"
