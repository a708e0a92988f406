#pragma once

#include "cambium/map/building/map_builder.hpp"

/// cambium's own maps.
namespace make_maps {

using cambium::MapBuilder;
using namespace cambium::map;
using cambium::map::opendrive::ContactPoint;
using cambium::map::opendrive::LaneChangePermission;

constexpr double kmh(double speed) { return speed / 3.6; }  ///< [m/s]

MapBuilder highway();            ///< three lanes, winding
MapBuilder lane_drop();          ///< three lanes become two
MapBuilder merging();            ///< an on-ramp with an acceleration lane
MapBuilder highway_exit();       ///< a deceleration lane and an off-ramp
MapBuilder intersection_3way();  ///< a side road meets a main road that has a lane for turning left
MapBuilder intersection_4way();  ///< two roads with two lanes per direction cross; for traffic lights see `add_lights`
MapBuilder roundabout();         ///< one lane, four arms

/// Adds traffic lights to the map of `intersection_4way`.
void add_lights(cambium::map::opendrive::Document& document);

}  // namespace make_maps
