#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive_document.hpp"

namespace examples {

/// A map's file, as written and as a map.
struct OpenedMap {
  cambium::map::OpenDriveDocument document;
  std::shared_ptr<cambium::Map const> map;
  std::vector<cambium::Diagnostic> diagnostics;
};

/// Reads an OpenDRIVE file, or the table of a centre line (.csv), which becomes a road of one lane. Throws
/// `cambium::MapError`. Defined in a translation unit of its own, so that the reader is compiled once for all examples.
OpenedMap open_map(std::string const& file, cambium::MapOptions const& options = {});

/// The map of such a file; what is odd about it goes to the error stream, a line each. Throws
/// `cambium::MapError`.
std::shared_ptr<cambium::Map const> load_map(std::string const& file);

}  // namespace examples
