/// The map room but for what builds maps: `cambium/map/build_map.hpp` and `routing.hpp` (Boost.Graph) come with
/// `cambium/map/opendrive.hpp` and `cambium/map/map_builder.hpp`.
#pragma once

#include "cambium/map/build_corridor.hpp"
#include "cambium/map/center_line_csv.hpp"
#include "cambium/map/corridor.hpp"
#include "cambium/map/cubic.hpp"
#include "cambium/map/curve_layout.hpp"
#include "cambium/map/lane.hpp"
#include "cambium/map/lane_position.hpp"
#include "cambium/map/lane_tree.hpp"
#include "cambium/map/lane_type.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive_check.hpp"
#include "cambium/map/opendrive_document.hpp"
#include "cambium/map/opendrive_element.hpp"
#include "cambium/map/opendrive_lanes.hpp"
#include "cambium/map/opendrive_objects.hpp"
#include "cambium/map/opendrive_writer.hpp"
#include "cambium/map/parametric_cubic.hpp"
#include "cambium/map/polyline_roads.hpp"
#include "cambium/map/reference_line.hpp"
#include "cambium/map/road_plan.hpp"
