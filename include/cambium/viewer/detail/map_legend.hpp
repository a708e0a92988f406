#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "cambium/viewer/detail/svg_panel.hpp"

namespace cambium::inline v0_1::detail {

/// A sample of a map element as SVG, 3 m by 1.5 m, and what it means.
struct LegendEntry {
  std::string sample, text;
};

/// The legend of a map picture: SVG in pixels, and its height [px].
struct MapLegend {
  std::string text;
  double height = 0.0;
};

/// Samples of an area with the CSS classes `classes`, and of what lies on a lane.
[[nodiscard]] inline std::string area_sample(std::string const& classes) {
  return "<g class=\"areas\"><path class=\"" + classes + "\" d=\"M0 0H3V1.5H0Z\"/></g>";
}
[[nodiscard]] inline std::string lane_sample(std::string const& layer, std::string const& content) {
  return area_sample("driving") + "<g class=\"" + layer + "\">" + content + "</g>";
}

/// The entries in columns on a picture `width` [px] wide.
[[nodiscard]] inline MapLegend map_legend(std::vector<LegendEntry> const& entries, double width) {
  constexpr double column = 180.0, row = 20.0, margin = 8.0;  // [px]
  auto const columns = static_cast<std::size_t>(std::max(1.0, (width - margin) / column));
  std::string text = "<g class=\"legend\">";
  for (std::size_t i = 0; i < entries.size(); ++i) {
    auto const across = i % columns, down = i / columns;
    double const x = margin + column * static_cast<double>(across);
    double const y = margin + row * static_cast<double>(down);
    text += "<g transform=\"translate(" + svg_number(x) + ' ' + svg_number(y) + ")\"><g transform=\"scale(8)\">" +
            entries[i].sample + "</g><text x=\"30\" y=\"10\" font-size=\"12\">" + entries[i].text + "</text></g>\n";
  }
  auto const rows = (entries.size() + columns - 1) / columns;
  return {text + "</g>", static_cast<double>(rows) * row + 2.0 * margin};
}

}  // namespace cambium::inline v0_1::detail
