#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/core/markup.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/viewer/detail/lane_marks.hpp"
#include "cambium/viewer/detail/svg_panel.hpp"
#include "cambium/viewer/recording.hpp"
#include "cambium/viewer/svg_picture.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// Draws a recording as SVG. The map is written once, in metres; each panel shows it through a transform of its own.
class SvgPicture {
 public:
  SvgPicture(Recording const& recording, SvgOptions const& options) : recording_(recording), options_(options) {
    for (RecordedLane const& lane : recording.lanes) areas_.emplace_back(lane);
    measure();
  }

  [[nodiscard]] std::string text() {
    std::vector<SvgPanel> const panels = lay_out();
    SvgPanel const& last = panels.back();
    std::string const size = svg_number(options_.width) + "\" height=\"" + svg_number(last.top + last.height + margin_);
    out_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + size + "\" viewBox=\"0 0 " +
           svg_number(options_.width) + ' ' + svg_number(last.top + last.height + margin_) +
           "\" font-family=\"system-ui, 'DejaVu Sans', sans-serif\">\n";
    out_ += "<title>" + escape_markup(recording_.title) + "</title>\n";
    define_map();
    out_ += "<rect width=\"100%\" height=\"100%\" rx=\"10\" fill=\"#f4f6f8\"/>\n";
    if (options_.labels)
      out_ += "<text x=\"" + svg_number(margin_) +
              "\" y=\"24\" font-size=\"16\" font-weight=\"600\" fill=\"#16202b\">" + escape_markup(recording_.title) +
              "</text>\n";
    for (std::size_t i = 0; i < panels.size(); ++i) show(panels[i], i);
    if (panels.size() > 1) outline_close_up(panels[0], panels[1]);
    return out_ + "</svg>\n";
  }

 private:
  static constexpr double margin_ = 12.0;   // [px]
  static constexpr double readable_ = 3.0;  // scale below which a close-up is added [px/m]
  static constexpr double close_up_ = 7.0;  // scale of the close-up in a picture 1200 px wide [px/m]

  // Coordinates are relative to the middle of the map's bounding box, which keeps the numbers short.
  [[nodiscard]] std::string place(geometry::Point const& p) const {
    return svg_number(p.x() - middle_.x()) + ',' + svg_number(p.y() - middle_.y());
  }

  [[nodiscard]] std::string path(PointList const& points) const {
    std::string text;
    for (geometry::Point const& p : points) text += (text.empty() ? 'M' : 'L') + place(p);
    return text;
  }

  void measure() {
    double const inf = std::numeric_limits<double>::infinity();
    geometry::Point low(inf, inf), high(-inf, -inf);
    for (LaneArea const& area : areas_)
      if (!area.empty()) low = low.cwiseMin(area.low), high = high.cwiseMax(area.high);
    if (areas_.empty() || !low.allFinite())
      for (RecordedPose const& pose : poses())
        if (is_shown(pose)) {
          geometry::Point const at(pose.x, pose.y), room(20.0, 20.0);
          low = low.cwiseMin(at - room), high = high.cwiseMax(at + room);
        }
    if (!low.allFinite()) low = geometry::Point(-50.0, -20.0), high = geometry::Point(50.0, 20.0);
    middle_ = 0.5 * (low + high);
    extent_ = (high - low).cwiseMax(geometry::Point(10.0, 10.0));
  }

  [[nodiscard]] std::vector<RecordedPose> const& poses() const {
    static std::vector<RecordedPose> const nobody;
    return options_.frame ? recording_.frames[*options_.frame].poses : nobody;
  }

  static bool is_shown(RecordedPose const& pose) {
    return pose.present && std::isfinite(pose.x + pose.y + pose.heading);
  }

  [[nodiscard]] std::vector<SvgPanel> lay_out() const {
    double const width = options_.width - 2 * margin_, top = options_.labels ? 36.0 : margin_, rim = 10.0;
    double const scale = std::min((width - 2 * rim) / extent_.x(), 0.7 * width / extent_.y());
    double const height = std::max(scale * extent_.y() + 2 * rim, options_.labels ? 70.0 : 40.0);
    std::vector<SvgPanel> panels{{margin_, top, width, height, scale, middle_, 0.0}};
    if (scale >= readable_) return panels;
    SvgPanel close{
        margin_, top + height + margin_, width, std::round(0.24 * width), close_up_ * options_.width / 1200.0, middle_,
        0.0};
    aim(close);
    panels.push_back(close);
    return panels;
  }

