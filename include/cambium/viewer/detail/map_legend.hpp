#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/viewer/detail/svg_panel.hpp"

namespace cambium::detail {

/// The kind of map element that a legend entry shows.
enum class LegendShape : std::uint8_t { area, arrow, link, dot, stretch, conflict };

struct LegendEntry {
  LegendShape shape;
  std::string_view name;  ///< CSS classes that give its colour
  std::string text;
};

/// The legend of a map picture: SVG in pixels, and its height [px].
struct MapLegend {
  std::string text;
  double height = 0.0;
};

/// A sample of the entry's map element, 3 m by 1.5 m.
[[nodiscard]] inline std::string legend_sample(LegendEntry const& entry) {
  std::string const name(entry.name);
  std::string const lane = "<g class=\"areas\"><path class=\"driving\" d=\"M0 0H3V1.5H0Z\"/></g>";
  switch (entry.shape) {
    case LegendShape::area:
      return "<g class=\"areas\"><path class=\"" + name + "\" d=\"M0 0H3V1.5H0Z\"/></g>";
    case LegendShape::arrow:
      return lane + "<g class=\"arrows\"><path d=\"M.5.83H2.4V1.15L2.7.75 2.4.35V.67H.5Z\"/></g>";
    case LegendShape::link:
      return lane + "<g class=\"links\"><path d=\"M.3.75H2.4\"/><path class=\"tip\" d=\"M2.7.75L2 1.05V.45Z\"/></g>";
    case LegendShape::dot:
      return "<g class=\"links\"><g class=\"" + name + "\"><circle cx=\"1.5\" cy=\".75\" r=\".5\"/></g></g>";
    case LegendShape::stretch:
      return lane + "<g class=\"overlaps\"><path class=\"" + name + "\" d=\"M0 .75H3\"/></g>";
    case LegendShape::conflict:
      return lane + "<g class=\"conflicts\"><path d=\"M.2 .2H2.8V1.3H.2Z\"/></g>";
  }
  return {};
}

/// The entries in columns on a picture `width` [px] wide.
[[nodiscard]] inline MapLegend map_legend(std::vector<LegendEntry> const& entries, double width) {
  constexpr double column = 180.0, row = 20.0, margin = 8.0;  // [px]
  auto const columns = static_cast<std::size_t>(std::max(1.0, (width - margin) / column));
  std::string text = "<g class=\"legend\">";
  for (std::size_t i = 0; i < entries.size(); ++i) {
    double const x = margin + column * static_cast<double>(i % columns);
    double const y = margin + row * static_cast<double>(i / columns);
    text += "<g transform=\"translate(" + svg_number(x) + ' ' + svg_number(y) + ")\"><g transform=\"scale(8)\">" +
            legend_sample(entries[i]) + "</g><text x=\"30\" y=\"10\" font-size=\"12\">" + entries[i].text +
            "</text></g>\n";
  }
  auto const rows = static_cast<double>((entries.size() + columns - 1) / columns);
  return {text + "</g>", rows * row + 2.0 * margin};
}

}  // namespace cambium::detail
