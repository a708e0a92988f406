#pragma once

#include <memory>
#include <string>

#include "cambium/map/map.hpp"

namespace examples {

/// Loads an OpenDRIVE file, a Lanelet2 map (.osm), the lanelets of a CommonRoad scenario (.xml), or a centre line from
/// a table (.csv), which becomes a road of one lane. Prints warnings of the file to the error stream, one per line.
/// Throws `cambium::Error`.
std::shared_ptr<cambium::Map const> load_map(std::string const& file);

}  // namespace examples
