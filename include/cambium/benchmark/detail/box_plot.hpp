#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "cambium/core/markup.hpp"

namespace cambium::inline v0_1::detail {

/// A row of a box plot.
struct BoxPlotRow {
  std::string label;
  std::vector<double> values;  ///< finite, sorted
  std::size_t not_finite = 0;  ///< number of values that are left out
};

/// `value` with four significant digits, in the shortest form; `null` if it is not finite.
[[nodiscard]] inline std::string short_number(double value) {
  if (!std::isfinite(value)) return "null";
  char buffer[40];
  auto const end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 4).ptr;
  return {buffer, end};
}

/// The value below which a share of the sorted values lies, interpolated. `values` must not be empty.
[[nodiscard]] inline double quantile_of(std::vector<double> const& values, double share) {
  double const place = share * static_cast<double>(values.size() - 1);
  auto const below = static_cast<std::size_t>(place);
  auto const above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

/// The horizontal axis of a plot: linear, or logarithmic where the rows differ by more than a decade.
struct PlotAxis {
  double low = 0.0, high = 1.0, left = 0.0, right = 1.0;
  bool is_logarithmic = false;

  PlotAxis(std::vector<BoxPlotRow> const& rows, double left_end, double right_end) : left(left_end), right(right_end) {
    double least_median = 0.0, largest_median = 0.0;
    bool is_first = true;
    for (auto const& row : rows) {
      if (row.values.empty()) continue;
      low = is_first ? row.values.front() : std::min(low, row.values.front());
      high = is_first ? row.values.back() : std::max(high, row.values.back());
      double const median = quantile_of(row.values, 0.5);
      least_median = is_first ? median : std::min(least_median, median);
      largest_median = is_first ? median : std::max(largest_median, median);
      is_first = false;
    }
    is_logarithmic = low > 0.0 && largest_median > 30.0 * least_median;
    if (is_logarithmic) return;
    if (high <= low) high = low + std::max(1e-3, 1e-3 * std::abs(low));
  }

  [[nodiscard]] double at(double value) const {
    double const share = is_logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    return left + share * (right - left);
  }

  /// Round numbers along the axis.
  [[nodiscard]] std::vector<double> ticks() const {
    std::vector<double> result;
    if (is_logarithmic) {
      int const first = static_cast<int>(std::ceil(std::log10(low))), last = static_cast<int>(std::log10(high));
      int const stride = std::max(1, (last - first) / 5);
      for (int e = first; e <= last; e += stride) result.push_back(std::pow(10.0, e));
      return result;
    }
    double const rough = (high - low) / 5, power = std::pow(10.0, std::floor(std::log10(rough)));
    double const step = power * (rough > 5 * power ? 10.0 : rough > 2 * power ? 5.0 : rough > power ? 2.0 : 1.0);
    for (double k = std::ceil(low / step); k * step <= high; ++k) result.push_back(k * step);
    return result;
  }
};

/// Box plots below each other, as SVG: quartiles and median, whiskers from 5 to 95 %, and at most 200 of the values as
/// dots, evenly by rank, the extremes among them.
[[nodiscard]] inline std::string box_plot(std::vector<BoxPlotRow> const& rows) {
  constexpr double width = 480, label_width = 128, row_height = 26, top = 4, most_dots = 200;
  PlotAxis const axis(rows, label_width + 6, width - 44);
  auto const number = [](double value) {
    std::string text;
    append_number(text, value, 1);
    return text;
  };
  double const bottom = top + row_height * static_cast<double>(rows.size());
  std::string svg = "<svg viewBox=\"0 0 " + number(width) + " " + number(bottom + 18) + "\" role=\"img\">";
  for (double const tick : axis.ticks())
    svg += "<path class=\"grid\" d=\"M" + number(axis.at(tick)) + " " + number(top) + "V" + number(bottom) +
           "\"/><text text-anchor=\"middle\" x=\"" + number(axis.at(tick)) + "\" y=\"" + number(bottom + 13) + "\">" +
           short_number(std::abs(tick) < 1e-12 ? 0.0 : tick) + "</text>";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto const& values = rows[i].values;
    double const middle = top + row_height * (static_cast<double>(i) + 0.5);
    std::string name = rows[i].label;
    if (name.size() > 21) {
      std::size_t cut = 20;
      while (cut > 0 && (static_cast<unsigned char>(name[cut]) & 0xC0u) == 0x80u) --cut;
      name = name.substr(0, cut) + "\xE2\x80\xA6";
    }
    svg += "<text class=\"name\" text-anchor=\"end\" x=\"" + number(label_width) + "\" y=\"" + number(middle + 4) +
           "\"><title>" + escape_markup(rows[i].label) + "</title>" + escape_markup(name) + "</text>";
    if (rows[i].not_finite > 0)
      svg += "<text x=\"" + number(width - 38) + "\" y=\"" + number(middle + 4) +
             "\"><title>runs without a value</title>" + std::to_string(rows[i].not_finite) + " none</text>";
    if (values.empty()) continue;
    auto const dots = std::min(static_cast<double>(values.size()), most_dots);
    svg += "<path class=\"dots\" d=\"";
    for (double k = 0; k < dots; ++k) {
      auto const place = dots > 1 ? k / (dots - 1) * static_cast<double>(values.size() - 1) : 0.0;
      double const jitter = std::fmod(0.618034 * k, 1.0) - 0.5;
      svg += "M" + number(axis.at(values[static_cast<std::size_t>(std::lround(place))])) + " " +
             number(middle + 14 * jitter) + "h0";
    }
    auto const x = [&](double share) { return axis.at(quantile_of(values, share)); };
    svg += "\"/><path class=\"whisker\" d=\"M" + number(x(0.05)) + " " + number(middle) + "H" + number(x(0.25)) + "M" +
           number(x(0.75)) + " " + number(middle) + "H" + number(x(0.95)) +
           "\"/><rect class=\"box\" fill-opacity=\".7\" x=\"" + number(x(0.25)) + "\" y=\"" + number(middle - 6) +
           "\" width=\"" + number(x(0.75) - x(0.25)) + "\" height=\"12\" rx=\"2\"/><path class=\"median\" d=\"M" +
           number(x(0.5)) + " " + number(middle - 6) + "v12\"/>";
  }
  return svg + "</svg>";
}

}  // namespace cambium::inline v0_1::detail
