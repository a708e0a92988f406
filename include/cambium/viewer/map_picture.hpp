#pragma once

#include <filesystem>
#include <string>

#include "cambium/core/error.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/map/map.hpp"
#include "cambium/viewer/detail/map_drawing.hpp"
#include "cambium/viewer/detail/map_legend.hpp"
#include "cambium/viewer/detail/map_page.hpp"
#include "cambium/viewer/map_picture_options.hpp"

namespace cambium {

/// A picture of the map as SVG: lanes in the colours of their types, travel directions, ids (road:lane), links to
/// successors, where lanes cross, merge and split, and a legend. What the pointer rests on says what it is. Throws
/// `Error` for a width or part out of range. Deterministic; its size is some 50 B per vertex of the map's lanes.
[[nodiscard]] inline std::string svg_map_picture(Map const& map, MapPictureOptions const& options = {}) {
  return detail::MapDrawing(map, options).text(options.legend);
}

/// The same as a page of its own that zooms, pans, and switches layers on and off; opened with `#at=X,Y,WIDTH` it shows
/// the `WIDTH` metres around (X, Y).
[[nodiscard]] inline std::string html_map_picture(Map const& map, MapPictureOptions const& options = {}) {
  detail::MapDrawing drawing(map, options);
  constexpr double width = 370.0;  // [px]
  auto const legend = options.legend ? drawing.legend(width) : detail::MapLegend{};
  return detail::map_page(options.title, drawing.text(false), width, legend);
}

/// Writes the picture to `path`, as SVG or as HTML by its ending. Throws `Error` for another ending and where it cannot
/// be written.
inline void write_map_picture(std::filesystem::path const& path, Map const& map,
                              MapPictureOptions const& options = {}) {
  auto const ending = path.extension();
  if (ending != ".svg" && ending != ".html")
    throw Error(path.string(), "a map's picture is an .svg or an .html file", "name one with such an ending");
  write_file(path, ending == ".svg" ? svg_map_picture(map, options) : html_map_picture(map, options));
}

}  // namespace cambium
