#include "cambium/geometry/frenet.hpp"

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "../support/corpus.hpp"

using namespace cambium;
using namespace cambium::geometry;

namespace {

/// A table of BARK's results; empty where there is no corpus.
std::vector<std::vector<std::string>> read_table(std::string const& name) {
  auto const file = corpus::find("oracle/bark/" + name);
  return file ? corpus::table(*file) : std::vector<std::vector<std::string>>{};
}

double number(std::string const& cell) { return std::strtod(cell.c_str(), nullptr); }

/// BARK rounds every Frenet angle to float.
constexpr double angle_tolerance = 5e-7;

bool is_vertex(Line const& line, double s) {
  auto const& segment = line.segments()[line.find(s)];
  return std::abs(s - segment.s) < 1e-9 || std::abs(s - segment.s - segment.length) < 1e-9;
}

/// The same with a heading error of that sign.
FrenetState turned(FrenetState state, double sign) {
  state.heading_error = std::copysign(state.heading_error, sign);
  return state;
}

Shape const bark_car{.front = 1.75, .rear = 2.25, .left = 1.0, .right = 1.0};

}  // namespace

TEST_CASE("Frenet states on a polyline are BARK's") {
  auto const lines = read_table("bark_arc_centerlines.csv"), rows = read_table("bark_frenet_arc.csv");
  if (lines.empty() || rows.empty()) return;
  std::vector<Point> points;
  for (auto const& row : lines) {
    if (row[0] == "0" && row[1] == "center") points.emplace_back(number(row[3]), number(row[4]));
  }
  Line const line = Line::from_points(points);
  std::size_t compared = 0;
  for (auto const& row : rows) {
    State const state{0.0, number(row[1]), number(row[2]), number(row[3]), number(row[4])};
    auto const frenet = to_frenet(line, state);
    auto const foot = line.pose(frenet.s);
    CAPTURE(state.x);
    REQUIRE(std::abs(frenet.s - number(row[5])) < 1e-9);
    REQUIRE(std::abs(frenet.lateral - number(row[6])) < 1e-9);
    REQUIRE(std::hypot(foot.x - number(row[11]), foot.y - number(row[12])) < 1e-9);
    // At a vertex BARK takes the mean of the two headings there, we that of one segment.
    if (is_vertex(line, frenet.s)) continue;
    REQUIRE(std::abs(angle_difference(foot.heading, number(row[13]))) < angle_tolerance);
    REQUIRE(std::abs(angle_difference(frenet.heading_error, -number(row[7]))) < angle_tolerance);
    REQUIRE(std::abs(frenet.longitudinal_speed - number(row[9])) < angle_tolerance * state.speed);
    REQUIRE(std::abs(frenet.lateral_speed - number(row[10])) < angle_tolerance * state.speed);
    ++compared;
  }
  CHECK(compared > rows.size() / 2);
}

TEST_CASE("shape-aware differences are BARK's") {
  auto const rows = read_table("bark_frenet_difference.csv");
  Line const line = Line::from_points(std::vector<Point>{{0.0, -1.75}, {1000.0, -1.75}});
  int overlaps = 0;
  for (auto const& row : rows) {
    auto const state = [&row](std::size_t i) {
      return State{0.0, number(row[i]), number(row[i + 1]), number(row[i + 2]), number(row[i + 3])};
    };
    auto const ego = to_frenet(line, state(0)), other = to_frenet(line, state(4));
    auto const difference = frenet_difference(ego, bark_car, other, bark_car);
    // Across the line BARK does not look which way a shape is turned: it takes the reach of the first turned right, and
    // of the second turned towards the first's far side. With headings of these signs the gaps must agree.
    double const sign = other.lateral > ego.lateral ? -1.0 : 1.0;
    auto const gaps = frenet_difference(turned(ego, -1.0), bark_car, turned(other, sign), bark_car);
    CAPTURE(state(4).x);
    // BARK keeps the distance of the reference points, and raises a flag, where we say that there is no gap.
    bool const along = row[9] == "1", across = row[11] == "1";
    REQUIRE(gaps.overlaps_along == along);
    REQUIRE(gaps.overlaps_across == across);
    REQUIRE(std::abs((along ? other.s - ego.s : gaps.longitudinal) - number(row[8])) < 4.0 * angle_tolerance);
    REQUIRE(std::abs((across ? other.lateral - ego.lateral : gaps.lateral) - number(row[10])) < 4.0 * angle_tolerance);
    REQUIRE(std::abs(difference.longitudinal_speed - number(row[12])) < 20.0 * angle_tolerance);
    REQUIRE(std::abs(difference.lateral_speed - number(row[13])) < 20.0 * angle_tolerance);
    REQUIRE(std::abs(angle_difference(difference.heading, -number(row[14]))) < 2.0 * angle_tolerance);
    overlaps += along + across;
  }
  if (!rows.empty()) CHECK(overlaps > 20);
}

