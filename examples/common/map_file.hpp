#pragma once

#include <memory>
#include <string>

#include "cambium/map/map.hpp"

namespace examples {

/// Loads an OpenDRIVE file, or a centre line from a table (.csv), which becomes a road of one lane. Prints warnings and
/// errors of the file to the error stream, one per line. Throws `cambium::MapError`.
std::shared_ptr<cambium::Map const> load_map(std::string const& file);

}  // namespace examples
