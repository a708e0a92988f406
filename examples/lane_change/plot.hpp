#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cambium/viewer/detail/svg_panel.hpp"

/// The results of the grid: intervals, JSON, and bars over the variations.
namespace lane_change {

using cambium::detail::svg_number;

/// What came of a cell.
struct Row {
  std::string preset;
  std::size_t iterations = 0;
  double variation = 0.0;
  std::uint64_t scenarios = 0, success = 0, collision = 0, timeout = 0;
  double mean_steps = 0.0;             ///< of the successes; NaN without
  double iterations_per_second = 0.0;  ///< of one thread
};

struct Interval {
  double low, high;
};

/// Of a share, 95 % (Wilson 1927).
inline Interval wilson(std::uint64_t count, std::uint64_t n) {
  constexpr double z = 1.959963984540054;
  auto const total = static_cast<double>(n);
  double const p = static_cast<double>(count) / total;
  double const middle = (p + z * z / (2 * total)) / (1 + z * z / total);
  double const half = z / (1 + z * z / total) * std::sqrt(p * (1 - p) / total + z * z / (4 * total * total));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

inline nlohmann::ordered_json as_json(Row const& row) {
  auto const share = [&](std::uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(row.scenarios);
  };
  nlohmann::ordered_json json{{"preset", row.preset},          {"iterations", row.iterations},
                              {"variation", row.variation},    {"scenarios", row.scenarios},
                              {"success", share(row.success)}, {"collision", share(row.collision)},
                              {"timeout", share(row.timeout)}};
  json["mean_steps"] = std::isfinite(row.mean_steps) ? nlohmann::ordered_json(row.mean_steps) : nullptr;
  json["iterations_per_second"] = row.iterations_per_second;
  return json;
}

/// Bars of one share over all cells, grouped by variation, with their intervals.
inline std::string panel(std::vector<Row> const& rows, double top, std::string const& title, std::string const& color,
                         std::uint64_t Row::*count) {
  constexpr double left = 60, width = 620, height = 150;
  std::string svg;
  auto const text = [&](double x, double y, std::string const& words, std::string const& more) {
    svg += "<text x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) + "\" " + more + ">" + words + "</text>\n";
  };
  auto const y_of = [&](double share) { return top + height * (1.0 - share); };
  text(left, top - 8, title, "font-weight=\"bold\"");
  for (int tick = 0; tick <= 100; tick += 25) {
    double const y = y_of(tick / 100.0);
    svg += "<path d=\"M" + svg_number(left) + " " + svg_number(y) + "h" + svg_number(width) + "\" stroke=\"#ddd\"/>\n";
    text(left - 6, y + 4, std::to_string(tick), "text-anchor=\"end\" fill=\"#666\"");
  }
  double const slot = width / static_cast<double>(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto const& row = rows[i];
    double const x = left + slot * (static_cast<double>(i) + 0.2);
    auto const n = row.*count;
    double const share = static_cast<double>(n) / static_cast<double>(row.scenarios);
    auto const bounds = wilson(n, row.scenarios);
    svg += "<rect x=\"" + svg_number(x) + "\" y=\"" + svg_number(y_of(share)) + "\" width=\"" + svg_number(0.6 * slot) +
           "\" height=\"" + svg_number(height * share) + "\" fill=\"" + color + "\"/>\n";
    svg += "<path d=\"M" + svg_number(x + 0.3 * slot) + " " + svg_number(y_of(bounds.low)) + "V" +
           svg_number(y_of(bounds.high)) + "\" stroke=\"#222\"/>\n";
    text(x + 0.3 * slot, top + height + 14, std::to_string(row.iterations), "text-anchor=\"middle\" font-size=\"10\"");
    if (i == 0 || rows[i - 1].variation != row.variation)
      text(x, top + height + 28, svg_number(100 * row.variation, 0) + " % variation", "font-size=\"10\"");
  }
  return svg;
}

/// All three shares, one below the other, as SVG text.
inline std::string plot(std::vector<Row> const& rows) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 700 620\" font-family=\"sans-serif\" "
         "font-size=\"12\" fill=\"#222\">\n<rect width=\"700\" height=\"620\" fill=\"#fff\"/>\n" +
         panel(rows, 30, "success [%], preset " + rows.front().preset + ", by iterations and variation", "#2e7d32",
               &Row::success) +
         panel(rows, 235, "collision [%]", "#c62828", &Row::collision) +
         panel(rows, 440, "time-out [%]", "#1565c0", &Row::timeout) + "</svg>\n";
}

}  // namespace lane_change
