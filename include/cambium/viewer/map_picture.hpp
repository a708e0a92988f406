#pragma once

#include <filesystem>
#include <string>

#include "cambium/map/fwd.hpp"
#include "cambium/viewer/map_picture_options.hpp"

namespace cambium {

/// A picture of the map as SVG: lanes in the colours of their types, travel directions, ids (road:lane), links to
/// successors, where lanes cross, merge and split, and a legend. What the pointer rests on says what it is. Throws
/// `Error` for a width or part out of range. Deterministic; its size is some 50 B per vertex of the map's lanes.
[[nodiscard]] std::string svg_map_picture(Map const& map, MapPictureOptions const& options = {});

/// The same as a page of its own, light or dark as its reader prefers, that zooms and pans by pointer, touch and keys,
/// switches layers on and off, and finds roads, lanes and junctions by their ids. Opened with `#at=X,Y,WIDTH` it shows
/// the `WIDTH` metres around (X, Y), with `#find=ID` what has this id ("5", "5:-1", "junction 5").
[[nodiscard]] std::string html_map_picture(Map const& map, MapPictureOptions const& options = {});

/// Writes the picture to `path`, as SVG or as HTML by its ending. Throws `Error` for another ending and where it cannot
/// be written.
void write_map_picture(std::filesystem::path const& path, Map const& map, MapPictureOptions const& options = {});

}  // namespace cambium

#ifndef CAMBIUM_COMPILED
#include "cambium/viewer/map_picture_impl.hpp"
#endif
