#pragma once

#include <memory>
#include <string>

#include "cambium/map/map.hpp"

/// Maps for benchmarks, read in a translation unit of its own.
namespace support {

/// The map of an OpenDRIVE file, read anew at each call.
std::shared_ptr<cambium::Map const> load_map(std::string const& file);

/// A winding carriageway of three lanes and at least `length` metres.
std::shared_ptr<cambium::Map const> winding_road(double length);

}  // namespace support
