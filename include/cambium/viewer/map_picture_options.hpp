#pragma once

#include <optional>
#include <string>

#include "cambium/geometry/box.hpp"

namespace cambium::inline v0_1 {

/// What `svg_map_picture` shows besides the lanes.
struct MapPictureOptions {
  double width =
      1600.0;  ///< of the picture [px], 1 to 100 000; its height follows from the map, up to 4 times the width
  std::string title{};
  std::optional<geometry::Box> part{};  ///< shows only this box [m]; default: the whole map
  bool arrows = true;                   ///< travel directions
  bool labels = true;                   ///< lane ids, as road:lane
  bool links = true;      ///< arrows to successors; dots where a drivable lane starts or ends without a connection
  bool overlaps = true;   ///< where lanes cross, merge and split
  bool conflicts = true;  ///< areas in junctions that two lanes share
  bool legend = true;     ///< the meaning of the colours, below the map (on a page: in its panel)
};

}  // namespace cambium::inline v0_1
