/// The map room, without what is only for making, checking and writing maps, or for more than the plane. Include that by
/// name, below `cambium/map/`: `opendrive.hpp` reads files (pugixml); `build/map_builder.hpp`, `build/road_plan.hpp`,
/// `road/curve_layout.hpp`, `build/polyline_roads.hpp` and `build/center_line_csv.hpp` make maps in code;
/// `build/build_map.hpp` makes a map of an `opendrive/document.hpp`; `lanes/lane_network.hpp`, `opendrive/check.hpp` and
/// `opendrive/writer.hpp` check and write; `road/road_surface.hpp` (Eigen) and `corridor/road_area.hpp`
/// (Boost.Geometry) tell where lanes lie in space, and their union.
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/corridor/find_corridor.hpp"
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
