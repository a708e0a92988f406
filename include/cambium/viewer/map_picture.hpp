#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/map/map.hpp"
#include "cambium/viewer/detail/map_page.hpp"
#include "cambium/viewer/detail/svg_panel.hpp"
#include "cambium/viewer/detail/text.hpp"

namespace cambium {

/// What `svg_map_picture` shows besides the lanes.
struct MapPictureOptions {
  double width = 1600.0;  ///< of the picture [px]; its height follows from the map
  std::string title{};
  bool arrows = true;    ///< travel directions
  bool labels = true;    ///< road:lane
  bool links = true;     ///< from each lane to its successors; dots where a drivable lane ends or begins without one
  bool overlaps = true;  ///< where lanes cross, merge and split
};

namespace detail {

/// Draws a map as SVG in layers, in metres, with the map's y axis upwards.
class MapDrawing {
 public:
  MapDrawing(Map const& map, MapPictureOptions const& options) : map_(map), options_(options) {
    for (auto const& lane : map.lanes())
      for (auto const* line : {&lane.path, &lane.left, &lane.right})
        for (auto const& p : line->points()) box_.add(p.x(), p.y());
    box_ = box_.grown(5.0);
  }

  [[nodiscard]] std::string text() {
    double const width = box_.max_x - box_.min_x, height = box_.max_y - box_.min_y;
    double const scale = options_.width / width;
    out_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" id=\"map\" width=\"" + svg_number(options_.width) +
           "\" height=\"" + svg_number(std::max(60.0, height * scale)) + "\" viewBox=\"0 0 " + svg_number(width) + ' ' +
           svg_number(height) + "\" data-west=\"" + svg_number(box_.min_x) + "\" data-north=\"" +
           svg_number(box_.max_y) + "\" font-family=\"system-ui,'DejaVu Sans',sans-serif\">\n<title>" +
           escape_markup(options_.title) + "</title>\n<style>" + std::string(map_picture_style) + "</style>\n";
    out_ += "<rect class=\"ground\" width=\"100%\" height=\"100%\"/>\n";
    layer("areas", [this] { draw_areas(); });
    if (options_.overlaps) layer("overlaps", [this] { draw_overlaps(); });
    if (options_.arrows) layer("arrows", [this] { draw_arrows(); });
    if (options_.links) layer("links", [this] { draw_links(); });
    if (options_.labels) layer("labels", [this] { draw_labels(); });
    draw_scale_bar(scale, height);
    return out_ + "</svg>\n";
  }

 private:
  template <class Draw>
  void layer(char const* name, Draw const& draw) {
    out_ += std::string("<g class=\"") + name + "\">\n";
    draw();
    out_ += "</g>\n";
  }

  [[nodiscard]] std::string place(geometry::Point const& p) const {
    return svg_number(p.x() - box_.min_x) + ' ' + svg_number(box_.max_y - p.y());
  }
  [[nodiscard]] std::string turned(geometry::Pose const& pose) const {
    return "translate(" + place(pose.position()) + ")rotate(" +
           svg_number(-pose.heading * 180.0 / std::numbers::pi, 1) + ")";
  }
  [[nodiscard]] std::string path(std::vector<geometry::Point> const& points) const {
    std::string text;
    for (auto const& p : points) text += (text.empty() ? 'M' : 'L') + place(p);
    return text;
  }

  /// The part of a lane's path from `begin` to `end` [m].
  [[nodiscard]] static std::vector<geometry::Point> stretch(map::Lane const& lane, double begin, double end) {
    std::vector<geometry::Point> points{lane.path.pose(begin).position()};
    for (auto const& g : lane.path.segments())
      if (g.s > begin && g.s < end) points.emplace_back(g.x, g.y);
    points.push_back(lane.path.pose(end).position());
    return points;
  }

  [[nodiscard]] std::string name_of(map::Lane const& lane) const {
    return escape_markup(map_.road(lane.road).name) + ':' + std::to_string(lane.number);
  }

  [[nodiscard]] std::string tooltip(map::Lane const& lane) const {
    std::string text = "road " + escape_markup(map_.road(lane.road).name) + ", section " +
                       std::to_string(lane.section) + ", lane " + std::to_string(lane.number) + " (" +
                       std::string(to_string(lane.type)) + "), " + svg_number(lane.length(), 1) + " m";
    double const limit = lane.speed_limit_at(0.5 * lane.length());
    if (std::isfinite(limit)) text += ", " + svg_number(3.6 * limit, 0) + " km/h";
    for (auto const next : lane.successors) text += "\nto " + name_of(map_.lane(next));
    if (is_valid(lane.merges_into)) text += "\nmerges into " + name_of(map_.lane(lane.merges_into));
    return text;
  }

  void draw_areas() {
    for (bool const drivable : {false, true})
      for (auto const& lane : map_.lanes()) {
        if (lane.drivable() != drivable) continue;
        auto outline = lane.left.points();
        auto const right = lane.right.points();
        outline.insert(outline.end(), right.rbegin(), right.rend());
        if (outline.size() < 3) continue;
        bool const in_junction = drivable && is_valid(map_.road(lane.road).junction);
        out_ += "<path class=\"" + std::string(drivable ? "driving" : to_string(lane.type)) +
                (in_junction ? " junction" : "") + "\" d=\"" + path(outline) + "Z\"><title>" + tooltip(lane) +
                "</title></path>\n";
      }
  }

