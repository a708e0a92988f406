#pragma once

#include <filesystem>
#include <string>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/map/map.hpp"
#include "cambium/viewer/detail/map_drawing.hpp"
#include "cambium/viewer/detail/map_legend.hpp"
#include "cambium/viewer/detail/map_page.hpp"
#include "cambium/viewer/map_picture.hpp"
#include "cambium/viewer/map_picture_options.hpp"

namespace cambium::inline v0_1 {

CAMBIUM_COLD std::string svg_map_picture(Map const& map, MapPictureOptions const& options) {
  return detail::MapDrawing(map, options).text(options.legend);
}

CAMBIUM_COLD std::string html_map_picture(Map const& map, MapPictureOptions const& options) {
  detail::MapDrawing drawing(map, options);
  constexpr double width = 370.0;  // [px]
  auto const legend = options.legend ? drawing.legend(width) : detail::MapLegend{};
  return detail::map_page(options.title, drawing.text(false), width, legend);
}

CAMBIUM_COLD void write_map_picture(std::filesystem::path const& path, Map const& map,
                                    MapPictureOptions const& options) {
  auto const ending = path.extension();
  if (ending != ".svg" && ending != ".html")
    throw Error(path.string(), "a map's picture is an .svg or an .html file", "give a path with one of these endings");
  write_file(path, ending == ".svg" ? svg_map_picture(map, options) : html_map_picture(map, options));
}

}  // namespace cambium::inline v0_1