TEST_CASE("a state survives the way into the Frenet frame and back") {
  RandomStream stream(1, 0, 0);
  std::vector<LineSample> samples;
  for (int i = 0; i <= 100; ++i) {  // a clothoid-like line, densely sampled
    double const t = i / 50.0;
    samples.push_back({50.0 * t, 10.0 * t * t, std::atan2(20.0 * t, 50.0)});
  }
  Line const line = Line::from_samples(samples);
  std::uint32_t hint = 0;
  int round_trips = 0;
  for (int i = 0; i < 2000; ++i) {
    double const s = Uniform{-5.0, line.length() + 5.0}(stream);
    Point const p = to_map(line.pose(s), {0.0, Uniform{-5.0, 5.0}(stream)});
    State const state{1.5, p.x(), p.y(), Uniform{-pi, pi}(stream), Uniform{-5.0, 20.0}(stream)};
    auto const frenet = to_frenet(line, state);
    auto const warm = to_frenet(line, state, hint);
    auto const local = geometry::to_local(line.pose(s), to_map(line.pose(s), {3.0, -2.0}));
    REQUIRE((local - Point{3.0, -2.0}).norm() < 1e-9);
    REQUIRE(warm.s == doctest::Approx(frenet.s).epsilon(1e-12));
    if (is_vertex(line, frenet.s)) continue;  // outside a kink the direction is lost
    auto const back = from_frenet(line, frenet, 1.5);
    REQUIRE(std::hypot(back.x - state.x, back.y - state.y) < 1e-9);
    REQUIRE(std::abs(angle_difference(back.heading, state.heading)) < 1e-9);
    REQUIRE(std::abs(back.speed - state.speed) < 1e-9);
    REQUIRE(back.time == 1.5);
    ++round_trips;
  }
  CHECK(round_trips > 1500);
}

TEST_CASE("velocities are split along and across the line") {
  Line const line = Line::from_points(std::vector<Point>{{0, 0}, {0, 100}});
  auto const frenet = to_frenet(line, State{.x = -2.0, .y = 30.0, .heading = pi / 2 + 0.1, .speed = 10.0});
  CHECK(frenet.s == doctest::Approx(30.0));
  CHECK(frenet.lateral == doctest::Approx(2.0));
  CHECK(frenet.heading_error == doctest::Approx(0.1));
  CHECK(frenet.longitudinal_speed == doctest::Approx(10.0 * std::cos(0.1)));
  CHECK(frenet.lateral_speed == doctest::Approx(10.0 * std::sin(0.1)));
}

TEST_CASE("the gap between two cars in a line is bumper to bumper, and changes its sign with the roles") {
  FrenetState const follower{.s = 10.0, .longitudinal_speed = 12.0}, leader{.s = 30.0, .longitudinal_speed = 9.0};
  auto const ahead = frenet_difference(follower, car(), leader, car());
  CHECK(ahead.longitudinal == doctest::Approx(20.0 - 4.5));
  CHECK(ahead.longitudinal_speed == doctest::Approx(-3.0));
  CHECK(ahead.overlaps_across);
  CHECK(!ahead.overlaps_along);
  auto const behind = frenet_difference(leader, car(), follower, car());
  CHECK(behind.longitudinal == doctest::Approx(-15.5));
  CHECK(behind.longitudinal_speed == doctest::Approx(3.0));
}

TEST_CASE("gaps along and across a straight line are those of the rectangles' projections") {
  RandomStream stream(2, 0, 0);
  Line const line = Line::from_points(std::vector<Point>{{-100, 0}, {100, 0}});
  for (int i = 0; i < 2000; ++i) {
    Uniform const side{0.2, 4.0}, x{-10.0, 10.0}, y{-6.0, 6.0}, heading{-pi, pi};
    Shape const first_shape{side(stream), side(stream), side(stream), side(stream)}, second_shape = truck();
    State const first{0.0, x(stream), y(stream), heading(stream), 1.0};
    State const second{0.0, x(stream), y(stream), heading(stream), 1.0};
    auto const difference =
        frenet_difference(to_frenet(line, first), first_shape, to_frenet(line, second), second_shape);
    Box const a = box_of(first_shape, first).bounding_box(), b = box_of(second_shape, second).bounding_box();
    auto const gap = [](double a_low, double a_high, double b_low, double b_high) {
      return b_low > a_high ? b_low - a_high : (b_high < a_low ? b_high - a_low : 0.0);
    };
    REQUIRE(difference.longitudinal == doctest::Approx(gap(a.min_x, a.max_x, b.min_x, b.max_x)));
    REQUIRE(difference.lateral == doctest::Approx(gap(a.min_y, a.max_y, b.min_y, b.max_y)));
    REQUIRE(difference.overlaps_along == (difference.longitudinal == 0.0));
    REQUIRE(difference.overlaps_across == (difference.lateral == 0.0));
  }
}
