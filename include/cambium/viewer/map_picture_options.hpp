#pragma once

#include <optional>
#include <string>

#include "cambium/geometry/box.hpp"

namespace cambium {

/// What `svg_map_picture` shows besides the lanes.
struct MapPictureOptions {
  double width =
      1600.0;  ///< of the picture [px], 1 to 100 000; its height follows from the map, up to 4 times the width
  std::string title{};
  std::optional<geometry::Box> part{};  ///< only what lies in this box [m]; else all
  bool arrows = true;                   ///< travel directions
  bool labels = true;                   ///< road:lane
  bool links = true;      ///< from each lane to its successors; dots where a drivable lane ends or begins without one
  bool overlaps = true;   ///< where lanes cross, merge and split
  bool conflicts = true;  ///< the ground of a junction that two lanes share where they do
  bool legend = true;     ///< what the colours mean, below the map (of a page: on it)
};

}  // namespace cambium
