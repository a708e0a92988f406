#pragma once

#include <memory>
#include <string>

#include "cambium/map/map.hpp"

namespace examples {

/// The map of an OpenDRIVE file; what is odd about it goes to the error stream, a line each. Throws
/// `cambium::MapError`. Defined in a translation unit of its own, so that the reader is compiled once for all examples.
std::shared_ptr<cambium::Map const> load_map(std::string const& file);

}  // namespace examples
