#include "cambium/viewer/detail/lane_marks.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/viewer/record_world.hpp"
#include "support/maps.hpp"

using namespace cambium;
using detail::MarkStyle;

namespace {

struct Lengths {
  double edge = 0.0, divider = 0.0, centre = 0.0;
};

std::vector<detail::LaneMark> marks_of(std::vector<RecordedLane> const& lanes) {
  std::vector<detail::LaneArea> const areas(lanes.begin(), lanes.end());
  return detail::LaneMarker(lanes, areas).marks();
}

// Painted metres by style.
Lengths lengths(std::vector<RecordedLane> const& lanes) {
  Lengths sum;
  for (detail::LaneMark const& mark : marks_of(lanes)) {
    double length = 0.0;
    for (std::size_t i = 1; i < mark.points.size(); ++i) length += (mark.points[i] - mark.points[i - 1]).norm();
    (mark.style == MarkStyle::edge ? sum.edge : mark.style == MarkStyle::divider ? sum.divider : sum.centre) += length;
  }
  return sum;
}

RecordedLane straight(double from, double to, double left, double right) {
  return {.left = {{from, left}, {to, left}}, .right = {{from, right}, {from + (to - from) / 3.0, right}, {to, right}}};
}

}  // namespace

TEST_CASE("what lanes share is dashed, or a centre line between directions; what is beyond is solid, once") {
  auto const with = [](RecordedLane lane, bool forward, RecordedLaneKind kind) {
    lane.forward = forward;
    lane.kind = kind;
    return lane;
  };
  using Kind = RecordedLaneKind;
  auto const upper = straight(0, 90, 3, 0), lower = straight(0, 90, 0, -3);
  struct Case {
    char const* what;
    std::vector<RecordedLane> lanes;
    Lengths expected;
  };
  Case const cases[] = {
      {"neighbours", {upper, lower}, {180, 90, 0}},
      {"opposite directions", {with(upper, false, Kind::driving), lower}, {180, 0, 90}},
      {"opposite directions, by their points", {straight(90, 0, 0, 3), lower}, {180, 0, 90}},
      {"a shoulder", {upper, with(lower, true, Kind::other)}, {270, 0, 0}},
      {"a path outside the lanes", {upper, with(lower, true, Kind::way)}, {180, 0, 0}},
      {"a lane beside part of another", {upper, straight(30, 60, 0, -3)}, {180, 30, 0}},
      {"a lane within another", {upper, straight(0, 90, 2, 1)}, {180, 0, 0}},
      {"a second copy", {upper, upper}, {180, 0, 0}},
      {"a lane that has shrunk to nothing", {straight(0, 90, 0, 0), lower}, {180, 0, 0}},
      {"a lane without two points on a side", {{.left = {{0, 3}, {90, 3}}, .right = {{0, 0}}}}, {0, 0, 0}}};
  for (auto const& [what, lanes, expected] : cases) {
    CAPTURE(what);
    auto const sum = lengths(lanes);
    CHECK(sum.edge == doctest::Approx(expected.edge));
    CHECK(sum.divider == doctest::Approx(expected.divider));
    CHECK(sum.centre == doctest::Approx(expected.centre));
  }
}

TEST_CASE("a line goes on from lane to lane as one, so that its dashes keep their rhythm") {
  std::vector<RecordedLane> const lanes{straight(0, 30, 3, 0),   straight(0, 30, 0, -3), straight(60, 95, 3, 0),
                                        straight(60, 95, 0, -3), straight(30, 60, 3, 0), straight(30, 60, 0, -3)};
  auto const marks = marks_of(lanes);
  CHECK(marks.size() == 3);
  for (auto const& mark : marks) CHECK((mark.points.back() - mark.points.front()).norm() == doctest::Approx(95.0));
}

TEST_CASE("a road has a solid line all along the taper of a lane") {
  RecordedLane taper;
  taper.left = {{0, 0}, {90, 0}};
  taper.right = {{0, -3}, {90, 0}};
  RecordedLane shoulder;
  shoulder.left = taper.right;
  shoulder.right = {{0, -5}, {90, -2}};
  shoulder.kind = RecordedLaneKind::other;
  std::vector<RecordedLane> const lanes{straight(0, 90, 3, 0), taper, shoulder};
  auto const marks = marks_of(lanes);
  for (double x = 1.0; x < 90.0; x += 0.5) {  // below the lane that goes on: the taper's border, or its own
    geometry::Point const border{x, -3.0 + x / 30.0};
    double nearest = 1e9;
    for (auto const& mark : marks)
      if (mark.style == MarkStyle::edge) nearest = std::min(nearest, detail::distance_to_line(border, mark.points));
    CHECK(nearest < 0.5);
  }
}

