/// The map room but for what is expensive to compile: the building of maps (Boost.Graph: `cambium/map/build_map.hpp`,
/// `routing.hpp`; `opendrive.hpp` brings both), the union of lanes (Boost.Geometry: `road_area.hpp`), what checks and
/// writes documents (`opendrive_check.hpp`, `opendrive_writer.hpp`), and maps in code: `map_builder.hpp` with
/// `road_plan.hpp`, `curve_layout.hpp`, `polyline_roads.hpp` and `center_line_csv.hpp`.
#pragma once

#include "cambium/map/build_corridor.hpp"
#include "cambium/map/corridor.hpp"
#include "cambium/map/cubic.hpp"
#include "cambium/map/find_corridor.hpp"
#include "cambium/map/free_corridor.hpp"
#include "cambium/map/junction.hpp"
#include "cambium/map/lane.hpp"
#include "cambium/map/lane_adjacency.hpp"
#include "cambium/map/lane_area.hpp"
#include "cambium/map/lane_network.hpp"
#include "cambium/map/lane_position.hpp"
#include "cambium/map/lane_tree.hpp"
#include "cambium/map/lane_type.hpp"
#include "cambium/map/make_roads.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive_document.hpp"
#include "cambium/map/opendrive_element.hpp"
#include "cambium/map/opendrive_lanes.hpp"
#include "cambium/map/opendrive_objects.hpp"
#include "cambium/map/parametric_cubic.hpp"
#include "cambium/map/reference_line.hpp"
#include "cambium/map/right_of_way.hpp"
#include "cambium/map/road.hpp"
#include "cambium/map/road_lanes.hpp"
#include "cambium/map/road_surface.hpp"
#include "cambium/map/route.hpp"
#include "cambium/map/signals.hpp"
#include "cambium/map/station_offset.hpp"
