// Lanes from points: through the builder to the map, and from tables.
#include "cambium/map/building/polyline_roads.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/map/building/center_line_csv.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "lanes_by_hand.hpp"
#include "../support/error_of.hpp"

using namespace by_hand;

namespace {

/// Points on a winding line, and beside it at a distance to the left.
Point winding(double u, double beside = 0.0) {
  double const slope = 0.9 * std::cos(0.03 * u), norm = std::hypot(1.0, slope);
  return {u - beside * slope / norm, 30.0 * std::sin(0.03 * u) + beside / norm};
}

template <class At>
std::vector<Point> points_of(At const& at, double step = 4.0) {
  std::vector<Point> points;
  for (double u = 0.0; u <= 200.0; u += step) points.push_back(at(u));
  return points;
}

}  // namespace

TEST_CASE("a lane along points passes through them, with borders at the distances given and no kinks") {
  auto const center = points_of([](double u) { return winding(u); });
  std::vector<SideWidths> widths;
  for (std::size_t i = 0; i < center.size(); ++i) {
    double const w = 1.75 + 0.5 * std::sin(0.2 * static_cast<double>(i));
    widths.push_back({w, w});
  }
  MapBuilder builder;
  builder.add_road(lane_along(center, widths));
  std::vector<Diagnostic> diagnostics;
  auto const map = builder.build({}, &diagnostics);
  CHECK(diagnostics.empty());
  REQUIRE(map->lanes().size() == 1);
  auto const& lane = map->lanes()[0];
  for (std::size_t i = 0; i < center.size(); ++i) {
    CHECK(distance(lane.path, center[i]) < 0.01);
    CHECK(distance(lane.left, winding(4.0 * static_cast<double>(i), widths[i].left)) < 0.03);
    CHECK(distance(lane.right, winding(4.0 * static_cast<double>(i), -widths[i].right)) < 0.03);
  }
  for (auto const& segment : lane.path.segments()) CHECK(std::abs(segment.curvature * segment.length) < 0.053);
}

TEST_CASE("lanes between polylines have these as their borders, and are neighbours") {
  std::vector<std::vector<Point>> borders;
  for (double const beside : {1.75, -1.75, -5.25, -9.0})
    borders.push_back(points_of([beside](double u) { return winding(u, beside); }, 1.5 - 0.05 * beside));
  MapBuilder builder;
  builder.add_road(lanes_between(borders));
  std::vector<Diagnostic> diagnostics;
  auto const map = builder.build({}, &diagnostics);
  CHECK(diagnostics.empty());
  REQUIRE(map->lanes().size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    auto const& lane = map->lanes()[i];
    for (double u = 10.0; u < 190.0; u += 1.7) {
      CHECK(distance(lane.left, winding(u, i == 0 ? 1.75 : i == 1 ? -1.75 : -5.25)) < 0.02);
      CHECK(distance(lane.right, winding(u, i == 0 ? -1.75 : i == 1 ? -5.25 : -9.0)) < 0.02);
    }
  }
  CHECK(map->lanes()[0].right_neighbor == map->lanes()[1].id);
  CHECK(map->lanes()[2].left_neighbor == map->lanes()[1].id);
}

