#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/text.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/building/center_line_csv.hpp"
#include "cambium/map/building/detail/polyline_profiles.hpp"
#include "cambium/map/building/polyline_roads.hpp"
#include "cambium/map/detail/read_map_file.hpp"
#include "cambium/map/road/lane_type.hpp"

namespace cambium::inline v0_1::map {

namespace detail {

using cambium::detail::parse_number;

/// Reads a centre line's table, see `read_center_line_csv`.
class CenterLineReader {
 public:
  CenterLineReader(std::string_view text, std::string const& name, geometry::Point const& origin)
      : text_(text), name_(name), origin_(origin) {}

  [[nodiscard]] CenterLine read() {
    if (text_.substr(0, 3) == "\xEF\xBB\xBF") text_.remove_prefix(3);
    for (bool first = true; !text_.empty();) {
      auto const end = std::min(text_.find('\n'), text_.size());
      auto const line = cambium::detail::trimmed(text_.substr(0, end), blank);
      text_.remove_prefix(std::min(end + 1, text_.size()));
      ++line_;
      if (line.empty() || line.front() == '#') continue;
      auto const cells = split(line);
      if (!(std::exchange(first, false) && read_heading(cells))) add_row(cells);
    }
    if (result_.points.size() < 2)
      throw MapError(name_, "it has fewer than two different points", "give a table with the columns x and y");
    return std::move(result_);
  }

 private:
  enum Column { x, y, heading, left_x, left_y, right_x, right_y, columns };
  using Row = std::array<double, columns>;
  static constexpr std::string_view blank = " \t\r\"";  // cells may stand in quotes

  [[noreturn]] void fail(std::string const& what, std::string const& remedy) const {
    throw MapError(name_ + ":" + std::to_string(line_), what, remedy);
  }

  /// The cells of a row. The first one says which separator the table has, and how many cells at most.
  [[nodiscard]] std::vector<std::string_view> split(std::string_view line) {
    if (cells_ == 0 && line.find(';') != line.npos) separator_ = ";";
    auto cells = cambium::detail::split(line, separator_);
    for (auto& cell : cells) cell = cambium::detail::trimmed(cell, blank);
    if (cells_ == 0) cells_ = cells.size();
    if (cells.size() > cells_)
      fail("it has " + std::to_string(cells.size()) + " cells, the first row " + std::to_string(cells_),
           "give each row the same columns, and numbers a decimal point");
    return cells;
  }

  /// Takes the first row as the columns' names; false where it is one of numbers, whose columns are x, y, heading.
  bool read_heading(std::vector<std::string_view> const& cells) {
    if (parse_number<double>(cells.front())) {
      for (std::size_t i = 0; i < std::min<std::size_t>(cells.size(), 3); ++i) column_[i] = i;
      return false;
    }
    constexpr std::array<std::array<std::string_view, 3>, columns> names{{{"x", "x_center", "center_x"},
                                                                          {"y", "y_center", "center_y"},
                                                                          {"heading", "theta", "yaw"},
                                                                          {"x_leftbound", "left_x", "x_left"},
                                                                          {"y_leftbound", "left_y", "y_left"},
                                                                          {"x_rightbound", "right_x", "x_right"},
                                                                          {"y_rightbound", "right_y", "y_right"}}};
    for (std::size_t column = 0; column < columns; ++column)
      for (std::size_t i = 0; i < cells.size(); ++i)
        if (std::count(names[column].begin(), names[column].end(), cells[i]) > 0) column_[column] = i;
    if (!column_[x] || !column_[y])
      fail("there are no columns x and y", "name the columns x and y, or x_center and y_center, in the first row");
    return true;
  }

  [[nodiscard]] bool has_borders() const {
    return column_[left_x] && column_[left_y] && column_[right_x] && column_[right_y];
  }

