#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "cambium/viewer/detail/svg_panel.hpp"

/// Draws diagrams as SVG.
namespace ring {

namespace cb = cambium;
using cb::detail::svg_number;

/// A diagram: a rectangle [px] with axes over ranges of two quantities.
struct Diagram {
  double left, top, width, height;
  double x_low, x_high, y_low, y_high;

  [[nodiscard]] double px(double x) const { return left + (x - x_low) / (x_high - x_low) * width; }
  [[nodiscard]] double py(double y) const { return top + height - (y - y_low) / (y_high - y_low) * height; }

  [[nodiscard]] static std::string text(double x, double y, std::string const& words, std::string const& more = {}) {
    return "<text x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) + "\" " + more + ">" + words + "</text>\n";
  }

  /// Frame, ticks every `x_tick` and `y_tick`, titles.
  [[nodiscard]] std::string axes(double x_tick, double y_tick, std::string const& title, std::string const& x_title,
                                 std::string const& y_title) const {
    std::string svg = cb::detail::svg_box(left, top, width, height, "fill=\"none\" stroke=\"#888\"") + "\n";
    auto const line = [](double x1, double y1, double x2, double y2) {
      return "<path d=\"M" + svg_number(x1) + " " + svg_number(y1) + "L" + svg_number(x2) + " " + svg_number(y2) +
             "\" stroke=\"#888\"/>\n";
    };
    for (double x = x_low; x <= x_high * (1 + 1e-9); x += x_tick)
      svg += line(px(x), top + height, px(x), top + height + 4) +
             text(px(x), top + height + 17, svg_number(x, 0), "text-anchor=\"middle\"");
    for (double y = y_low; y <= y_high * (1 + 1e-9); y += y_tick)
      svg += line(left - 4, py(y), left, py(y)) + text(left - 7, py(y) + 4, svg_number(y, 0), "text-anchor=\"end\"");
    std::string const middle = svg_number(top + height / 2);
    return svg + text(left, top - 10, title, "font-weight=\"bold\"") +
           text(left + width / 2, top + height + 34, x_title, "text-anchor=\"middle\"") +
           text(0, 0, y_title,
                "text-anchor=\"middle\" transform=\"translate(" + svg_number(left - 46) + " " + middle +
                    ") rotate(-90)\"");
  }
};

/// Polylines as one SVG path, to a tenth of a pixel.
class Path {
 public:
  /// Adds a line from one point to another [px]; continues the last line if it ended there.
  void add(double x1, double y1, double x2, double y2) {
    if (auto const from = point(x1, y1); from != last_) data_ += 'M' + from;
    last_ = point(x2, y2);
    data_ += 'L' + last_;
  }
  [[nodiscard]] std::string svg(std::string const& style) const {
    return "<path d=\"" + data_ + "\" fill=\"none\" " + style + "/>\n";
  }

 private:
  [[nodiscard]] static std::string point(double x, double y) { return svg_number(x, 1) + " " + svg_number(y, 1); }

