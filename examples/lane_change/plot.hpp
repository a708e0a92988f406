#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cambium/benchmark/statistics.hpp"
#include "cambium/viewer/detail/svg_panel.hpp"

/// The results of the experiment: JSON, and bar charts over the variations.
namespace lane_change {

using cambium::detail::svg_number;

/// The result of a cell.
struct Row {
  std::string preset;
  std::size_t iterations = 0;
  double variation = 0.0;
  std::uint64_t scenarios = 0, success = 0, collision = 0, time_out = 0;
  double mean_steps = 0.0;             ///< of the successes; NaN if there are none
  double iterations_per_second = 0.0;  ///< of one thread
};

/// A row as JSON: counts, and shares with their 95 % intervals.
inline nlohmann::ordered_json as_json(Row const& row) {
  nlohmann::ordered_json json{{"preset", row.preset},
                              {"iterations", row.iterations},
                              {"variation", row.variation},
                              {"scenarios", row.scenarios}};
  struct Kind {
    char const* name;
    std::uint64_t count;
  };
  for (auto const& [name, count] :
       {Kind{"success", row.success}, Kind{"collision", row.collision}, Kind{"time_out", row.time_out}}) {
    auto const interval = cambium::wilson_interval(count, row.scenarios);
    json[name] = {{"count", count},
                  {"share", static_cast<double>(count) / static_cast<double>(row.scenarios)},
                  {"low", interval.low},
                  {"high", interval.high}};
  }
  json["mean_steps"] = std::isfinite(row.mean_steps) ? nlohmann::ordered_json(row.mean_steps) : nullptr;
  json["iterations_per_second"] = row.iterations_per_second;
  return json;
}

/// Horizontal positions of the cells' bars [px]; those of one variation are side by side.
struct Slots {
  std::vector<double> begin;
  double width = 0.0, end = 0.0;
};

inline Slots slots_of(std::vector<Row> const& rows, double left) {
  Slots slots;
  slots.width = std::clamp(620.0 / static_cast<double>(rows.size()), 34.0, 60.0);
  double x = left;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i > 0 && rows[i - 1].variation != rows[i].variation) x += 0.5 * slots.width;
    slots.begin.push_back(x);
    x += slots.width;
  }
  slots.end = x;
  return slots;
}

inline std::string text(double x, double y, std::string const& words, std::string const& more) {
  return "<text x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) + "\" " + more + ">" + words + "</text>\n";
}

/// Bars of one share over all cells, grouped by variation, with their intervals.
inline std::string panel(std::vector<Row> const& rows, double top, std::string const& title, std::string const& color,
                         std::uint64_t Row::*count) {
  constexpr double left = 70, height = 150;
  auto const slots = slots_of(rows, left);
  auto const y_of = [&](double share) { return top + height * (1.0 - share); };
  std::string svg = text(left, top - 8, title, "font-weight=\"bold\"") +
                    text(left - 6, top + height + 14, "iterations", "text-anchor=\"end\" font-size=\"10\"") +
                    text(left - 6, top + height + 28, "variation", "text-anchor=\"end\" font-size=\"10\"");
  for (int tick = 0; tick <= 100; tick += 25) {
    double const y = y_of(tick / 100.0);
    svg +=
        "<path d=\"M" + svg_number(left) + " " + svg_number(y) + "H" + svg_number(slots.end) + "\" stroke=\"#ddd\"/>\n";
    svg += text(left - 6, y + 4, std::to_string(tick), "text-anchor=\"end\" fill=\"#666\"");
  }
  double group = slots.begin.front();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto const& row = rows[i];
    double const x = slots.begin[i], middle = x + 0.5 * slots.width;
    auto const n = row.*count;
    double const share = static_cast<double>(n) / static_cast<double>(row.scenarios);
    auto const bounds = cambium::wilson_interval(n, row.scenarios);
    svg += "<rect x=\"" + svg_number(x + 0.15 * slots.width) + "\" y=\"" + svg_number(y_of(share)) + "\" width=\"" +
           svg_number(0.7 * slots.width) + "\" height=\"" + svg_number(height * share) + "\" fill=\"" + color +
           "\"/>\n";
    svg += "<path d=\"M" + svg_number(middle) + " " + svg_number(y_of(bounds.low)) + "V" +
           svg_number(y_of(bounds.high)) + "\" stroke=\"#222\"/>\n";
    svg += text(middle, top + height + 14, std::to_string(row.iterations), "text-anchor=\"middle\" font-size=\"10\"");
    if (i > 0 && rows[i - 1].variation != row.variation) group = x;
    if (i + 1 == rows.size() || rows[i + 1].variation != row.variation)
      svg += text(0.5 * (group + x + slots.width), top + height + 28, svg_number(100 * row.variation, 0) + " %",
                  "text-anchor=\"middle\" font-size=\"10\"");
  }
  return svg;
}

/// Bar charts of all three shares, one below the other, as SVG text.
inline std::string plot(std::vector<Row> const& rows) {
  auto const width = svg_number(std::max(500.0, slots_of(rows, 70).end + 20));
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + width +
         " 650\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n<rect width=\"" + width +
         "\" height=\"650\" fill=\"#fff\"/>\n" +
         panel(rows, 30, "success [%], preset " + rows.front().preset, "#2e7d32", &Row::success) +
         panel(rows, 240, "collision [%]", "#c62828", &Row::collision) +
         panel(rows, 450, "time-out [%]", "#1565c0", &Row::time_out) +
         text(70, 642, std::to_string(rows.front().scenarios) + " scenarios per cell; black: 95 % intervals (Wilson)",
              "font-size=\"10\" fill=\"#666\"") +
         "</svg>\n";
}

}  // namespace lane_change