TEST_CASE("the rim of a junction is painted, and nothing where ways cross within") {
  for (std::string const name : {"intersection_4way.xodr", "intersection_3way.xodr", "roundabout.xodr"}) {
    CAPTURE(name);
    auto const lanes = recorded_lanes(*support::own_map(name));
    std::vector<detail::LaneArea> const areas(lanes.begin(), lanes.end());
    auto const ways = [&](geometry::Point const& p) {
      std::size_t count = 0;
      for (std::size_t i = 0; i < lanes.size(); ++i)
        count += lanes[i].kind == RecordedLaneKind::junction && areas[i].contains(p);
      return count;
    };
    std::size_t within = 0, at_rim = 0;
    for (auto const& mark : detail::LaneMarker(lanes, areas).marks())
      for (int k = 0; k < 1000; ++k) {
        auto const p = detail::point_at(mark.points, 0.001 * k);
        std::size_t fewest = 1000, most = 0;
        for (int i = 0; i < 8; ++i) {
          double const direction = i * geometry::pi / 4;
          auto const there = ways(p + 0.75 * geometry::Point(std::cos(direction), std::sin(direction)));
          fewest = std::min(fewest, there);
          most = std::max(most, there);
        }
        within += fewest > 0;
        at_rim += fewest == 0 && most > 0;
      }
    CHECK(within == 0);
    CHECK(at_rim > 100);
  }
}

TEST_CASE("lines between lanes go on through a junction where no way crosses them") {
  double longest = 0.0;
  for (auto const& mark : marks_of(recorded_lanes(*support::own_map("merging.xodr"))))
    if (mark.style == MarkStyle::divider) longest = std::max(longest, mark.points.back().x() - mark.points.front().x());
  CHECK(longest > 900.0);  // all along the carriageway of two lanes
}

TEST_CASE("a simplified line stays within its tolerance") {
  detail::PointList circle;
  for (int i = 0; i <= 1000; ++i) circle.emplace_back(100.0 * std::cos(0.003 * i), 100.0 * std::sin(0.003 * i));
  detail::PointList const line = detail::simplified(circle, 0.05);
  CHECK(line.size() < 120);
  for (geometry::Point const& p : circle) CHECK(detail::distance_to_line(p, line) <= 0.05);
}

TEST_CASE("arrows run with the traffic") {
  std::vector<RecordedLane> lanes{straight(0, 90, 3, 0)};
  lanes[0].forward = false;
  std::vector<detail::LaneArea> const areas(lanes.begin(), lanes.end());
  auto const arrows = detail::lane_arrows(lanes, areas, 30.0);
  REQUIRE(arrows.size() == 3);
  CHECK(arrows[1].at.x() == doctest::Approx(45.0));
  CHECK(std::abs(arrows[1].heading) == doctest::Approx(3.14159265));
}

TEST_CASE("a lane's area holds the points on its inner side of every border, as a look at all edges says") {
  RecordedLane lane;  // a winding lane of some hundred points
  for (int i = 0; i <= 200; ++i) {
    double const x = i, y = 20.0 * std::sin(0.1 * x) + 5.0 * std::sin(1.3 * x);
    lane.left.emplace_back(x, y + 3.0);
    lane.right.emplace_back(x, y - 3.0);
  }
  detail::LaneArea const area(lane);
  RandomStream random(1, 0, 0);
  int inside = 0;
  for (int k = 0; k < 4000; ++k) {
    geometry::Point const p(-5.0 + 210.0 * uniform01(random), -30.0 + 60.0 * uniform01(random));
    bool expected = false;
    for (std::size_t i = 0; i < area.outline.size(); ++i) {
      auto const &a = area.outline[i], &b = area.outline[(i + 1) % area.outline.size()];
      if ((a.y() > p.y()) != (b.y() > p.y()) && (p.x() - a.x()) < (p.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y()))
        expected = !expected;
    }
    CHECK(area.contains(p) == expected);
    inside += expected;
  }
  CHECK(inside > 200);
}