  std::string data_, last_;
};

/// A density at which traffic was measured.
struct DensityPoint {
  double density{}, flow{};  ///< [1/km], [1/h]
  double equilibrium{};      ///< flow of steady following [1/h]
  bool is_stable{};
};

/// A vehicle at one time [s]: its position on the ring [m] and its speed [m/s].
struct TracePoint {
  double time{}, place{}, speed{};
};

struct Shown {
  std::string driver;
  std::vector<DensityPoint> curve, points;      ///< theory; measurements
  std::vector<std::vector<TracePoint>> traces;  ///< of every other vehicle
  double length{}, density{}, end{};            ///< of the ring and the traces [m], [1/km], [s]
};

/// Flow against density: theory as a line, dashed where it is unstable; measurements as dots.
inline std::string draw_fundamental_diagram(Shown const& shown, Diagram const& d) {
  std::string svg =
      d.axes(20, 500, "Fundamental diagram: " + shown.driver, "density [vehicles/km]", "flow [vehicles/h]");
  for (bool const stable : {true, false}) {
    Path path;
    for (std::size_t i = 1; i < shown.curve.size(); ++i) {
      auto const &a = shown.curve[i - 1], &b = shown.curve[i];
      if (b.is_stable != stable) continue;
      path.add(d.px(a.density), d.py(a.equilibrium), d.px(b.density), d.py(b.equilibrium));
    }
    svg += path.svg(stable ? "stroke=\"#1565c0\" stroke-width=\"2\""
                           : "stroke=\"#c62828\" stroke-width=\"1.5\" stroke-dasharray=\"3 3\"");
  }
  for (auto const& p : shown.points)
    svg += "<circle cx=\"" + svg_number(d.px(p.density)) + "\" cy=\"" + svg_number(d.py(p.flow)) +
           "\" r=\"3\" fill=\"" + (p.is_stable ? "#1565c0" : "#c62828") + "\"/>\n";
  char const* const legend[][2] = {{"#1565c0", "line: steady following, string stable"},
                                   {"#c62828", "dashed: steady following, unstable"},
                                   {"#333", "dots: measured on the ring"}};
  for (std::size_t i = 0; i < 3; ++i)
    svg += Diagram::text(d.left + d.width - 8, d.top + 18 + 16 * static_cast<double>(i), legend[i][1],
                         std::string("text-anchor=\"end\" fill=\"") + legend[i][0] + "\"");
  return svg;
}

/// The colour of one of 6 classes of speed, from red (stopped) through yellow to green (fastest).
inline std::string color_of_class(int number) {
  char const* const colors[] = {"#b71c1c", "#e64a19", "#f9a825", "#c0ca33", "#66bb6a", "#2e7d32"};
  return colors[number];
}

/// Space-time diagram: positions on the ring over time, coloured by speed.
inline std::string draw_space_time(Shown const& shown, Diagram const& d, double fastest) {
  constexpr int classes = 6;
  std::vector<Path> paths(classes);
  for (auto const& trace : shown.traces)
    for (std::size_t i = 1; i < trace.size(); ++i) {
      auto const &a = trace[i - 1], &b = trace[i];
      int const number = std::clamp(static_cast<int>(classes * a.speed / fastest), 0, classes - 1);
      auto& path = paths[static_cast<std::size_t>(number)];
      if (b.place >= a.place) {
        path.add(d.px(a.time), d.py(a.place), d.px(b.time), d.py(b.place));
        continue;
      }
      double const share = (shown.length - a.place) / (shown.length - a.place + b.place);  // it passed the start
      double const between = d.px(a.time + share * (b.time - a.time));
      path.add(d.px(a.time), d.py(a.place), between, d.py(shown.length));
      path.add(between, d.py(0), d.px(b.time), d.py(b.place));
    }
  std::string svg;
  for (int i = classes - 1; i >= 0; --i)
    svg += paths[static_cast<std::size_t>(i)].svg("stroke-width=\"1\" stroke=\"" + color_of_class(i) + "\"");
  svg += d.axes(120, 500,
                "Waves at " + svg_number(shown.density, 0) +
                    " vehicles/km: paths of every other vehicle, red (stopped) to green (" +
                    svg_number(3.6 * fastest, 0) + " km/h)",
                "time [s]", "position on the ring [m]");
  return svg;
}

/// Both diagrams side by side, as SVG text.
inline std::string picture(Shown const& shown) {
  double highest = 500.0, fastest = 1.0;
  for (auto const& p : shown.curve) highest = std::max(highest, p.equilibrium);
  for (auto const& trace : shown.traces)
    for (auto const& p : trace) fastest = std::max(fastest, p.speed);
  Diagram const flow{70, 40, 380, 340, 0, 160, 0, 500 * std::ceil(highest * 1.05 / 500)};
  Diagram const waves{530, 40, 640, 340, 0, shown.end, 0, shown.length};
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1190 430\" font-family=\"sans-serif\" "
         "font-size=\"12\" fill=\"#222\">\n<rect width=\"1190\" height=\"430\" fill=\"#fff\"/>\n" +
         draw_fundamental_diagram(shown, flow) + draw_space_time(shown, waves, fastest) + "</svg>\n";
}

}  // namespace ring
