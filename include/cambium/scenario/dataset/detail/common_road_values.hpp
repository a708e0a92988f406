#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pugixml.hpp>

#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/opendrive/xml.hpp"
#include "cambium/scenario/dataset/recorded_traffic.hpp"

namespace cambium::inline v0_1::detail {

namespace xml = map::xml;

/// A shape: the rectangle around it, with its own middle and heading.
struct CommonRoadShape {
  geometry::Point center{};
  double heading = 0.0, length = 0.0, width = 0.0;
  std::vector<geometry::Point> outline{};
  bool is_rectangle = false;
};

/// What all parts of a CommonRoad file consist of: numbers, intervals, places, shapes and states. What is odd goes to
/// the diagnostics of `traffic_`.
class CommonRoadValues {
 protected:
  CommonRoadValues(std::string_view text, std::string const& file) : context_(text, file, traffic_.diagnostics) {}

  using Node = pugi::xml_node;
  using Id = std::int64_t;

  struct Interval {
    double begin{}, end{};
    [[nodiscard]] double middle() const { return begin == end ? begin : 0.5 * (begin + end); }
  };

  void warn(Node node, std::string sentence) { context_.report(Severity::warning, node, std::move(sentence)); }
  void note(Node node, std::string sentence) { context_.report(Severity::info, node, std::move(sentence)); }
  /// Says each sentence once, where it holds first.
  void note_once(Node node, std::string const& sentence) {
    if (said_.insert(sentence).second) note(node, sentence);
  }

  [[nodiscard]] static std::string_view text_of(Node node) { return xml::trimmed(node.child_value()); }

  /// The number in a child element; nothing, with a finding, where it is missing or none.
  [[nodiscard]] std::optional<double> number(Node node, char const* name) {
    auto const child = xml::find_child(node, name);
    if (!child) {
      warn(node, std::string("it has no <") + name + ">");
      return std::nullopt;
    }
    auto const value = xml::parse_number<double>(text_of(child));
    if (!value || std::abs(*value) > 1e15) {
      warn(child, "\"" + std::string(text_of(child)) + "\" is no usable number");
      return std::nullopt;
    }
    return value;
  }

  [[nodiscard]] std::optional<geometry::Point> point(Node node) {
    auto const x = number(node, "x"), y = number(node, "y");
    if (!x || !y) return std::nullopt;
    return geometry::Point{*x, *y};
  }

  /// <exact>, or <intervalStart> and <intervalEnd>, of the child of that name; nothing where there is no such child.
  [[nodiscard]] std::optional<Interval> interval(Node node, char const* name) {
    auto const child = xml::find_child(node, name);
    if (!child) return std::nullopt;
    if (xml::find_child(child, "exact")) {
      auto const value = number(child, "exact");
      return value ? std::optional(Interval{*value, *value}) : std::nullopt;
    }
    auto const begin = number(child, "intervalStart"), end = number(child, "intervalEnd");
    if (!begin || !end) return std::nullopt;
    return Interval{*begin, *end};
  }
  /// One value of such an interval.
  [[nodiscard]] std::optional<double> value(Node node, char const* name) {
    auto const found = interval(node, name);
    if (!found) return std::nullopt;
    if (found->begin != found->end)
      note(xml::find_child(node, name), std::string(name) + " is an interval; its middle was taken");
    return found->middle();
  }

  [[nodiscard]] std::string place(Node node) { return context_.file() + ":" + std::to_string(context_.line(node)); }

  [[nodiscard]] std::optional<Id> id_of(Node node) {
    auto const id = context_.number<Id>(node, "id");
    if (!id) warn(node, "it was left out");
    return id;
  }

  [[nodiscard]] std::optional<Id> reference(Node node) { return context_.number<Id>(node, "ref"); }

  /// The first shape of <shape>, <occupancy> or <position>; in the frame of what it belongs to.
  [[nodiscard]] std::optional<CommonRoadShape> shape_of(Node parent) {
    if (!parent) return std::nullopt;
    std::optional<CommonRoadShape> found;
    bool second = false;
    std::string first;
    xml::for_each_child(parent, [&](Node node, std::string_view name) {
      if (name != "rectangle" && name != "circle" && name != "polygon") return;
      if (found) {
        second = true;
        return;
      }
      first = name;
      found = name == "rectangle" ? rectangle(node) : name == "circle" ? circle(node) : polygon(node);
    });
    if (second) note(parent, "it has several shapes; the first one, a " + first + ", was taken");
    return found;
  }