  /// Centres the close-up on the ego, a junction or a short lane, and turns it along the nearest driving lane.
  void aim(SvgPanel& close) const {
    if (!aim_at_vehicle(close)) aim_at_lane(close);
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < areas_.size(); ++i) {
      if (areas_[i].empty() || recording_.lanes[i].kind != RecordedLaneKind::driving) continue;
      for (int k = 1; k < 100; ++k) {
        double const distance = (areas_[i].middle(0.01 * k) - close.middle).norm();
        if (!(distance < best)) continue;
        best = distance;
        geometry::Point const along = areas_[i].middle(0.01 * k + 0.01) - areas_[i].middle(0.01 * k - 0.01);
        close.heading = std::remainder(std::atan2(along.y(), along.x()), std::numbers::pi);
      }
    }
  }

  [[nodiscard]] bool aim_at_vehicle(SvgPanel& close) const {
    RecordedPose const* chosen = nullptr;
    for (std::size_t i = 0; i < poses().size(); ++i) {
      if (!is_shown(poses()[i])) continue;
      bool const ego = recording_.agents[i].kind == RecordedAgentKind::ego;
      if (chosen == nullptr || ego) chosen = &poses()[i];
      if (ego) break;
    }
    if (chosen == nullptr) return false;
    close.middle = geometry::Point(chosen->x, chosen->y);
    return true;
  }

  void aim_at_lane(SvgPanel& close) const {
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < areas_.size(); ++i) {
      RecordedLaneKind const kind = recording_.lanes[i].kind;
      if (areas_[i].empty() || kind == RecordedLaneKind::other || kind == RecordedLaneKind::way) continue;
      double const length = (areas_[i].high - areas_[i].low).norm() - (kind == RecordedLaneKind::junction ? 1e9 : 0.0);
      if (length >= shortest - 1.0) continue;
      shortest = length;
      close.middle = areas_[i].middle(kind == RecordedLaneKind::junction ? 1.0 : 0.5);
    }
  }

  void define_map() {
    out_ += "<defs>\n<g id=\"lanes\" stroke-linejoin=\"round\">\n";
    using Kind = RecordedLaneKind;
    for (Kind kind : {Kind::way, Kind::other, Kind::driving, Kind::junction}) {
      std::string const colour = kind == Kind::other || kind == Kind::way ? "#8d949c" : "#6d747d";
      for (std::size_t i = 0; i < areas_.size(); ++i)
        if (recording_.lanes[i].kind == kind && !areas_[i].empty())
          out_ += "<path fill=\"" + colour + "\" stroke=\"" + colour + "\" d=\"" + path(areas_[i].outline) + "Z\"/>\n";
    }
    out_ += "</g>\n<g id=\"marks\" fill=\"none\">\n";
    for (LaneMark const& mark : LaneMarker(recording_.lanes, areas_).marks())
      out_ += std::string("<path stroke=\"") + (mark.style == MarkStyle::centre ? "#ffd54a" : "#fff") +
              (mark.style == MarkStyle::divider ? "\" stroke-dasharray=\"3 6" : "") + "\" d=\"" + path(mark.points) +
              "\"/>\n";
    out_ += "</g>\n<g id=\"arrows\" fill=\"#fff\" opacity=\".7\">\n";
    for (LaneArrow const& arrow : lane_arrows(recording_.lanes, areas_, 40.0))
      out_ += "<path transform=\"" + turned(arrow.at, arrow.heading) + "\" d=\"M-2 .1H.6V.5L2.2 0 .6-.5V-.1H-2Z\"/>\n";
    out_ += "</g>\n<g id=\"vehicles\" stroke=\"#1b2430\">\n";
    for (std::size_t i = 0; i < poses().size(); ++i)
      if (is_shown(poses()[i])) define_vehicle(recording_.agents[i], poses()[i]);
    out_ += "</g>\n</defs>\n";
  }

  [[nodiscard]] std::string turned(geometry::Point const& at, double heading) const {
    return "translate(" + place(at) + ")rotate(" + svg_number(heading * 180.0 / std::numbers::pi, 1) + ")";
  }

  void define_vehicle(RecordedAgent const& agent, RecordedPose const& pose) {
    static constexpr char const* colours[] = {"#eef1f4", "#1e90ff", "#ffab1f", "#b79bff", "#e0218a"};
    auto const kind = std::min<std::size_t>(static_cast<std::size_t>(agent.kind), 4);
    double const length = agent.shape.front + agent.shape.rear, width = agent.shape.left + agent.shape.right;
    double const rear = -agent.shape.rear, right = -agent.shape.right;
    out_ += "<g transform=\"" + turned({pose.x, pose.y}, pose.heading) + "\">";
    bool const walks = std::max(length, width) < 1.2;  // a pedestrian: round, without a windscreen
    double const round = walks ? 0.5 * width : std::min(0.28 * width, 0.12 * length);
    out_ += svg_box(rear, right, length, width,
                    "rx=\"" + svg_number(kind == 3 ? 0.0 : round) + "\" fill=\"" + colours[kind] + '"');
    if (kind != 3 && !walks) {
      double const screen = length > 7.0 ? 1.2 : 0.39 * length;
      out_ += svg_box(agent.shape.front - screen, right + 0.1 * width, std::min(0.7, 0.15 * length), 0.8 * width,
                      "fill=\"#33404e\" stroke=\"none\"");
      if (pose.acceleration < -2.0) out_ += svg_box(rear - 0.2, right, 0.35, width, "fill=\"#f22\" stroke=\"none\"");
    }
    out_ += "</g>\n";
  }

  void show(SvgPanel const& panel, std::size_t index) {
    std::string const clip = "panel" + std::to_string(index), scale = svg_number(panel.scale, 4);
    std::string const frame = svg_box(panel.left, panel.top, panel.width, panel.height, "rx=\"6\"");
    geometry::Point const origin = panel.on_picture(middle_);
    out_ += "<clipPath id=\"" + clip + "\">" + frame + "</clipPath>\n";
    out_ += "<g clip-path=\"url(#" + clip + ")\">" +
            svg_box(panel.left, panel.top, panel.width, panel.height, "fill=\"#e6ebe4\"");
    out_ += "<g transform=\"translate(" + svg_number(origin.x()) + ',' + svg_number(origin.y()) + ")scale(" + scale +
            ",-" + scale + ")rotate(" + svg_number(-panel.heading * 180.0 / std::numbers::pi, 3) + ")\">";
    bool const far = panel.scale < readable_;
    auto const use = [this](char const* what, double stroke) {
      out_ += std::string("<use href=\"#") + what + "\" stroke-width=\"" + svg_number(stroke, 3) + "\"/>";
    };
    use("lanes", std::max(0.06, 0.8 / panel.scale));
    if (!far) use("arrows", 0.0);
    use("marks", far ? 0.35 / panel.scale : std::max(0.16, 1.0 / panel.scale));
    use("vehicles", (far ? 0.4 : 1.0) / panel.scale);
    out_ += "</g>";
    if (options_.labels && !far) lane_labels(panel);
    out_ += "</g>\n";
    if (options_.labels) out_ += svg_scale_bar(panel);
  }

  /// Writes each label on its lane, as far left in the panel as the lane reaches.
  void lane_labels(SvgPanel const& panel) {
    for (std::size_t i = 0; i < areas_.size(); ++i) {
      if (areas_[i].empty() || recording_.lanes[i].label.empty()) continue;
      std::optional<geometry::Point> best;
      for (int k = 1; k < 200; ++k) {
        geometry::Point const p = panel.on_picture(areas_[i].middle(0.005 * k));
        if (panel.has_room(p) && (!best || p.x() < best->x())) best = p;
      }
      if (!best) continue;
      out_ += "<text x=\"" + svg_number(best->x(), 1) + "\" y=\"" + svg_number(best->y() + 4.0, 1) +
              "\" font-size=\"11\" text-anchor=\"middle\" fill=\"#fff\" stroke=\"#4a5058\" stroke-width=\"2.5\" "
              "paint-order=\"stroke\">" +
              escape_markup(recording_.lanes[i].label) + "</text>";
    }
  }

  void outline_close_up(SvgPanel const& overview, SvgPanel const& close) {
    double const u = close.width / close.scale / 2, v = close.height / close.scale / 2;
    double const c = std::cos(close.heading), s = std::sin(close.heading);
    std::string corners;
    for (auto const& [x, y] : {std::pair(-u, -v), std::pair(u, -v), std::pair(u, v), std::pair(-u, v)}) {
      geometry::Point const p = overview.on_picture(close.middle + geometry::Point(c * x - s * y, s * x + c * y));
      corners += svg_number(p.x(), 1) + ',' + svg_number(p.y(), 1) + ' ';
    }
    out_ += "<polygon points=\"" + corners +
            "\" fill=\"#1273eb\" fill-opacity=\".08\" stroke=\"#1273eb\" stroke-width=\"1.5\"/>\n";
  }

  Recording const& recording_;
  SvgOptions const& options_;
  std::vector<LaneArea> areas_;
  geometry::Point middle_{0.0, 0.0};
  geometry::Point extent_{10.0, 10.0};
  std::string out_;
};

}  // namespace detail

CAMBIUM_COLD std::string svg_picture(Recording const& recording, SvgOptions const& options) {
  check_recording(recording);
  if (!(options.width >= 100.0) || !std::isfinite(options.width))
    throw Error("SvgOptions::width", "it is not a finite number of at least 100", "give the picture's width in pixels");
  if (options.frame && *options.frame >= recording.frames.size())
    throw Error(
        "SvgOptions::frame",
        "there is no frame " + std::to_string(*options.frame) + " in " + std::to_string(recording.frames.size()),
        "frames count from 0");
  return detail::SvgPicture(recording, options).text();
}

CAMBIUM_COLD void write_svg_picture(std::filesystem::path const& path, Recording const& recording,
                                    SvgOptions const& options) {
  write_file(path, svg_picture(recording, options));
}

}  // namespace cambium::inline v0_1