TEST_CASE("a lane between rings that nearly close keeps its width, wherever its borders end") {
  auto const ring = [](double radius, double from, double to) {
    std::vector<Point> points;
    for (double degrees = from; degrees <= to; degrees += 1.0) {
      double const angle = -degrees * geometry::pi / 180.0;  // clockwise
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return points;
  };
  for (double const late : {0.0, 3.0}) {
    auto const plan = lanes_between(std::vector{ring(23.5, 0, 350), ring(20, late, 350 - late)});
    double least = 100.0, most = 0.0;
    for (auto const& record : plan.sections.front().right.front().widths) {
      least = std::min(least, record.a);
      most = std::max(most, record.a);
    }
    CHECK(least > (late > 0.0 ? 3.45 : 3.49));
    CHECK(most < 3.51);
  }
}

TEST_CASE("polylines that make no lane are refused") {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Point> const line{{0, 0}, {10, 0}, {20, 1}};
  using Widths = std::vector<SideWidths>;
  for (auto const& widths :
       {Widths{}, Widths{{1, 1}, {1, 1}}, Widths{{-1, 1}}, Widths{{1, nan}}, Widths{{1, 1}, {1, 1}, {1, -0.1}}})
    CHECK_THROWS_AS((void)lane_along(line, widths), MapError);
  CHECK_THROWS_AS((void)lane_along(std::vector<Point>{{0, 0}}, Widths{{1, 1}}), MapError);
  CHECK_THROWS_AS((void)lane_along(std::vector<Point>{{0, 0}, {0, 0}}, Widths{{1, 1}}), MapError);
  using Borders = std::vector<std::vector<Point>>;
  for (auto const& borders : {Borders{}, Borders{line}, Borders{line, {}}, Borders{line, {{0, 3}, {20, 4}}},
                              Borders{line, {{0, -3}, {nan, 4}}}, Borders{line, {{0, -300}, {20, -300}}}})
    CHECK_THROWS_AS((void)lanes_between(borders), MapError);
}

TEST_CASE("errors of polylines name the road and the point, and tell NaN from points too close") {
  double const nan = std::numeric_limits<double>::quiet_NaN(), far = 1e9;
  std::vector<SideWidths> const widths{{1, 1}};
  auto const along = [&](std::vector<Point> const& points, std::string const& id = {}) {
    return support::error_of([&] { (void)lane_along(points, widths, {}, id); });
  };
  CHECK(along({{0, 0}, {10, 0}, {nan, 5}}, "12") ==
        "road 12: point 2 (of 0 to 2) is not a finite number: nan, 5; give finite coordinates [m]");
  CHECK(along({{0, 0}, {10, 0}, {10, 0.0004}, {20, 0}}, "12") ==
        "road 12: point 2 (of 0 to 3) is less than a millimetre from the previous one: 0.0004 m; leave one of the two "
        "out");
  CHECK(along({{0, 0}, {10, 0}, {10, 0}}) ==
        "polyline: point 2 (of 0 to 2) is less than a millimetre from the previous one: 0 m; leave one of the two out");
  CHECK(along({{0, far}, {10, far}}) ==
        "polyline: point 0 (of 0 to 1) is beyond 100 000 km: 0, 1e+09; give "
        "coordinates in metres");
  CHECK(along({{0, 0}, {2e6, 0}}) ==
        "polyline: point 1 (of 0 to 1) is 2e+06 m from the previous one; give points within 1000 km");
  CHECK(along({{0, 0}}, "a") == "road a: it has one point; give at least two");
  std::vector<Point> const line{{0, 0}, {10, 0}, {20, 1}};
  CHECK(support::error_of([&] {
          (void)lane_along(line, widths, std::vector<double>{0, nan, 0}, "7");
        }) == "road 7: point 1 (of 0 to 2) has a heading of nan; give radians, up to 10 000");
  std::vector<SideWidths> const negative{{1, 1}, {1, -1}, {1, 1}};
  CHECK(support::error_of([&] { (void)lane_along(line, negative, {}, "7"); }) ==
        "road 7: the widths at point 1 are 1 and -1 m, not numbers from 0, up to 1 km wide; give the distances to the "
        "borders in m");
  using Borders = std::vector<std::vector<Point>>;
  auto const between = [&](Borders const& borders) {
    return support::error_of([&] { (void)lanes_between(borders, "12"); });
  };
  CHECK(between({line, {{0, -3}, {20, nan}}}) ==
        "road 12, border 1: point 1 (of 0 to 1) is not a finite number: 20, nan; give finite coordinates [m]");
  CHECK(between({line, {{0, 3}, {20, 4}}}) ==
        "road 12, border 1: it does not pass within 100 m to the right of border 0 at 0 m; give borders from left to "
        "right, in travel direction");
  CHECK(between({line}) == "road 12: there are fewer than two borders; give at least two");
  CHECK(lane_along(line, widths, {}, "12").id == "12");
  CHECK(lanes_between(Borders{line, {{0, -3}, {20, -3}}}, "12").id == "12");
}

TEST_CASE("a centre line is read from a table of x and y") {
  for (auto const* text : {"x,y\n0,0\n10,0\n20,1\n", "# a lane\r\nx;y\r\n0;0\r\n\r\n10;+0.0\r\n 20 ; 1e0 \r\n",
                           "0,0\n10,0\n20,1", "\xEF\xBB\xBFid,\"y\",\"x\"\n7,0,0\n7,0,10\n7,0,10\nq,1,20\n"}) {
    CAPTURE(text);
    auto const line = read_center_line_csv(text);
    REQUIRE(line.points.size() == 3);
    CHECK(line.points[1] == Point(10, 0));
    CHECK(line.points[2] == Point(20, 1));
    CHECK(line.headings.empty());
    CHECK(line.widths.empty());
  }
  auto const line = read_center_line_csv("x,y,theta\n5,5,0.1\n6,5,0.2\n", "text", {5, 5});
  CHECK(line.points[0] == Point(0, 0));
  CHECK(line.headings == std::vector<double>{0.1, 0.2});
}

TEST_CASE("a table as BARK's, with the borders, becomes a map of one lane and a shoulder") {
  std::string text = "lane_id,x_center,y_center,x_rightbound,y_rightbound,x_leftbound,y_leftbound\n";
  auto const cells = [](Point const& p) { return "," + std::to_string(p.x() + 6.9e5) + "," + std::to_string(p.y()); };
  for (double u = 0.0; u <= 200.0; u += 1.0)
    text +=
        std::to_string(u < 100 ? 1 : 2) + cells(winding(u)) + cells(winding(u, -2.8)) + cells(winding(u, 1.9)) + "\n";
  auto const line = read_center_line_csv(text, "lanes.csv", {6.9e5, 0});
  REQUIRE(line.widths.size() == 201);
  MapBuilder builder;
  builder.add_road(lane_along(line));
  auto const map = builder.build();
  auto const& lane = map->lanes()[0];
  REQUIRE(map->lanes().size() == 2);
  auto const& shoulder = map->lanes()[1];
  CHECK(lane.drivable());
  CHECK(shoulder.type == LaneType::shoulder);
  for (double u = 0.0; u <= 200.0; u += 3.3) {
    CHECK(distance(lane.path, winding(u)) < 0.02);
    CHECK(distance(lane.left, winding(u, 1.9)) < 0.02);
    CHECK(distance(lane.right, winding(u, -1.9)) < 0.02);
    CHECK(distance(shoulder.right, winding(u, -2.8)) < 0.02);
  }
}

TEST_CASE("a table that is none is refused, with the line") {
  CHECK(support::error_of([] { (void)read_center_line_csv("x,y\n0,0\n10,0\n5,0\n20,0\n", "a.csv"); }) ==
        "a.csv:4: the line turns back on itself here; give the points in the order in which they are passed");
  CHECK(support::error_of([] { (void)read_center_line_csv("x,y\n0,0\n1,abc\n", "a.csv"); }) ==
        "a.csv:3: cell 2 is no finite number: \"abc\"; give a number with a decimal point");
  CHECK(support::error_of([] {
          (void)read_center_line_csv("x,y\n0,0\n\n1\n", "a.csv");
        }).starts_with("a.csv:4: cell 2 is missing"));
  CHECK(support::error_of([] {
          (void)read_center_line_csv("a,b\n0,0\n1,1", "a.csv");
        }).starts_with("a.csv:1: there are no columns"));
  for (auto const* text :
       {"", "\n\n", "x,y", "x,y\n1,1\n1,1\n", "1\n2\n", "0,0\nnan,1\n", "0,0\ninf,1\n", "0,0\n1e9,1\n",
        "0,0\n1e999,1\n", "0,0\n1,1x\n", ",,,\n", "x,y\n,\n", "x,y\n\"\",\"\"\n", "x,y,theta\n0,0,0\n1,1\n"})
    CHECK_MESSAGE(support::error_of([&] { (void)read_center_line_csv(text); }) != "no error", text);
  CHECK_THROWS_AS((void)load_center_line_csv("/no/such/file.csv"), MapError);
  CHECK_THROWS_AS((void)load_center_line_csv("/"), MapError);
}

TEST_CASE("a table that says two things is refused rather than read as one of them") {
  CHECK(support::error_of([] { (void)read_center_line_csv("x;y\n0,5;0,5\n10,5;0,5\n", "a.csv"); }) ==
        "a.csv:2: cell 1 is no finite number: \"0,5\"; give a number with a decimal point");
  CHECK(support::error_of([] { (void)read_center_line_csv("x,y\n0,0\n10,0,5,6\n", "a.csv"); }) ==
        "a.csv:3: it has 4 cells, the first row 2; give each row the same columns, and numbers a decimal point");
  for (auto const* text :
       {"x,y,theta\n0,0,45\n7,7,45\n14,14,45\n", "0,0,3.14\n10,0,3.14\n", "0,0,3.14\n10,0,0\n20,0,0\n"})
    CHECK(support::error_of([&] { (void)read_center_line_csv(text); }).find("does not fit the direction") !=
          std::string::npos);
  std::string laps = "x,y,theta\n";
  for (int i = 0; i <= 300; ++i)  // five laps, whose heading counts them
    laps += std::to_string(30 * std::sin(0.1 * i)) + ',' + std::to_string(30 - 30 * std::cos(0.1 * i)) + ',' +
            std::to_string(0.1 * i) + '\n';
  CHECK(read_center_line_csv(laps).points.size() == 301);
}

TEST_CASE("damaged tables are read or refused, never worse") {
  std::string const good = "id,x,y,theta,x_left\n1,0.5,1,0.1,3\n2,10,-0.5,0.2,3\n3,20.25,1e1,0.3,3\n";
  Numbers random{4};
  std::string const letters = "0123456789.,;-+eE\n\r\"# xyNaninf\0\xff";
  for (int i = 0; i < 3000; ++i) {
    std::string text = good;
    for (int k = 0; k < 3; ++k) {
      auto const at = static_cast<std::size_t>(random(0, static_cast<double>(text.size()) - 0.01));
      auto const letter = letters[static_cast<std::size_t>(random(0, static_cast<double>(letters.size()) - 0.01))];
      if (i % 3 == 0)
        text.erase(at, 1);
      else if (i % 3 == 1)
        text.insert(at, 1, letter);
      else
        text[at] = letter;
    }
    try {
      MapBuilder builder;
      builder.add_road(lane_along(read_center_line_csv(text)));
      auto const map = builder.build();
      for (auto const& lane : map->lanes())
        for (auto const& p : lane.path.points()) REQUIRE(std::isfinite(p.x() + p.y()));
    } catch (MapError const&) {
    }
  }
}

TEST_CASE("the path of a table's lane is its centre line, also where the borders are not as far on both sides") {
  std::string text = "x,y,x_leftbound,y_leftbound,x_rightbound,y_rightbound\n";
  auto const left = [](double u) { return 3.0 + std::sin(0.05 * u); };
  auto const right = [](double u) { return 2.5 + 1.5 * std::sin(0.02 * u); };
  auto const points = points_of([](double u) { return winding(u); });
  for (double u = 0.0; u <= 200.0; u += 4.0) {
    for (auto const& p : {winding(u), winding(u, left(u)), winding(u, -right(u))})
      text += std::to_string(p.x()) + "," + std::to_string(p.y()) + ",";
    text.back() = '\n';
  }
  MapBuilder builder;
  auto const line = read_center_line_csv(text);
  builder.add_road(lane_along(line));
  auto const map = builder.build();
  std::size_t drivable = 0;
  for (auto const& lane : map->lanes()) {
    drivable += lane.drivable();
    if (!lane.drivable()) CHECK(lane.type == LaneType::shoulder);
  }
  CHECK(drivable == 1);
  auto const& road = map->roads()[0];
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    double const u = 4.0 * static_cast<double>(i);
    auto const hit = map->nearest_lane({points[i].x(), points[i].y(), std::atan(0.9 * std::cos(0.03 * u))});
    REQUIRE(hit.has_value());
    CHECK(std::abs(hit->lateral) < 0.011);  // the path is sampled to 1 cm
    double const s = map->lane(hit->lane).station_at(hit->s);
    CHECK(std::abs(lane_point(road, s, -1)->t) < 1e-9);  // exactly the reference line
    CHECK(std::abs(lane_point(road, s, 1)->outer_t - left(u)) < 0.02);
    CHECK(std::abs(lane_point(road, s, -2)->outer_t + right(u)) < 0.02);
  }
}
