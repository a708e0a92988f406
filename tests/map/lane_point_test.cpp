#include "cambium/map/road/road.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include "cambium/map/opendrive.hpp"
#include "../support/corpus.hpp"
#include "../support/maps.hpp"

namespace {

namespace cb = cambium;
using cb::map::LanePoint;
using cb::map::Road;

constexpr auto none = cb::none<cb::LaneId>;

double angle_between(double a, double b) { return std::abs(cb::geometry::angle_difference(a, b)); }

struct Comparison {
  int rows = 0, unsampled = 0;
  double position = 0.0, border = 0.0, heading = 0.0, width = 0.0, t = 0.0;
  double sampled_border = 0.0;  ///< of lanes with a width
};

double distance(cb::geometry::Line const& line, cb::geometry::Point const& p) {
  if (line.empty()) return INFINITY;
  auto const foot = line.project(p);
  return std::hypot(foot.lateral, std::max({-foot.s, foot.s - line.length(), 0.0}));
}

Comparison compare_with_oracle(std::filesystem::path const& file) {
  Comparison result;
  auto const map = cambium::load_opendrive(file.string()).map;
  for (auto const& row : corpus::table(file.parent_path() / "oracle" / file.stem().concat(".csv"))) {
    auto const number = [&row](std::size_t column) { return std::stod(row[column]); };
    auto const p = lane_point(map->find_road(row[0]), number(1), std::stoi(row[2]));
    CAPTURE(row[0]);
    CAPTURE(row[1]);
    CAPTURE(row[2]);
    REQUIRE(p.has_value());
    auto const off = [&](double t, std::size_t column) {
      auto const at = offset_point(p->reference, {t, 0.0, 0.0});
      return std::hypot(at.x - number(column), at.y - number(column + 1));
    };
    ++result.rows;
    result.position = std::max(result.position, std::hypot(p->center.x - number(5), p->center.y - number(6)));
    result.heading = std::max(result.heading, angle_between(p->center.heading, number(7)));
    result.width = std::max(result.width, std::abs(p->width - number(8)));
    result.t = std::max(result.t, std::abs(p->t - number(9)));
    result.border = std::max({result.border, off(p->inner_t, 10), off(p->outer_t, 12)});
    if (number(8) < 0.05) continue;  // no border to speak of, or a negative width, which counts as 0
    try {
      auto const& lane = map->lane(map->find_lane(row[0], number(1), std::stoi(row[2])));
      for (std::size_t const column : {10, 12}) {
        cb::geometry::Point const border(number(column), number(column + 1));
        auto const away = std::min(distance(lane.left, border), distance(lane.right, border));
        result.sampled_border = std::max(result.sampled_border, away);
      }
    } catch (cb::MapError const&) {
      ++result.unsampled;
    }
  }
  return result;
}

/// The largest differences between what `lane_point` says and numerical derivatives of its positions.
struct Derivatives {
  double heading = 0.0, curvature = 0.0;
};

Derivatives compare_with_differences(Road const& road, double s, int number, double h) {
  auto const at = [&](double station) { return lane_point(road, station, number)->center; };
  auto const before = at(s - h), here = at(s), after = at(s + h);
  double const dx = (after.x - before.x) / (2 * h), dy = (after.y - before.y) / (2 * h);
  double const speed = std::hypot(dx, dy);
  double const turn = std::remainder(after.heading - before.heading, 2 * cb::geometry::pi);
  return {angle_between(std::atan2(dy, dx), here.heading), std::abs(turn / (2 * h * speed) - here.curvature)};
}

}  // namespace

TEST_CASE(
    "lane centres, borders, widths and headings agree with the oracle on every map of the corpus, borders of sampled "
    "lanes to 1 cm") {
  auto const folder = corpus::find("opendrive");
  if (!folder) return;
  int rows = 0;
  for (auto const& map : corpus::maps(*folder)) {
    CAPTURE(map.stem().string());
    auto const c = compare_with_oracle(map);
    rows += c.rows;
    MESSAGE(map.stem().string() << ": " << c.rows << " rows, largest difference: centre " << c.position << " m, border "
                                << c.border << " m, heading " << c.heading << " rad, width " << c.width << " m, t "
                                << c.t << " m, sampled border " << c.sampled_border << " m");
    CHECK(c.position < 1e-6);
    CHECK(c.border < 1e-6);
    CHECK(c.heading < 1e-8);
    CHECK(c.width < 1e-6);
    CHECK(c.t < 1e-6);
    CHECK(c.sampled_border < 0.01);
    CHECK(c.unsampled <= 2);  // in lane sections shorter than a micrometre
  }
  CHECK(rows > 5500);
}

TEST_CASE("a lane's heading and curvature are the derivatives of its centre line") {
  // A clothoid with a lane that swells by a cubic: slope, its change, and the change of curvature all count.
  Road road;
  road.length = 60.0;
  road.reference_line =
      cb::map::ReferenceLine({{0.0, 3.0, -2.0, 0.4, 60.0, cb::map::GeometryKind::spiral, -0.03, 0.05}});
  road.lane_offset = cb::map::CubicProfile({{0.0, 0.5, -0.02, 1e-3, 0.0}});
  road.sections = {{0.0,
                    60.0,
                    {{1, none, none, cb::map::CubicProfile({{0.0, 3.0, 0.05, -2e-3, 3e-5}}), {}, {}},
                     {-1, none, none, cb::map::CubicProfile({{0.0, 2.0, 0.0, 4e-3, -4e-5}}), {}, {}},
                     {-2, none, none, cb::map::CubicProfile({{0.0, 4.0, -0.1, 0.0, 0.0}}), {}, {}}}}};
  for (int const number : {1, -1, -2})
    for (double s = 1.0; s < 59.0; s += 3.7) {
      auto const d = compare_with_differences(road, s, number, 1e-4);
      CAPTURE(number);
      CAPTURE(s);
      CHECK(d.heading < 1e-7);
      CHECK(d.curvature < 1e-7);
    }
}

TEST_CASE("there is no lane 0, none outside of the road, and none that the section does not have") {
  Road road;
  road.length = 10.0;
  road.reference_line = cb::map::ReferenceLine({{0.0, 0.0, 0.0, 0.0, 10.0}});
  cb::map::CubicProfile const three({{0.0, 3.0, 0.0, 0.0, 0.0}}), four({{0.0, 4.0, 0.0, 0.0, 0.0}});
  road.sections = {{2.0, 5.0, {{-1, none, none, three, {}, {}}}}, {5.0, 10.0, {{-1, none, none, four, {}, {}}}}};
  CHECK_FALSE(lane_point(road, 3.0, 0));
  CHECK_FALSE(lane_point(road, 3.0, 1));
  CHECK_FALSE(lane_point(road, 3.0, -2));
  CHECK_FALSE(lane_point(road, 1.0, -1));
  CHECK_FALSE(lane_point(road, -1e-9, -1));
  CHECK_FALSE(lane_point(road, 10.1, -1));
  CHECK_FALSE(lane_point(road, std::nan(""), -1));
  CHECK(lane_point(road, 4.999, -1)->width == 3.0);
  CHECK(lane_point(road, 5.0, -1)->width == 4.0);
  CHECK(lane_point(road, 10.0005, -1)->center.x == 10.0);
}
