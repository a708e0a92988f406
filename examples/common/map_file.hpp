#pragma once

#include <memory>
#include <string>

#include "cambium/map/map.hpp"

namespace examples {

/// The map of an OpenDRIVE file, or of the table of a centre line (.csv), which becomes a road of one lane; what is odd
/// about it goes to the error stream, a line each. Throws `cambium::MapError`.
std::shared_ptr<cambium::Map const> load_map(std::string const& file);

}  // namespace examples