  void add_row(std::vector<std::string_view> const& cells) {
    if (!column_[y]) fail("there is only one number", "give x and y, separated by a comma");
    Row row{};
    for (std::size_t i = 0; i < columns; ++i) {
      if (!column_[i]) continue;
      auto const value = *column_[i] < cells.size() ? parse_number<double>(cells[*column_[i]]) : std::nullopt;
      if (!value)
        fail("cell " + std::to_string(*column_[i] + 1) +
                 (*column_[i] < cells.size()
                      ? " is no finite number: \"" + std::string(cells[*column_[i]].substr(0, 40)) + "\""
                      : " is missing"),
             "give a number with a decimal point");
      row[i] = *value;
    }
    geometry::Point const point = geometry::Point(row[x], row[y]) - origin_;
    if (!(std::abs(point.x()) <= 1e8 && std::abs(point.y()) <= 1e8))
      fail("the point lies beyond 100 000 km", "give coordinates in m");
    if (!result_.points.empty() && (point - result_.points.back()).norm() <= 1e-3) return;  // a joint written twice
    if (result_.points.size() > 1) {
      auto const &last = result_.points.back(), &before = result_.points[result_.points.size() - 2];
      double const from = portable::atan2(last.y() - before.y(), last.x() - before.x());
      double const to = portable::atan2(point.y() - last.y(), point.x() - last.x());
      if (std::abs(geometry::angle_difference(to, from)) > 0.75 * geometry::pi)
        fail("the line turns back on itself here", "give the points in the order in which they are passed");
    }
    if (column_[heading] && !result_.points.empty())
      for (double const theta : {result_.headings.back(), row[heading]})
        check_heading(theta, point - result_.points.back());
    result_.points.push_back(point);
    if (column_[heading]) result_.headings.push_back(row[heading]);
    if (has_borders())
      result_.widths.push_back({portable::hypot(row[left_x] - row[x], row[left_y] - row[y]),
                                portable::hypot(row[right_x] - row[x], row[right_y] - row[y])});
  }

  void check_heading(double theta, geometry::Point const& way) const {
    double const off = geometry::angle_difference(theta, portable::atan2(way.y(), way.x()));
    // Later ones may count laps; a first one beyond a turn is in degrees.
    if (std::abs(off) > 0.5 * geometry::pi || std::abs(result_.headings.front()) > 2.0 * geometry::pi)
      fail("the heading " + cambium::detail::rounded_text(theta) +
               " does not fit the direction from the previous point to this one",
           "give headings in radians, in travel direction, or leave the column out");
  }

  std::string_view text_;
  std::string_view separator_ = ",";
  std::size_t cells_ = 0;  ///< of the first row
  std::string const& name_;
  geometry::Point origin_;
  int line_ = 0;
  std::array<std::optional<std::size_t>, columns> column_{};
  CenterLine result_;
};

}  // namespace detail

CAMBIUM_COLD CenterLine read_center_line_csv(std::string_view text, std::string const& name,
                                             geometry::Point const& origin) {
  return detail::CenterLineReader(text, name, origin).read();
}

CAMBIUM_COLD CenterLine load_center_line_csv(std::string const& path, geometry::Point const& origin) {
  auto const text = detail::read_map_file(path, "give a table with the columns x and y");
  return read_center_line_csv(text, path, origin);
}

CAMBIUM_COLD RoadPlan lane_along(CenterLine const& line, double lane_width, std::string const& id) {
  std::vector<SideWidths> own, rest;
  for (auto const& w : line.widths) {
    double const half = std::min(w.left, w.right);
    own.push_back({half, half});
    rest.push_back({w.left - half, w.right - half});
  }
  if (own.empty()) own.push_back({0.5 * lane_width, 0.5 * lane_width});
  constexpr double slight = 2e-3;  // [m]
  auto const is_slight = [](SideWidths const& w) { return std::max(w.left, w.right) <= slight; };
  if (std::all_of(rest.begin(), rest.end(), is_slight))
    return lane_along(line.points, line.widths.empty() ? own : line.widths, line.headings, id);
  auto plan = lane_along(line.points, own, line.headings, id);
  auto const stations = detail::stations_of(plan.line);
  auto const add = [&](double SideWidths::*side, std::vector<LanePlan>& lanes) {
    std::vector<double> widths;
    for (auto const& w : rest) widths.push_back(w.*side);
    if (*std::max_element(widths.begin(), widths.end()) > slight)
      lanes.push_back({.type = LaneType::shoulder, .widths = detail::monotone_profile(stations, widths)});
  };
  add(&SideWidths::left, plan.sections.front().left);
  add(&SideWidths::right, plan.sections.front().right);
  return plan;
}

}  // namespace cambium::inline v0_1::map
