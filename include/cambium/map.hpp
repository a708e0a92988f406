/// The room `map`: lanes, corridors, routes, building a map in code. Files are read by cambium/map/opendrive.hpp.
#pragma once

#include "cambium/map/build_corridor.hpp"
#include "cambium/map/build_map.hpp"
#include "cambium/map/corridor.hpp"
#include "cambium/map/cubic.hpp"
#include "cambium/map/lane.hpp"
#include "cambium/map/lane_position.hpp"
#include "cambium/map/lane_tree.hpp"
#include "cambium/map/lane_type.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive_check.hpp"
#include "cambium/map/opendrive_document.hpp"
#include "cambium/map/overlaps.hpp"
#include "cambium/map/reference_line.hpp"
#include "cambium/map/routing.hpp"