  [[nodiscard]] geometry::Point center(Node node) {
    auto const child = xml::find_child(node, "center");
    return child ? point(child).value_or(geometry::Point{}) : geometry::Point{};
  }

  /// To a nanometre: cosines of right angles are not 0, and sums have rounding errors.
  [[nodiscard]] static geometry::Point rounded(geometry::Point const& p) {
    return {std::round(p.x() * 1e9) / 1e9, std::round(p.y() * 1e9) / 1e9};
  }

  [[nodiscard]] std::optional<CommonRoadShape> rectangle(Node node) {
    auto const length = number(node, "length"), width = number(node, "width");
    if (!length || !width || !(*length > 0.0 && *width > 0.0)) return std::nullopt;
    CommonRoadShape shape{center(node), 0.0, *length, *width, {}, true};
    if (xml::find_child(node, "orientation")) shape.heading = number(node, "orientation").value_or(0.0);
    double const c = portable::cos(shape.heading), s = portable::sin(shape.heading);
    for (auto const& [a, b] : {std::pair{0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}}) {
      double const x = a * *length, y = b * *width;
      shape.outline.push_back(rounded({shape.center.x() + c * x - s * y, shape.center.y() + s * x + c * y}));
    }
    return shape;
  }

  [[nodiscard]] std::optional<CommonRoadShape> circle(Node node) {
    auto const radius = number(node, "radius");
    if (!radius || !(*radius > 0.0)) return std::nullopt;
    CommonRoadShape shape{center(node), 0.0, 2.0 * *radius, 2.0 * *radius, {}, false};
    constexpr int corners = 32;
    for (int k = 0; k < corners; ++k) {
      double const angle = 2.0 * geometry::pi * k / corners;
      shape.outline.push_back(rounded(
          {shape.center.x() + *radius * portable::cos(angle), shape.center.y() + *radius * portable::sin(angle)}));
    }
    return shape;
  }

  [[nodiscard]] std::optional<CommonRoadShape> polygon(Node node) {
    CommonRoadShape shape;
    geometry::Box box;
    bool good = true;
    xml::for_each_child(node, "point", [&](Node child) {
      auto const p = point(child);
      good = good && p;
      if (!p) return;
      shape.outline.push_back(*p);
      box.add(p->x(), p->y());
    });
    if (!good || shape.outline.size() < 3) return std::nullopt;
    shape.center = rounded(box.center());  // what is written about its middle has its middle at (0, 0), then
    auto const size = rounded({box.max_x - box.min_x, box.max_y - box.min_y});
    shape.length = size.x();
    shape.width = size.y();
    return shape;
  }

  /// A position: a point, or the middle of an area.
  [[nodiscard]] std::optional<geometry::Point> position(Node state) {
    auto const node = xml::find_child(state, "position");
    if (auto const child = xml::find_child(node, "point")) return point(child);
    auto const area = shape_of(node);
    if (area) {
      note(node, "the position is an area; its middle was taken");
      return area->center;
    }
    return std::nullopt;
  }

  /// A state; the heading without one is `heading`.
  [[nodiscard]] std::optional<State> state_of(Node node, double heading) {
    auto const at = position(node);
    auto const step = value(node, "time");
    if (!at || !step) return std::nullopt;
    State state;
    state.time = *step * traffic_.time_step;
    state.x = at->x();
    state.y = at->y();
    state.heading = value(node, "orientation").value_or(heading);
    state.speed = value(node, "velocity").value_or(0.0);
    constexpr std::string_view read[] = {"position", "time", "orientation", "velocity"};
    xml::for_each_child(node, [&](Node child, std::string_view name) {
      if (std::find(std::begin(read), std::end(read), name) == std::end(read))
        note_once(child, "elements <" + std::string(name) + "> of states are not read");
    });
    return state;
  }

  RecordedTraffic traffic_;
  xml::XmlContext context_;

 private:
  std::set<std::string> said_;
};

}  // namespace cambium::inline v0_1::detail
