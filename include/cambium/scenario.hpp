/// The room `scenario`: situations to start from. `Scenario` is the value; `LaneTraffic` draws vehicles on a lane,
/// `VehicleMix` says which. Whole situations come from the headers that are included by name, as they make maps or
/// worlds: scenario/merging_site.hpp, highway_site.hpp, junction_site.hpp, ring_road.hpp and traffic_inflow.hpp;
/// recipe.hpp draws many of them, and flows from sources to sinks (lane_flow.hpp), scenario_set.hpp holds them
/// together, and scenario_file.hpp (needs pugixml and nlohmann_json) reads and writes them.
#pragma once

#include "cambium/scenario/lane_traffic.hpp"
#include "cambium/scenario/scenario.hpp"
#include "cambium/scenario/vehicle_mix.hpp"
