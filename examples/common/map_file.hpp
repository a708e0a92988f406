#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cambium/map/lanelet/lanelet2.hpp"
#include "cambium/map/map.hpp"

namespace examples {

/// Loads an OpenDRIVE file, a Lanelet2 map (.osm), the lanelets of a CommonRoad scenario (.xml), or a centre line from
/// a table (.csv), which becomes a road of one lane. `origin` is that of a Lanelet2 map. Prints warnings of the file to
/// the error stream, one per line. Throws `cambium::Error`.
std::shared_ptr<cambium::Map const> load_map(std::string const& file,
                                             std::optional<cambium::map::Lanelet2Origin> const& origin = {});

/// The value of `--origin LAT,LON` for a map file; none where it is empty. Throws `cambium::Error` where the map is no
/// Lanelet2 map, or for no place on Earth.
std::optional<cambium::map::Lanelet2Origin> origin_of(std::vector<double> const& words, std::string const& file);

}  // namespace examples
