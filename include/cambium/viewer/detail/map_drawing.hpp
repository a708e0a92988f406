#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/markup.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/lanes/junction.hpp"
#include "cambium/map/lanes/right_of_way.hpp"
#include "cambium/map/map.hpp"
#include "cambium/viewer/detail/map_legend.hpp"
#include "cambium/viewer/detail/map_page.hpp"
#include "cambium/viewer/detail/svg_panel.hpp"
#include "cambium/viewer/map_picture_options.hpp"

namespace cambium::inline v0_1::detail {

/// Draws a map as SVG in layers, in metres, with the map's y axis upwards.
class MapDrawing {
 public:
  MapDrawing(Map const& map, MapPictureOptions const& options) : map_(map), options_(options) {
    if (!(options.width >= 1.0 && options.width <= 1e5))
      throw Error("map picture", "it cannot be " + rounded_text(options.width) + " px wide",
                  "give a width from 1 to 100 000 px");
    if (options.part) {
      lanes_ = map.lanes_in(box_ = checked(*options.part));
    } else {
      box_ = (map.lanes().empty() ? geometry::Box{0.0, 0.0, 0.0, 0.0} : map.bounds()).grown(5.0);
      for (auto const& lane : map.lanes()) lanes_.push_back(lane.id);
    }
    double const width = box_.max_x - box_.min_x, height = box_.max_y - box_.min_y;
    double const aside = std::max(0.0, 0.5 * (height / 4.0 - width)),
                 above = std::max(0.0, 0.5 * (width / 25.0 - height));
    box_ = {box_.min_x - aside, box_.min_y - above, box_.max_x + aside, box_.max_y + above};
  }

  /// The picture as SVG text, with the legend below the map if `with_legend` is set.
  [[nodiscard]] std::string text(bool with_legend) {
    double const width = box_.max_x - box_.min_x, height = box_.max_y - box_.min_y;
    double const scale = options_.width / width;
    MapLegend const key = legend(options_.width);
    double const strip = with_legend ? key.height / scale : 0.0;
    out_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" id=\"map\" width=\"" + svg_number(options_.width) +
           "\" height=\"" + svg_number((height + strip) * scale) + "\" viewBox=\"0 0 " + svg_number(width) + ' ' +
           svg_number(height + strip) + "\" data-west=\"" + svg_number(box_.min_x) + "\" data-north=\"" +
           svg_number(box_.max_y) + "\" font-family=\"system-ui,'DejaVu Sans',sans-serif\">\n<title>" +
           escape_markup(options_.title) + "</title>\n<style>" + std::string(map_picture_style) + "</style>\n";
    out_ += "<rect class=\"ground\" width=\"100%\" height=\"100%\"/>\n";
    layer("areas", [this] { draw_areas(); });
    if (options_.conflicts) layer("conflicts", [this] { draw_conflicts(); });
    if (options_.overlaps) layer("overlaps", [this] { draw_overlaps(); });
    if (options_.arrows) layer("arrows", [this] { draw_arrows(); });
    if (options_.links) layer("links", [this] { draw_links(); });
    if (options_.labels) layer("labels", [this] { draw_labels(); });
    draw_scale_bar(scale, height);
    if (with_legend)
      out_ += "<g transform=\"translate(0 " + svg_number(height) + ")scale(" + svg_number(1.0 / scale, 6) + ")\">" +
              "<rect class=\"ground\" width=\"" + svg_number(options_.width) + "\" height=\"" + svg_number(key.height) +
              "\"/>" + key.text + "</g>\n";
    return out_ + "</svg>\n";
  }

