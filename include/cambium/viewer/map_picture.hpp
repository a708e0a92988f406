#pragma once

#include <filesystem>
#include <string>

#include "cambium/map/fwd.hpp"
#include "cambium/viewer/map_picture_options.hpp"

namespace cambium::inline v0_1 {

/// A picture of the map as SVG: lanes coloured by type, travel directions, ids (road:lane), links to successors, the
/// places where lanes cross, merge and split, and a legend. Elements have tooltips. Throws `Error` if the width is out
/// of range or the part has no area. Deterministic; its size is about 50 B per vertex of the map's lanes.
[[nodiscard]] std::string svg_map_picture(Map const& map, MapPictureOptions const& options = {});

/// The same picture as an HTML page, which zooms and pans by pointer, touch and keys, switches layers on and off, finds
/// roads, lanes and junctions by id, and follows the system's dark mode. Opened with `#at=X,Y,WIDTH` it shows `WIDTH`
/// metres around (X, Y); with `#find=ID` it shows what has this id ("5", "5:-1", "junction 5").
[[nodiscard]] std::string html_map_picture(Map const& map, MapPictureOptions const& options = {});

/// Writes the picture to `path`, as SVG or HTML according to its extension. Throws `Error` for any other extension, or
/// if the file cannot be written.
void write_map_picture(std::filesystem::path const& path, Map const& map, MapPictureOptions const& options = {});

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/viewer/map_picture_impl.hpp"
#endif
