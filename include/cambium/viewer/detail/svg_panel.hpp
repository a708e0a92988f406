#pragma once

#include <cmath>
#include <string>

#include "cambium/geometry/pose.hpp"
#include "cambium/viewer/detail/text.hpp"

namespace cambium::detail {

/// `value` as an SVG attribute takes it.
inline std::string svg_number(double value, int decimals = 2) {
  std::string text;
  append_number(text, value, decimals);
  return text;
}

/// A rectangle [px or m] with further attributes in `more`.
inline std::string svg_box(double x, double y, double width, double height, std::string const& more) {
  return "<rect x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) + "\" width=\"" + svg_number(width) + "\" height=\"" +
         svg_number(height) + "\" " + more + "/>";
}

/// A rectangle of the picture and the part of the map that it shows.
struct SvgPanel {
  double left, top, width, height;  // [px]
  double scale;                     // [px/m]
  geometry::Point middle;           // the place of the map in the middle of the panel [m]
  double heading = 0.0;             // the map direction that points to the right [rad]

  [[nodiscard]] geometry::Point on_picture(geometry::Point const& p) const {
    geometry::Point const d = p - middle;
    double const c = std::cos(heading), s = std::sin(heading);
    return {left + width / 2 + scale * (c * d.x() + s * d.y()), top + height / 2 - scale * (c * d.y() - s * d.x())};
  }

  /// True where a short text in the middle of `picture` lies within the panel.
  [[nodiscard]] bool has_room(geometry::Point const& picture) const {
    return std::abs(picture.x() - left - width / 2) < width / 2 - 30.0 &&
           std::abs(picture.y() - top - height / 2) < height / 2 - 8.0;
  }
};

}  // namespace cambium::detail