  /// The legend of the colours that occur in the picture, as SVG in pixels.
  [[nodiscard]] MapLegend legend(double width) const {
    std::vector<LegendEntry> entries;
    std::set<std::string_view> types;
    bool has_junction = false, has_link = false, has_begin = false, has_end = false;
    std::array<bool, 3> has_overlap{};  // by kind
    for (auto const id : lanes_) {
      auto const& lane = map_.lane(id);
      if (!lane.drivable()) types.insert(to_string(lane.type));
      has_junction = has_junction || is_in_junction(lane);
      has_link = has_link || !lane.successors.empty();
      has_begin = has_begin || (lane.drivable() && lane.predecessors.empty());
      has_end = has_end || (lane.drivable() && lane.successors.empty());
      for (auto const& overlap : lane.overlaps) has_overlap[static_cast<std::size_t>(overlap.kind)] = true;
    }
    auto const add = [&entries](bool is_there, std::string const& sample, std::string const& text) {
      if (is_there) entries.push_back({sample, text});
    };
    add(true, area_sample("driving"), "drivable lane");
    add(has_junction, area_sample("driving junction"), "in a junction");
    for (auto const type : types) add(true, area_sample(std::string(type)), "lane of type " + std::string(type));
    add(options_.arrows, lane_sample("arrows", "<path d=\"M.5.83H2.4V1.15L2.7.75 2.4.35V.67H.5Z\"/>"),
        "travel direction");
    add(options_.links && has_link,
        lane_sample("links", "<path d=\"M.3.75H2.4\"/><path class=\"tip\" d=\"M2.7.75L2 1.05V.45Z\"/>"), "leads to");
    for (auto const& [is_there, kind, text] :
         {std::tuple(has_begin, "begin", "starts, no predecessor"), std::tuple(has_end, "end", "ends, no successor")})
      add(options_.links && is_there,
          std::string("<g class=\"links\"><g class=\"") + kind + "\"><circle cx=\"1.5\" cy=\".75\" r=\".5\"/></g></g>",
          text);
    for (auto const& [kind, text] : {std::pair(map::OverlapKind::crossing, "crosses another lane"),
                                     std::pair(map::OverlapKind::merge, "merges with another"),
                                     std::pair(map::OverlapKind::split, "splits from another")})
      add(options_.overlaps && has_overlap[static_cast<std::size_t>(kind)],
          lane_sample("overlaps", std::string("<path class=\"") + name_of(kind) + "\" d=\"M0 .75H3\"/>"), text);
    add(options_.conflicts && has_junction, lane_sample("conflicts", "<path d=\"M.2 .2H2.8V1.3H.2Z\"/>"),
        "shared area");
    return map_legend(entries, width);
  }

