#pragma once

#include <string>
#include <string_view>

#include "cambium/map/map.hpp"
#include "cambium/scenario/dataset/recorded_traffic.hpp"

#ifdef CAMBIUM_COMPILED_WITHOUT_READER
#error "cambium::compiled has no CommonRoad reader because CMake did not find pugixml: install it (libpugixml-dev)"
#endif

namespace cambium::inline v0_1 {

/// Reads a CommonRoad scenario (XML of the versions 2018b and 2020a; Althoff, Koschi, Manzinger 2017): lanelets, which
/// become the map (null without any), signs, lights and intersections as far as `map::Lanelet` has them, static and
/// dynamic obstacles as tracks, planning problems. `file` names the text in messages.
///
/// An interval or area where one value is wanted counts as its middle; of occupancy sets the middles of the shapes are
/// taken. A rotated or shifted rectangle keeps its own middle and heading; circles become polygons of 32 corners, those
/// of obstacles with `Track::outline`. A light is green once a cycle, then yellow, else red. Lights for one direction
/// hang over the ways behind the lanelet that turn so. Each of these, what is left out (an obstacle without a state, a
/// goal without a time) and unknown elements are diagnostics. Throws `Error` (file, line, what, remedy) where the text
/// is no XML or no CommonRoad, or has no time step; and as `build_lanelet_map`. Linear in the text, but for the map.
[[nodiscard]] RecordedTraffic parse_common_road(std::string_view text, map::MapOptions const& options = {},
                                                std::string const& file = "text");

/// As `parse_common_road`, from a file. Throws `Error` where it cannot be read, too.
[[nodiscard]] RecordedTraffic load_common_road(std::string const& path, map::MapOptions const& options = {});

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/scenario/dataset/common_road_impl.hpp"
#endif
