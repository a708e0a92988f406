/// The map room but for what only those need who make, check or write maps, or ask for more than the plane; they
/// include it by name: `opendrive.hpp` reads files (pugixml), `map_builder.hpp` with `road_plan.hpp`,
/// `curve_layout.hpp`, `polyline_roads.hpp` and `center_line_csv.hpp` makes maps in code, `build_map.hpp` makes one of
/// an `opendrive_document.hpp`, `lane_network.hpp`, `opendrive_check.hpp` and `opendrive_writer.hpp` check and write,
/// `road_surface.hpp` (Eigen) and `road_area.hpp` (Boost.Geometry) tell where lanes lie in space, and their union.
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

#include "cambium/map/build_corridor.hpp"
#include "cambium/map/corridor.hpp"
#include "cambium/map/cubic.hpp"
#include "cambium/map/find_corridor.hpp"
#include "cambium/map/free_corridor.hpp"
#include "cambium/map/junction.hpp"
#include "cambium/map/lane.hpp"
#include "cambium/map/lane_area.hpp"
#include "cambium/map/lane_place.hpp"
#include "cambium/map/lane_tree.hpp"
#include "cambium/map/lane_type.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/map_queries.hpp"
#include "cambium/map/parametric_cubic.hpp"
#include "cambium/map/reference_line.hpp"
#include "cambium/map/right_of_way.hpp"
#include "cambium/map/road.hpp"
#include "cambium/map/road_lanes.hpp"
#include "cambium/map/route.hpp"
#include "cambium/map/signals.hpp"
#include "cambium/map/station_offset.hpp"
#include "cambium/map/stop_lines.hpp"