 private:
  [[nodiscard]] static geometry::Box const& checked(geometry::Box const& part) {
    double const width = part.max_x - part.min_x, height = part.max_y - part.min_y;
    if (width > 0.0 && height > 0.0 && std::isfinite(width + height)) return part;
    throw Error("map picture", "the part to show has no area or is not finite", "give a box with min < max");
  }

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
  [[nodiscard]] std::string path(std::span<geometry::Point const> points) const {
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

  [[nodiscard]] bool is_in_junction(map::Lane const& lane) const {
    return lane.drivable() && map_.in_junction(lane.id);
  }

  [[nodiscard]] std::string label_of(map::Lane const& lane) const {
    return escape_markup(map_.road(lane.road).name) + ':' + std::to_string(lane.number);
  }
  /// The label; for a lane that is driven both ways, with the direction.
  [[nodiscard]] std::string name_of(map::Lane const& lane) const {
    return label_of(lane) + (!is_valid(lane.opposite) ? "" : lane.along_road ? ", forward" : ", backward");
  }

  /// Attributes with the ids that the page's search looks for.
  [[nodiscard]] std::string search_keys(map::Lane const& lane) const {
    auto const junction = map_.road(lane.road).junction;
    return " data-lane=\"" + label_of(lane) + '"' +
           (is_valid(junction) ? " data-junction=\"" + escape_markup(map_.junction(junction).name) + '"' : "");
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
      for (auto const id : lanes_) {
        auto const& lane = map_.lane(id);
        if (lane.drivable() != drivable) continue;
        auto outline = lane.left.points();
        auto const right = lane.right.points();
        outline.insert(outline.end(), right.rbegin(), right.rend());
        if (outline.size() < 3) continue;
        out_ += "<path class=\"" + std::string(drivable ? "driving" : to_string(lane.type)) +
                (is_in_junction(lane) ? " junction" : "") + '"' + search_keys(lane) + " d=\"" + path(outline) +
                "Z\"><title>" + tooltip(lane) + "</title></path>\n";
      }
  }

  [[nodiscard]] static char const* name_of(map::OverlapKind kind) {
    static constexpr char const* names[] = {"merge", "split", "crossing"};
    return names[static_cast<std::size_t>(kind)];
  }

  void draw_overlaps() {
    for (auto const id : lanes_) {
      auto const& lane = map_.lane(id);
      for (auto const& overlap : lane.overlaps)
        out_ += std::string("<path class=\"") + name_of(overlap.kind) + "\" d=\"" +
                path(stretch(lane, overlap.begin, overlap.end)) + "\"><title>" + name_of(lane) + ": " +
                name_of(overlap.kind) + " with " + name_of(map_.lane(overlap.other)) + "</title></path>\n";
    }
  }

  void draw_conflicts() {
    auto const is_shown = [this](LaneId id) { return std::binary_search(lanes_.begin(), lanes_.end(), id); };
    for (auto const& junction : map_.junctions()) {
      if (std::none_of(junction.lanes.begin(), junction.lanes.end(), is_shown)) continue;
      for (auto const& conflict : conflict_areas(map_, junction.id)) {
        if (!conflict.area || !is_shown(conflict.first)) continue;
        auto const &first = map_.lane(conflict.first), &second = map_.lane(conflict.second);
        out_ += "<path d=\"" + path(conflict.area->points()) + "Z\"><title>area shared by " + name_of(first) + " and " +
                name_of(second);
        if (auto const road = goes_first(junction, first.road, second.road))
          out_ += "; road " + escape_markup(map_.road(*road).name) + " goes first";
        out_ += "</title></path>\n";
      }
    }
  }

  void draw_arrows() {
    constexpr double spacing = 30.0, shortest = 4.0;  // [m]
    for (auto const id : lanes_) {
      auto const& lane = map_.lane(id);
      if (!lane.drivable() || lane.length() < shortest) continue;
      int const count = std::max(1, static_cast<int>(lane.length() / spacing));
      for (int i = 0; i < count; ++i)
        out_ += "<path transform=\"" + turned(lane.path.pose(lane.length() * (i + 0.25) / count)) +
                "\" d=\"M-1.5.08H.4V.4L1.5 0 .4-.4V-.08H-1.5Z\"/>\n";
    }
  }

  void draw_links() {
    constexpr double reach = 2.5;  // [m]
    for (auto const id : lanes_) {
      auto const& lane = map_.lane(id);
      auto const end = lane.path.pose(lane.length());
      auto const from = lane.path.pose(lane.length() - std::min(reach, lane.length() / 3)).position();
      for (auto const successor : lane.successors) {
        auto const& next = map_.lane(successor);
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
    for (auto const id : lanes_) {
      auto const& lane = map_.lane(id);
      if (lane.length() < shortest || (is_valid(lane.opposite) && lane.opposite < lane.id))
        continue;  // one of both directions
      double const s = 0.5 * lane.length();
      auto const widths = lane.widths_at(s);
      if (widths.left + widths.right < 0.8) continue;
      auto pose = lane.path.pose(s);
      if (std::cos(pose.heading) < 0.0) pose.heading += std::numbers::pi;
      double const size = map_.in_junction(lane.id) ? 0.7 : 1.1;
      out_ += "<text transform=\"" + turned(pose) + "\" font-size=\"" +
              svg_number(std::min(size, 0.5 * (widths.left + widths.right)), 2) + "\" dy=\".35em\">" + label_of(lane) +
              "</text>\n";
    }
  }

  /// A bar of a round length, at most 120 px long.
  void draw_scale_bar(double scale, double height) {
    double const length = round_length(120.0 / scale), pixel = 1.0 / scale;
    out_ += "<g class=\"scale\" transform=\"translate(" + svg_number(12 * pixel, 3) + ' ' +
            svg_number(height - 12 * pixel, 3) + ")\">" + svg_box(0, -3 * pixel, length, 3 * pixel, "") + "<text y=\"" +
            svg_number(-6 * pixel, 3) + "\" font-size=\"" + svg_number(12 * pixel, 3) + "\">" + svg_number(length) +
            " m</text></g>\n";
  }

  Map const& map_;
  MapPictureOptions const& options_;
  geometry::Box box_;
  std::vector<LaneId> lanes_;  ///< lanes shown, sorted
  std::string out_;
};

}  // namespace cambium::inline v0_1::detail
