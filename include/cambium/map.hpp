/// # The map room
///
/// Roads from files or from code, and what a driver needs of them. From the ground up:
///
/// **Road.** A road is laid out along its *reference line*: straight lines, arcs, spirals and cubics, evaluated
/// exactly. A place on a road is (s, t): the station s [m] along the line, and the offset t [m] from it, positive to
/// the left. Lanes are numbered outwards: 1, 2, ... to the left and -1, -2, ... to the right. A new *lane section*
/// begins where lanes are added or end.
///
///               section 0         |        section 1
///        lane  1  <---------------|----------------
///     t=0 =======================================================> s      reference line
///        lane -1  --------------->|--------------->
///                        lane -2  |--------------->
///
/// **Lane** (`Lane`). One lane of one section as traffic drives it, with neighbours, successors and predecessors. Its
/// `path` is the line that vehicles follow, sampled from the exact centre line. Everything counts in the direction of
/// travel, so left is always the driver's left. A lane that may be driven both ways is two lanes (`Lane::opposite`).
///
/// **Lane position and lane coordinate.** A place in a lane is (s, lateral offset): the arc length s [m] along the
/// path, and the distance from it, positive to the left. In addition, every lane owns a stretch of one map-wide axis,
/// `[index_begin, index_begin + length]`. A single number on that axis, the *lane coordinate*, names lane and s. The
/// traffic index of a world is nothing but all agents sorted by it.
///
///       ^ lateral offset          one axis for all lanes:
///       |     x                     lane 0         lane 1         lane 2
///     --+-----------------> s      |------------| |------------| |--------------------|
///       lane 1, x at (8, +0.5)     0           91 101  109   130 140                200
///                                                       ^ the lane coordinate of x
///
/// **Merge.** A lane that ends beside a neighbour that goes on (a lane drop, the end of an acceleration lane) swings
/// over: from `merge_begin` on, its path leaves the centre line, and at its end it joins the neighbour's
/// (`merges_into`).
///
///     lane 1  -----------------------------------.----------------->
///                                      .--------'
///     lane 2  -------------------------'         ^ lane 2 ends; its successors are those of lane 1
///                                      ^ merge_begin
///
/// **Overlap** (`Overlap`). A stretch on which the paths of two lanes come closer than `MapOptions::overlap_clearance`,
/// so that two vehicles do not fit side by side. It is a merge, a split or a crossing. Overlaps are found once, when
/// the map is built, and end within 1 cm of the exact place.
///
///     merge  ----.             split       .----         crossing      |
///                 :----                ----:                       ----+----
///            ----'                         '----                       |
///
/// **Route, lane corridor, piece** (`LaneCorridor`, `CorridorPiece`). A route is a list of lanes. A vehicle follows a
/// *lane corridor*: a chain of lanes whose paths are joined into one line, with its own arc length s, the corridor
/// position. Each lane's stretch of it is a *piece*. A piece turns corridor positions into lane positions
/// (`lane_offset`) and lane coordinates (`index_offset`), names the corridors to either side, and says where the lane
/// must have been left.
///
/// **Road corridor** (`RoadCorridor`). The lane corridor along the route together with all those beside it: where an
/// agent may drive without leaving its route. It is immutable; the map builds it once per route and shares it.
///
///     corridor 0  [ lane 1      ][ lane 3        ][ lane 6        ]     main: it holds the route's last lane
///     corridor 1  [ lane 2      ][ lane 4        ][ lane 7        ]     three pieces
///     corridor 2                 [ lane 5        ]                      a lane that opens and ends
///     s           0             150              310              480
///
/// **Feeder** (`Feeder`). A stretch of a lane outside of the corridor whose traffic counts in it: a ramp before its
/// merge, a lane that has just split off, the lanes that lead to the corridor's begin. Its lane coordinates map
/// linearly onto corridor positions. So a vehicle on the ramp has an image on the main road, and those behind the image
/// can open a gap before the two lanes become one (`free_until`).
///
///     corridor  ------- o image ----------------+-------------> s
///                       :                      /
///     feeder       -----x vehicle ------------'  free_until: here the lanes become one
///
/// **Conflict** (`Conflict`). Another lane crosses the corridor, or merges with it inside a junction, and somebody has
/// to wait. Its *zones* tell where the reference points of two vehicles may be while their bodies touch, by the sizes
/// of both. Its *ways* are the stretches of lanes by which the other traffic arrives. `right_of_way` says who goes
/// first: by the junction's priorities, by signs, else by who comes from the right. `hold` is where one waits.
///
///                        | way of the other lane
///                        v
///     ------ hold |--[ zone ]-------------> s         [begin, end] on the corridor,
///                        |                            [other_begin, other_end] on the way
///
/// **Stop line** (`CorridorSignal`, `StopLine`). Where front ends stop for a stop sign or a red light: where the
/// junction behind it begins, else at the signal itself.
///
/// Bottom up, the code is in `road/` (exact geometry), `opendrive/` (files as plain data), `building/` (from either to
/// a map), `lanes/` (lanes, overlaps, checks), `routing/` and `corridor/`.
///
/// This header leaves out what only makes, checks and writes maps, or needs more than the plane. Include that by name,
/// below `cambium/map/`: `opendrive.hpp` reads files (pugixml); `building/map_builder.hpp`, `building/road_plan.hpp`,
/// `road/curve_layout.hpp`, `building/polyline_roads.hpp` and `building/center_line_csv.hpp` make maps in code;
/// `building/build_map.hpp` makes a map from an `opendrive/document.hpp`; `lanes/signal_codes.hpp` lists signs and
/// lights by country; `lanes/lane_network.hpp`, `opendrive/check.hpp` and `opendrive/writer.hpp` check and write;
/// `road/road_surface.hpp` (Eigen) and `corridor/road_area.hpp` (Boost.Geometry) tell where lanes lie in space, and
/// their union.
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/corridor/free_corridor.hpp"
#include "cambium/map/corridor/lane_area.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/map/corridor/stop_lines.hpp"
#include "cambium/map/lanes/junction.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/lanes/lane_tree.hpp"
#include "cambium/map/lanes/right_of_way.hpp"
#include "cambium/map/lanes/road_lanes.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/map_queries.hpp"
#include "cambium/map/road/cubic.hpp"
#include "cambium/map/road/lane_type.hpp"
#include "cambium/map/road/parametric_cubic.hpp"
#include "cambium/map/road/reference_line.hpp"
#include "cambium/map/road/road.hpp"
#include "cambium/map/road/station_offset.hpp"
#include "cambium/map/routing/route.hpp"
