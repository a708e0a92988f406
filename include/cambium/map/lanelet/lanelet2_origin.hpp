#pragma once

#include "cambium/core/parameters.hpp"

namespace cambium::inline v0_1::map {

/// Projection of a Lanelet2 file's coordinates to metres: transverse Mercator in the UTM zone of the origin, which
/// becomes (0, 0), as by Lanelet2's UTM projector. The file does not say which origin it was made with; without one, it
/// is the middle of the map, but (0, 0) for maps near there, such as INTERACTION's.
struct Lanelet2Origin {
  double latitude = 0.0;   ///< [degrees], north positive
  double longitude = 0.0;  ///< [degrees], east positive

  static constexpr char const* name = "lanelet2_origin";
  static constexpr auto parameters() {
    using P = Lanelet2Origin;
    return parameter_list(parameter("latitude", &P::latitude, "degrees", Range{-84, 84}, "of the map frame's origin"),
                          parameter("longitude", &P::longitude, "degrees", Range{-180, 180}, "likewise"));
  }
};

}  // namespace cambium::inline v0_1::map
