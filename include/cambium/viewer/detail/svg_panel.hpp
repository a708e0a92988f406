#pragma once

#include <cmath>
#include <string>

#include "cambium/core/markup.hpp"
#include "cambium/geometry/pose.hpp"

namespace cambium::inline v0_1::detail {

/// `value` as text for an SVG attribute.
inline std::string svg_number(double value, int decimals = 2) {
  std::string text;
  append_number(text, value, decimals);
  return text;
}

/// An SVG rectangle [px or m]; `more`: further attributes.
inline std::string svg_box(double x, double y, double width, double height, std::string const& more) {
  return "<rect x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) + "\" width=\"" + svg_number(width) + "\" height=\"" +
         svg_number(height) + "\" " + more + "/>";
}

/// A rectangle of the picture and the part of the map that it shows.
struct SvgPanel {
  double left, top, width, height;  // [px]
  double scale;                     // [px/m]
  geometry::Point middle;           // map point in the middle of the panel [m]
  double heading = 0.0;             // map direction that points to the right in the panel [rad]

  [[nodiscard]] geometry::Point on_picture(geometry::Point const& p) const {
    geometry::Point const d = p - middle;
    double const c = std::cos(heading), s = std::sin(heading);
    return {left + width / 2 + scale * (c * d.x() + s * d.y()), top + height / 2 - scale * (c * d.y() - s * d.x())};
  }

  /// Whether a short text centred at `picture` [px] fits into the panel.
  [[nodiscard]] bool has_room(geometry::Point const& picture) const {
    return std::abs(picture.x() - left - width / 2) < width / 2 - 30.0 &&
           std::abs(picture.y() - top - height / 2) < height / 2 - 8.0;
  }
};

/// The largest length of one digit, 1, 2 or 5, that is at most `most`.
[[nodiscard]] inline double round_length(double most) {
  double const power = std::pow(10.0, std::floor(std::log10(most)));
  return most >= 5 * power ? 5 * power : most >= 2 * power ? 2 * power : power;
}

/// A scale bar of a round length in the panel's lower right corner, with its label.
inline std::string svg_scale_bar(SvgPanel const& panel) {
  double const metres = round_length(150.0 / panel.scale);
  double const right = panel.left + panel.width - 14.0, left = right - metres * panel.scale;
  double const y = panel.top + panel.height - 12.0;
  return "<path d=\"M" + svg_number(left) + ' ' + svg_number(y - 5) + "V" + svg_number(y) + "H" + svg_number(right) +
         "V" + svg_number(y - 5) + "\" fill=\"none\" stroke=\"#16202b\" stroke-width=\"1.5\"/><text x=\"" +
         svg_number((left + right) / 2) + "\" y=\"" + svg_number(y - 6) +
         "\" font-size=\"12\" text-anchor=\"middle\" fill=\"#16202b\">" + svg_number(metres) + " m</text>\n";
}

}  // namespace cambium::inline v0_1::detail
