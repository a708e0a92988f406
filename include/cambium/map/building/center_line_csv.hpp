#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cambium/geometry/pose.hpp"
#include "cambium/map/building/road_plan.hpp"
#include "cambium/map/lanes/lane.hpp"

namespace cambium::inline v0_1::map {

/// The centre line of a lane from a table, and what else the table says about each of its points.
struct CenterLine {
  std::vector<geometry::Point> points;  ///< [m]
  std::vector<double> headings;         ///< [rad]; empty where the table has none
  std::vector<SideWidths> widths;       ///< distances to the borders [m]; empty where the table has none
};

/// The centre line in a table of comma- (or, where the first row has one, semicolon-) separated values, a point a row
/// in travel direction; `name` names the text in messages, `origin` is subtracted from all coordinates [m]. The first
/// row names the columns: x and y, or x_center and y_center; optional are theta (or heading, yaw) [rad], and all four
/// of x_leftbound, y_leftbound, x_rightbound, y_rightbound: the tables of lanes that BARK reads. Other columns are
/// passed over. A first row of numbers means the columns x, y and, where there is a third, theta. Empty rows and those
/// that begin with # are passed over, and so are points within a millimetre of the one before. Throws `MapError` with
/// the line where a cell is missing, one too many or no finite number, or theta points away from the way that the
/// points go, and where there are fewer than two points. Linear in the length of the text.
[[nodiscard]] CenterLine read_center_line_csv(std::string_view text, std::string const& name = "text",
                                              geometry::Point const& origin = {});

/// As `read_center_line_csv`, from a file. Throws `MapError` where it cannot be read, too.
[[nodiscard]] CenterLine load_center_line_csv(std::string const& path, geometry::Point const& origin = {});

/// A road with one lane to drive on, -1, whose path is the line, to 1 mm: as wide as its table says, else `lane_width`
/// [m]. Where the distances to the left and the right border differ, by more than 2 mm anywhere, the lane takes the
/// smaller one on both sides (a lane's path is the middle of its borders), and the rest becomes a lane of the type
/// shoulder, 1 or -2: so the outermost borders are the table's at its points, but nobody plans to drive on the rest.
/// To get the whole width as one lane, with its middle as the path, pass `line.points` and `line.widths` to the other
/// `lane_along`. `id`: the road's. Throws `MapError` as that.
[[nodiscard]] RoadPlan lane_along(CenterLine const& line, double lane_width = 3.5, std::string const& id = {});

}  // namespace cambium::inline v0_1::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/building/center_line_csv_impl.hpp"
#endif