  void draw_overlaps() {
    static constexpr char const* names[] = {"merge", "split", "crossing"};
    for (auto const& lane : map_.lanes())
      for (auto const& overlap : lane.overlaps)
        out_ += std::string("<path class=\"") + names[static_cast<std::size_t>(overlap.kind)] + "\" d=\"" +
                path(stretch(lane, overlap.begin, overlap.end)) + "\"><title>" + name_of(lane) + ": " +
                names[static_cast<std::size_t>(overlap.kind)] + " with " + name_of(map_.lane(overlap.other)) +
                "</title></path>\n";
  }

  void draw_arrows() {
    constexpr double spacing = 30.0, shortest = 4.0;  // [m]
    for (auto const& lane : map_.lanes()) {
      if (!lane.drivable() || lane.length() < shortest) continue;
      int const count = std::max(1, static_cast<int>(lane.length() / spacing));
      for (int i = 0; i < count; ++i)
        out_ += "<path transform=\"" + turned(lane.path.pose(lane.length() * (i + 0.25) / count)) +
                "\" d=\"M-1.5.08H.4V.4L1.5 0 .4-.4V-.08H-1.5Z\"/>\n";
    }
  }

  void draw_links() {
    constexpr double reach = 2.5;  // [m]
    for (auto const& lane : map_.lanes()) {
      auto const end = lane.path.pose(lane.length());
      auto const from = lane.path.pose(lane.length() - std::min(reach, lane.length() / 3)).position();
      for (auto const id : lane.successors) {
        auto const& next = map_.lane(id);
        auto const to = next.path.pose(std::min(reach, next.length() / 3));
        out_ += "<path d=\"M" + place(from) + "Q" + place(end.position()) + ' ' + place(to.position()) +
                "\"/><path class=\"tip\" transform=\"" + turned(to) + "\" d=\"M0 0L-.7.3V-.3Z\"/>\n";
      }
      if (!lane.drivable()) continue;
      if (lane.successors.empty()) draw_dot("end", lane, end.position());
      if (lane.predecessors.empty()) draw_dot("begin", lane, lane.path.pose(0.0).position());
    }
  }

  void draw_dot(char const* kind, map::Lane const& lane, geometry::Point const& at) {
    out_ += std::string("<g class=\"") + kind + "\" transform=\"translate(" + place(at) +
            ")\"><circle r=\".5\"/><title>" + name_of(lane) + (kind[0] == 'e' ? " ends here" : " begins here") +
            "</title></g>\n";
  }

  void draw_labels() {
    constexpr double shortest = 4.0;  // [m]
    for (auto const& lane : map_.lanes()) {
      if (lane.length() < shortest) continue;
      double const s = 0.5 * lane.length();
      auto const widths = lane.widths_at(s);
      if (widths.left + widths.right < 0.8) continue;
      auto pose = lane.path.pose(s);
      if (std::cos(pose.heading) < 0.0) pose.heading += std::numbers::pi;
      double const size = is_valid(map_.road(lane.road).junction) ? 0.7 : 1.1;
      out_ += "<text transform=\"" + turned(pose) + "\" font-size=\"" +
              svg_number(std::min(size, 0.5 * (widths.left + widths.right)), 2) + "\" dy=\".35em\">" + name_of(lane) +
              "</text>\n";
    }
  }

  /// A bar of a round length, some 120 px long.
  void draw_scale_bar(double scale, double height) {
    double const wanted = 120.0 / scale, power = std::pow(10.0, std::floor(std::log10(wanted)));
    double const length = wanted >= 5 * power ? 5 * power : wanted >= 2 * power ? 2 * power : power;
    double const pixel = 1.0 / scale;
    out_ += "<g class=\"scale\" transform=\"translate(" + svg_number(12 * pixel, 3) + ' ' +
            svg_number(height - 12 * pixel, 3) + ")\">" + svg_box(0, -3 * pixel, length, 3 * pixel, "") + "<text y=\"" +
            svg_number(-6 * pixel, 3) + "\" font-size=\"" + svg_number(12 * pixel, 3) + "\">" + svg_number(length) +
            " m</text></g>\n";
  }

  Map const& map_;
  MapPictureOptions const& options_;
  geometry::Box box_;
  std::string out_;
};

}  // namespace detail

/// A picture of the map as SVG: lanes in the colours of their types, travel directions, ids (road:lane), links to
/// successors, and where lanes cross (red), merge (orange) and split (violet). What the pointer rests on says what it
/// is. Deterministic; its size is some 50 B per vertex of the map's lanes.
[[nodiscard]] inline std::string svg_map_picture(Map const& map, MapPictureOptions const& options = {}) {
  return detail::MapDrawing(map, options).text();
}

/// The same as a page of its own that zooms, pans, and switches layers on and off; opened with `#at=X,Y,WIDTH` it shows
/// the `WIDTH` metres around (X, Y).
[[nodiscard]] inline std::string html_map_picture(Map const& map, MapPictureOptions const& options = {}) {
  return detail::map_page(options.title, svg_map_picture(map, options));
}

/// Writes the picture to `path`, as SVG or as HTML by its ending. Throws `Error` for another ending and where it cannot
/// be written.
inline void write_map_picture(std::filesystem::path const& path, Map const& map,
                              MapPictureOptions const& options = {}) {
  auto const ending = path.extension();
  if (ending != ".svg" && ending != ".html")
    throw Error(path.string(), "a map's picture is an .svg or an .html file", "name one with such an ending");
  write_file(path, ending == ".svg" ? svg_map_picture(map, options) : html_map_picture(map, options));
}

}  // namespace cambium
