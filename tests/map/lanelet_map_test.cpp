// Maps of lanelets, and Lanelet2 files.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/lanelet/detail/utm.hpp"
#include "cambium/map/lanelet/lanelet2.hpp"
#include "cambium/map/lanelet/lanelet_map.hpp"
#include "cambium/map/opendrive.hpp"

#include "../support/map_faults.hpp"
#include "../support/corpus.hpp"
#include "../support/error_of.hpp"
#include "../support/maps.hpp"

using cambium::Diagnostic;
using cambium::is_valid;
using cambium::geometry::Point;
using cambium::map::build_lanelet_map;
using cambium::map::Lanelet;
using cambium::map::LaneletMap;

namespace {

std::vector<Point> line(Point from, Point to) { return {from, 0.5 * (from + to), to}; }

/// A straight lanelet of 3.5 m about the line from `from` to `to`.
Lanelet straight(std::int64_t id, Point from, Point to) {
  Point const way = (to - from).normalized(), left{-1.75 * way.y(), 1.75 * way.x()};
  return {.id = id, .left = line(from + left, to + left), .right = line(from - left, to - left)};
}

cambium::map::Lane const& lane_of(LaneletMap const& made, std::int64_t id) { return made.map->lane(made.lanes.at(id)); }

std::string text_of(std::vector<Diagnostic> const& diagnostics) {
  std::string text;
  for (auto const& found : diagnostics) text += to_string(found) + "\n";
  return text;
}

/// A Lanelet2 file: two lanes side by side, the right one followed by another, with a stop sign and a speed limit.
std::string lanelet2_text() {
  std::string text = "<?xml version='1.0'?>\n<osm version='0.6'>\n";
  int id = 0;
  for (double const y : {3.5, 0.0, -3.5})
    for (double const x : {0.0, 50.0, 100.0})
      text += "<node id='" + std::to_string(++id) + "' lat='0' lon='0'><tag k='local_x' v='" + std::to_string(x) +
              "'/><tag k='local_y' v='" + std::to_string(y) + "'/></node>\n";
  auto const way = [&](int number, int from, int to, std::string const& tags) {
    text += "<way id='" + std::to_string(number) + "'><nd ref='" + std::to_string(from) + "'/><nd ref='" +
            std::to_string(to) + "'/>" + tags + "</way>\n";
  };
  std::string const kerb = "<tag k='type' v='curbstone'/>";
  way(10, 1, 2, kerb);
  way(11, 5, 4, "<tag k='type' v='line_thin'/><tag k='subtype' v='dashed'/>");  // written backwards
  way(12, 7, 8, kerb);
  way(13, 5, 6, kerb);
  way(14, 8, 9, kerb);
  text +=
      "<node id='90' lat='0' lon='0'><tag k='local_x' v='90'/><tag k='local_y' v='0'/></node>\n"
      "<node id='91' lat='0' lon='0'><tag k='local_x' v='90'/><tag k='local_y' v='-3.5'/></node>\n";
  way(15, 90, 91, "<tag k='type' v='stop_line'/>");
  auto const lanelet = [&](int number, int left, int right, std::string const& more) {
    text += "<relation id='" + std::to_string(number) + "'><member type='way' role='left' ref='" +
            std::to_string(left) + "'/><member type='way' role='right' ref='" + std::to_string(right) +
            "'/><tag k='type' v='lanelet'/><tag k='subtype' v='road'/>" + more + "</relation>\n";
  };
  lanelet(20, 10, 11, "<tag k='speed_limit' v='50 km/h'/>");
  lanelet(21, 11, 12, "<member type='relation' role='regulatory_element' ref='30'/>");
  lanelet(22, 13, 14, "<tag k='speed_limit' v='30 mph'/><member type='relation' role='regulatory_element' ref='31'/>");
  text +=
      "<relation id='30'><member type='relation' role='yield' ref='21'/><tag k='type' v='regulatory_element'/>"
      "<tag k='subtype' v='right_of_way'/></relation>\n"
      "<relation id='31'><member type='way' role='ref_line' ref='15'/><tag k='type' v='regulatory_element'/>"
      "<tag k='subtype' v='traffic_light'/></relation>\n";
  return text + "</osm>\n";
}

LaneletMap lanelet2_map(std::string const& text) {
  std::vector<Diagnostic> diagnostics;
  auto result = build_lanelet_map(cambium::map::read_lanelet2(text, {}, "a.osm", diagnostics));
  result.diagnostics.insert(result.diagnostics.begin(), diagnostics.begin(), diagnostics.end());
  return result;
}

}  // namespace

TEST_CASE("lanelets side by side are neighbours, with the marks between them") {
  auto left = straight(1, {0, 0}, {100, 0}), right = straight(2, {0, -3.5}, {100, -3.5});
  left.right_neighbor = 2;
  right.left_neighbor = 1;
  right.may_change_left = false;
  right.speed_limit = 13.0;
  auto const made = build_lanelet_map({left, right});
  CHECK(made.diagnostics.empty());
  REQUIRE(made.lanes.size() == 2);
  CHECK(lane_of(made, 2).left_neighbor == made.lanes.at(1));
  CHECK(lane_of(made, 1).right_neighbor == made.lanes.at(2));
  CHECK(lane_of(made, 1).may_change_right(50.0));
  CHECK_FALSE(lane_of(made, 2).may_change_left(50.0));
  CHECK(lane_of(made, 2).speed_limit_at(10.0) == 13.0);
  CHECK(lane_of(made, 2).path.pose(40.0).position().y() == doctest::Approx(-3.5).epsilon(1e-9));
  auto const widths = lane_of(made, 2).widths_at(40.0);
  CHECK(widths.left + widths.right == doctest::Approx(3.5));
}

TEST_CASE("a lane that ends beside another merges into it") {
  auto left = straight(1, {0, 0}, {100, 0}), right = straight(2, {0, -3.5}, {90, -3.5}),
       next = straight(3, {100, 0}, {200, 0});
  left.right_neighbor = 2;
  left.successors = {3};
  right.signals = {{cambium::map::SignalKind::give_way, 60.0}, {cambium::map::SignalKind::stop, 10.0}};
  auto const made = build_lanelet_map({left, right, next});
  CHECK(lane_of(made, 1).successors == std::vector{made.lanes.at(3)});
  auto const& merging = lane_of(made, 2);
  CHECK(merging.merges_into == made.lanes.at(1));
  REQUIRE(merging.signals.size() == 2);  // beside the places where they were before the path swung over
  CHECK(merging.path.pose(merging.signals[0].s).x == doctest::Approx(30.0).epsilon(1e-3));
  CHECK(merging.path.pose(merging.signals[1].s).x == doctest::Approx(80.0).epsilon(1e-3));
  REQUIRE(merging.left_changes.size() == 1);
  CHECK(merging.left_changes[0].end <= merging.length());
  CHECK(map_faults::first_fault(*made.map) == "");
}

TEST_CASE("a lane merges only where the line permits it and its length is enough, and says so") {
  auto const map = [](double length, bool permitted) {
    auto left = straight(1, {0, 0}, {length, 0}), right = straight(2, {0, -3.5}, {length, -3.5}),
         next = straight(3, {length, 0}, {length + 100, 0});
    left.right_neighbor = 2;
    left.successors = {3};
    right.may_change_left = permitted;
    return build_lanelet_map({left, right, next});
  };
  auto const merges = [](LaneletMap const& made) { return is_valid(lane_of(made, 2).merges_into); };
  for (double const length : {0.5, 3.0, 12.0}) {
    auto const made = map(length, true);
    CHECK_FALSE(merges(made));
    CHECK(lane_of(made, 2).successors.empty());
    CHECK(text_of(made.diagnostics).find("lanelet 2: it ends beside lanelet 1, but it is too short") !=
          std::string::npos);
  }
  auto const solid = map(100.0, false);
  CHECK_FALSE(merges(solid));
  CHECK(text_of(solid.diagnostics).find("lanelet 2: it ends beside lanelet 1, but the line") != std::string::npos);
  for (double const length : {14.0, 100.0}) {
    auto const made = map(length, true);
    CHECK(merges(made));
    CHECK(map_faults::first_fault(*made.map) == "");
    CHECK(text_of(made.diagnostics).find("lanelet 2: it ends beside lanelet 1, and was merged") != std::string::npos);
    for (auto const& segment : lane_of(made, 2).path.segments()) CHECK(std::abs(segment.curvature) < 0.25);
  }
}

TEST_CASE("a stop line lies before a lanelet's end by the way along it, and is drawn there again") {
  Lanelet bend{.id = 1};
  for (int k = 0; k <= 18; ++k) {  // a quarter to the left about (0, 20)
    double const sin = std::sin(k * cambium::geometry::pi / 36), cos = std::cos(k * cambium::geometry::pi / 36);
    bend.left.emplace_back(18.0 * sin, 20.0 - 18.0 * cos);
    bend.right.emplace_back(22.0 * sin, 20.0 - 22.0 * cos);
  }
  double const length = 20.0 * cambium::geometry::pi / 2;
  using cambium::map::distance_before_end, cambium::map::line_before_end;
  for (double const share : {0.25, 0.5, 1.0}) {
    double const angle = (1.0 - share) * cambium::geometry::pi / 2;
    Point const place(20.0 * std::sin(angle), 20.0 - 20.0 * std::cos(angle));
    double const before = distance_before_end(bend, place);
    CHECK(before == doctest::Approx(share * length).epsilon(0.002));
    auto const line = line_before_end(bend, before).value();
    CHECK((line[0] - line[1]).norm() == doctest::Approx(4.0).epsilon(0.001));
    CHECK(distance_before_end(bend, 0.5 * (line[0] + line[1])) == before);
  }
  CHECK(distance_before_end(bend, {20.0, 30.0}) == 0.0);  // behind its end
  CHECK(distance_before_end(bend, {-40.0, 0.0}) == 0.0);  // of another lanelet
  bend.left.resize(1);
  CHECK(distance_before_end(bend, {0.0, 0.0}) == 0.0);
  CHECK_FALSE(line_before_end(bend, 1.0));
}

TEST_CASE("lanelets that cross are a junction with conflicts, and so is what turns off beside them") {
  auto in = straight(1, {-60, 0}, {-10, 0}), across = straight(2, {-10, 0}, {10, 0}),
       out = straight(3, {10, 0}, {60, 0}), from_south = straight(4, {0, -60}, {0, -10}),
       north = straight(5, {0, -10}, {0, 10}), to_north = straight(6, {0, 10}, {0, 60});
  Lanelet turn{.id = 7};  // from the west to the north: it crosses nothing that it does not meet at its end
  for (int k = 0; k <= 10; ++k) {
    double const angle = -0.5 * cambium::geometry::pi + 0.05 * cambium::geometry::pi * k;
    auto const at = [&](double r) { return Point{-10 + r * std::cos(angle), 10 + r * std::sin(angle)}; };
    turn.left.push_back(at(8.25));
    turn.right.push_back(at(11.75));
  }
  in.successors = {2, 7};
  across.successors = {3};
  from_south.successors = {5};
  north.successors = {6};
  turn.successors = {6};
  from_south.signals = {{cambium::map::SignalKind::stop, 2.0, {}}};
  auto const made = build_lanelet_map({in, across, out, from_south, north, to_north, turn});
  CHECK_MESSAGE(made.diagnostics.empty(), text_of(made.diagnostics));
  auto const junction = [&](std::int64_t id) { return made.map->road(lane_of(made, id).road).junction; };
  CHECK(is_valid(junction(2)));
  CHECK(junction(5) == junction(2));
  CHECK(junction(7) == junction(2));
  for (int const id : {1, 3, 4, 6}) CHECK_FALSE(is_valid(junction(id)));
  CHECK(lane_of(made, 1).successors.size() == 2);
  auto const road =
      cambium::map::build_road_corridor(*made.map, cambium::map::straight_route(*made.map, made.lanes.at(4)));
  auto const& conflicts = road->corridors[road->main].conflicts;
  REQUIRE_FALSE(conflicts.empty());
  CHECK(conflicts[0].right_of_way == cambium::map::RightOfWay::yields);
  REQUIRE(lane_of(made, 4).signals.size() == 1);
  CHECK(lane_of(made, 4).signals[0].s == doctest::Approx(48.0));
}

TEST_CASE("a bridge neither crosses nor makes a junction of what lies under it") {
  for (double const height : {0.0, 2.0, 6.0}) {
    auto under = straight(1, {0, 0}, {100, 0}), over = straight(2, {50, -50}, {50, 50});
    for (auto* lanelet : {&under, &over}) {
      lanelet->left_heights.assign(3, 100.0);
      lanelet->right_heights.assign(3, 100.0);
    }
    over.left_heights[1] = over.right_heights[1] = 100.0 + height;  // a ramp up and one down
    auto const made = build_lanelet_map({under, over});
    CHECK(made.diagnostics.empty());
    auto const& road = made.map->road(lane_of(made, 2).road);
    CHECK(road.elevation.value(0.0) == doctest::Approx(100.0));
    CHECK(road.elevation.value(25.0) == doctest::Approx(100.0 + 0.5 * height).epsilon(1e-3));
    bool const is_bridge = height > cambium::map::clear_height;
    CHECK(made.map->junctions().size() == (is_bridge ? 0u : 1u));
    CHECK(lane_of(made, 1).overlaps.size() == (is_bridge ? 0u : 1u));
    auto const again = cambium::map::lanelets_of(*made.map);
    REQUIRE(again.size() == 2);
    CHECK(again[1].left_heights[again[1].left.size() / 2] == doctest::Approx(100.0 + height).epsilon(0.005));
    under.left_heights.clear();
    auto const flat = build_lanelet_map({under, over});
    CHECK(text_of(flat.diagnostics)
              .find("lanelet 1: it has no heights of all its points, and others have: the map is "
                    "flat") != std::string::npos);
    CHECK(lane_of(flat, 1).overlaps.size() == 1);
  }
}

TEST_CASE("what is odd in lanelets is a finding, and the rest is a map") {
  auto good = straight(1, {0, 0}, {100, 0}), next = straight(2, {100, 0}, {200, 0}),
       far = straight(3, {0, 50}, {9, 50});
  good.successors = {2, 3, 99};
  std::swap(next.left, next.right);
  Lanelet const point{.id = 4, .left = {{0, 0}, {0, 0}}, .right = {{0, 1}, {5, 1}}},
      wild{.id = 5, .left = {{0, 1}, {5, 1}}, .right = {{0, 0}, {std::nan(""), 0}}};
  auto const made = build_lanelet_map({good, next, far, point, wild, good}, {}, "five lanelets");
  auto const text = text_of(made.diagnostics);
  CHECK(made.lanes.size() == 3);
  CHECK(lane_of(made, 1).successors == std::vector{made.lanes.at(2)});
  for (char const* words :
       {"lanelet 1: its successor 99 is not there", "lanelet 1: its successor 3 does not begin where it ends",
        "lanelet 2: its left bound lies to the right", "lanelet 4: a bound has fewer than two",
        "lanelet 5: a point is no finite place", "lanelet 1: its id is taken already"})
    CHECK_MESSAGE(text.find(words) != std::string::npos, words, "\n", text);
  CHECK(support::error_of([&] { (void)build_lanelet_map({point}, {}, "point"); }).find("point: no lanelet is left") ==
        0);
}

TEST_CASE("a bound that runs the other way is turned, whichever it is") {
  for (bool const is_left : {true, false})
    for (double const longer : {0.0, 10.0}) {
      CAPTURE(is_left);
      Lanelet lanelet{.id = -1, .left = {{0, 4}, {60, 4}}, .right = {{0, 0}, {60 - longer, 0}}};
      auto& bound = is_left ? lanelet.left : lanelet.right;
      std::reverse(bound.begin(), bound.end());
      auto const made = build_lanelet_map({lanelet});
      CHECK(text_of(made.diagnostics).find("lanelet -1: its bounds run opposite ways; one was turned") !=
            std::string::npos);
      CHECK(lane_of(made, -1).length() == doctest::Approx(60.0 - 0.5 * longer).epsilon(0.01));
      CHECK(std::cos(lane_of(made, -1).path.pose(5.0).heading) > 0.9);
    }
}

TEST_CASE("short lanelets and rings with a reversed bound are turned") {
  for (double const length : {0.6, 1.2, 3.0}) {
    CAPTURE(length);
    Lanelet lanelet{.id = 1, .left = {{length, 1.75}, {0, 1.75}}, .right = {{0, -1.75}, {length, -1.75}}};
    auto const made = build_lanelet_map({lanelet});
    CHECK(lane_of(made, 1).length() == doctest::Approx(length).epsilon(0.01));
  }
  Lanelet ring{.id = 1};
  for (int k = 0; k <= 60; ++k) {
    double const angle = 0.05 + 6.2 * k / 60.0;
    ring.left.emplace_back(18.0 * std::cos(angle), 18.0 * std::sin(angle));
    ring.right.emplace_back(21.5 * std::cos(angle), 21.5 * std::sin(angle));
  }
  std::reverse(ring.right.begin(), ring.right.end());
  auto const made = build_lanelet_map({ring});
  CHECK(text_of(made.diagnostics).find("opposite ways; one was turned") != std::string::npos);
  CHECK(lane_of(made, 1).length() == doctest::Approx(6.2 * 19.75).epsilon(0.01));
}

TEST_CASE("a tight turn with slanted ends is not turned, and reversed it is") {
  Lanelet tight{.id = 1};
  tight.right.emplace_back(-2.0, -5.3);
  for (int k = 0; k <= 16; ++k) {
    double const angle = 3.14159265 * (k / 16.0 - 0.5);
    tight.left.emplace_back(k % 16 == 0 ? 0.0 : 0.3 * std::cos(angle), 0.3 * std::sin(angle));  // corners on a gate
    tight.right.emplace_back(5.3 * std::cos(angle), 5.3 * std::sin(angle));
  }
  tight.left.emplace_back(-2.0, 0.3);
  auto turned = tight;
  std::reverse(turned.left.begin(), turned.left.end());
  double const length = lane_of(build_lanelet_map({tight}), 1).length();
  CHECK(text_of(build_lanelet_map({tight}).diagnostics).find("opposite ways") == std::string::npos);
  CHECK(text_of(build_lanelet_map({turned}).diagnostics).find("opposite ways") != std::string::npos);
  CHECK(lane_of(build_lanelet_map({turned}), 1).length() == doctest::Approx(length));
}

TEST_CASE("a lane over itself lies within its bounds") {
  Lanelet loops{.id = 1};
  for (int k = 0; k <= 90; ++k) {
    double const angle = 9.4 * k / 90.0, radius = 18.0 + 0.05 * k;
    loops.left.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    loops.right.emplace_back((radius + 3.5) * std::cos(angle), (radius + 3.5) * std::sin(angle));
  }
  auto const text = text_of(build_lanelet_map({loops}).diagnostics);
  CHECK_MESSAGE(text.find("leaves its bounds") == std::string::npos, text);
}

TEST_CASE("a ring that nearly closes is not turned") {
  for (double const gap : {-0.02, 0.02}) {
    Lanelet ring{.id = 1};
    for (int k = 0; k <= 60; ++k) {
      double const turn = k / 60.0;
      auto const at = [&](double radius, double end) {
        double const angle = (2.0 * 3.14159265 - end / radius) * turn;
        return Point{radius * std::cos(angle), radius * std::sin(angle)};
      };
      ring.left.push_back(at(18.0, gap));
      ring.right.push_back(at(21.5, -gap));
    }
    auto const made = build_lanelet_map({ring});
    CHECK(text_of(made.diagnostics).find("opposite ways") == std::string::npos);
    CHECK(lane_of(made, 1).length() == doctest::Approx(2.0 * 3.14159265 * 19.75).epsilon(0.01));
  }
}

TEST_CASE("a lane over itself is cut where its limit changes, on the right turn and height") {
  auto const map =
      cambium::parse_opendrive(
          "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/><road name=\"\" length=\"140\" id=\"1\" "
          "junction=\"-1\"><planView><geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"140\"><arc "
          "curvature=\"0.0666666667\"/></geometry></planView><elevationProfile><elevation s=\"0\" a=\"0\" "
          "b=\"0.08\" c=\"0\" d=\"0\"/></elevationProfile><lanes><laneSection s=\"0\"><center><lane id=\"0\" "
          "type=\"none\"/></center><right><lane id=\"-1\" type=\"driving\"><width sOffset=\"0\" a=\"3.5\" "
          "b=\"0\" c=\"0\" d=\"0\"/><speed sOffset=\"0\" max=\"10\"/><speed sOffset=\"100\" max=\"20\"/>"
          "</lane></right></laneSection></lanes></road></OpenDRIVE>")
          .map;
  auto const lanelets = cambium::map::lanelets_of(*map, 1);
  REQUIRE(lanelets.size() == 2);
  auto const length = [](std::vector<Point> const& points) {
    double sum = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
    return sum;
  };
  CHECK(length(lanelets[0].left) == doctest::Approx(100.0).epsilon(0.01));
  CHECK(length(lanelets[0].right) == doctest::Approx(100.0 * 18.5 / 15.0).epsilon(0.01));
  CHECK(length(lanelets[1].left) == doctest::Approx(40.0).epsilon(0.01));
  CHECK(lanelets[0].left_heights.front() == doctest::Approx(0.0).epsilon(0.01));
  CHECK(lanelets[0].right_heights.back() == doctest::Approx(8.0).epsilon(0.01));
  CHECK(lanelets[1].right_heights.back() == doctest::Approx(11.2).epsilon(0.01));

  auto const ramp = cambium::parse_opendrive(
                        "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/><road name=\"\" length=\"300\" id=\"1\" "
                        "junction=\"-1\"><planView><geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"80\"><arc "
                        "curvature=\"0.15625\"/></geometry><geometry s=\"80\" x=\"-0.424460\" y=\"0.014091\" "
                        "hdg=\"12.5\" length=\"220\"><line/></geometry></planView><lanes><laneSection s=\"0\"><center>"
                        "<lane id=\"0\" type=\"none\"/></center><right><lane id=\"-1\" type=\"driving\"><width "
                        "sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/><speed sOffset=\"0\" max=\"10\"/><speed "
                        "sOffset=\"20\" max=\"20\"/><speed sOffset=\"60\" max=\"10\"/><speed sOffset=\"150\" "
                        "max=\"20\"/></lane></right></laneSection></lanes></road></OpenDRIVE>")
                        .map;
  auto const parts = cambium::map::lanelets_of(*ramp, 1);
  REQUIRE(parts.size() == 4);
  double const wider = 1.0 + 3.5 * 0.15625;
  double const lengths[] = {20.0 * wider, 40.0 * wider, 20.0 * wider + 70.0, 150.0};
  for (std::size_t k = 0; k < 4; ++k) CHECK(length(parts[k].right) == doctest::Approx(lengths[k]).epsilon(0.01));

  // The right border folds: the lane is wider than the bend's radius.
  auto const bend =
      cambium::parse_opendrive(
          "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/><road name=\"\" length=\"74.712389\" id=\"1\" "
          "junction=\"-1\"><planView><geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"20\"><line/>"
          "</geometry><geometry s=\"20\" x=\"20\" y=\"0\" hdg=\"0\" length=\"4.712389\"><arc "
          "curvature=\"-0.33333333333\"/></geometry><geometry s=\"24.712389\" x=\"23\" y=\"-3\" "
          "hdg=\"-1.5707963268\" length=\"50\"><line/></geometry></planView><elevationProfile><elevation "
          "s=\"0\" a=\"0\" b=\"0.08\" c=\"0\" d=\"0\"/></elevationProfile><lanes><laneSection s=\"0\">"
          "<center><lane id=\"0\" type=\"none\"/></center><right><lane id=\"-1\" type=\"driving\"><width "
          "sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/><speed sOffset=\"0\" max=\"10\"/><speed "
          "sOffset=\"30\" max=\"20\"/></lane></right></laneSection></lanes></road></OpenDRIVE>")
          .map;
  auto const legs = cambium::map::lanelets_of(*bend, 1);
  REQUIRE(legs.size() == 2);
  CHECK(length(legs[1].right) == doctest::Approx(44.7).epsilon(0.02));
  CHECK(length(legs[1].left) == doctest::Approx(44.7).epsilon(0.02));
  CHECK(legs[1].right_heights.back() == doctest::Approx(0.08 * 74.7).epsilon(0.01));
  CHECK(legs[0].right_heights.back() == doctest::Approx(0.08 * 30.0).epsilon(0.02));
}

TEST_CASE("bounds that cross are left out, and a path that leaves its bounds is a finding") {
  Lanelet const crossing{.id = 1, .left = {{0, 2}, {100, -1}}, .right = {{0, -2}, {100, 1}}},
      touching{.id = 2, .left = {{0, 22}, {100, 20}}, .right = {{0, 18}, {100, 20}}},
      nook{.id = 3,  // its left bound makes a long detour, its right one none
           .left = {{0, 62}, {50, 62}, {50, 92}, {54, 92}, {54, 62}, {100, 62}},
           .right = {{0, 58}, {100, 58}}};
  auto const made = build_lanelet_map({crossing, touching, nook});
  auto const text = text_of(made.diagnostics);
  CHECK(made.lanes.size() == 2);
  CHECK_MESSAGE(text.find("lanelet 1: its bounds cross") != std::string::npos, text);
  CHECK_MESSAGE(text.find("lanelet 3: its path leaves its bounds") != std::string::npos, text);
  CHECK(text.find("lanelet 2:") == std::string::npos);
}

TEST_CASE("a lanelet whose named successor lies elsewhere goes on as the one that begins where it ends") {
  auto one = straight(1, {0, 0}, {100, 0}), other = straight(2, {100, 0}, {200, 0}),
       far = straight(3, {0, 50}, {9, 50});
  one.successors = {3};
  auto const made = build_lanelet_map({one, other, far});
  CHECK(lane_of(made, 1).successors == std::vector{made.lanes.at(2)});
  CHECK(text_of(made.diagnostics).find("lanelet 2 begins where it ends") != std::string::npos);
}

TEST_CASE("the lanelets of a map make the same lanes again") {
  for (char const* name : {"merging.xodr", "intersection_4way.xodr", "roundabout.xodr"}) {
    CAPTURE(name);
    auto const map = support::own_map(name);
    auto const lanelets = cambium::map::lanelets_of(*map, 1000);
    auto const made = build_lanelet_map(lanelets);
    std::size_t linked = 0, kept = 0;
    for (auto const& lanelet : lanelets) {
      CAPTURE(lanelet.id);
      auto const& lane = map->lane(static_cast<cambium::LaneId>(lanelet.id - 1000));
      REQUIRE(made.lanes.contains(lanelet.id));
      auto const& copy = lane_of(made, lanelet.id);
      linked += lanelet.successors.size();
      kept += copy.successors.size();
      if (is_valid(lane.merges_into)) continue;  // its path swings over
      CHECK(copy.length() == doctest::Approx(lane.length()).epsilon(0.02));
      auto const p = lane.path.pose(0.5 * lane.length()).position();
      CHECK(std::abs(copy.path.project(p).lateral) < 0.1);
    }
    CHECK(kept >= linked);
  }
}

TEST_CASE("lanelets that end aslant are neighbours, as wide as they are, and their paths do not turn with their ends") {
  Lanelet left{.id = 1, .left = {{0, 3.5}, {60, 3.5}}, .right = {{3, 0}, {63, 0}}, .right_neighbor = 2},
      right{.id = 2, .left = {{3, 0}, {63, 0}}, .right = {{6, -3.5}, {66, -3.5}}};
  auto const made = build_lanelet_map({left, right});
  CHECK_MESSAGE(made.diagnostics.empty(), text_of(made.diagnostics));
  CHECK(lane_of(made, 2).left_neighbor == made.lanes.at(1));
  auto const& lane = lane_of(made, 1);
  CHECK(lane.may_change_right(0.5));
  for (double const s : {0.0, 10.0, 59.9}) {
    CHECK(lane.path.pose(s).heading == doctest::Approx(0.0));
    CHECK(lane.widths_at(s).left + lane.widths_at(s).right == doctest::Approx(3.5).epsilon(1e-6));
  }
}

TEST_CASE("neighbours that part may be changed to only where they lie side by side; those far away are none") {
  Lanelet left{.id = 1, .left = {{0, 3.5}, {100, 3.5}}, .right = {{0, 0}, {100, 0}}, .right_neighbor = 2},
      parting{.id = 2, .left = {{0, 0}, {70, 0}, {100, -12}}, .right = {{0, -3.5}, {70, -3.5}, {98, -15.5}}},
      far{.id = 3, .left = {{0, -30}, {100, -30}}, .right = {{0, -33.5}, {100, -33.5}}, .left_neighbor = 2};
  auto const made = build_lanelet_map({left, parting, far});
  CHECK(lane_of(made, 1).right_neighbor == made.lanes.at(2));
  CHECK(lane_of(made, 1).may_change_right(60.0));
  CHECK_FALSE(lane_of(made, 1).may_change_right(90.0));
  CHECK_FALSE(is_valid(lane_of(made, 3).left_neighbor));
  CHECK(text_of(made.diagnostics).find("lanelet 3: its neighbour 2 does not lie beside it") != std::string::npos);
}

TEST_CASE("where bounds meet, lanes are linked whatever the turn; a link that the file lacks is a finding") {
  for (double const turn : {0.2, 0.48, 0.55, 0.99}) {
    CAPTURE(turn);
    Point const way{std::cos(turn), std::sin(turn)}, aside{-way.y(), way.x()};
    auto from = straight(1, {0, 0}, {50, 0});
    Lanelet to{.id = 2, .left = line({50, 1.75}, Point{50, 1.75} + 40.0 * way)};
    to.right = line({50, -1.75}, Point{50, -1.75} + 40.0 * way);
    auto const unnamed = build_lanelet_map({from, to});
    CHECK(lane_of(unnamed, 1).successors == std::vector{unnamed.lanes.at(2)});
    CHECK(unnamed.diagnostics.size() == 1);
    from.successors = {2};
    to.predecessors = {1};
    auto const made = build_lanelet_map({from, to});
    bool const has_kink = text_of(made.diagnostics).find("lanelet 2 continues 0.79 rad off") != std::string::npos;
    CHECK_MESSAGE(made.diagnostics.size() == (turn > 0.7 ? 1u : 0u), text_of(made.diagnostics));
    CHECK(has_kink == (turn > 0.7));
    auto const &before = lane_of(made, 1).path, &behind = lane_of(made, 2).path;
    CHECK(before.end_pose().heading >= -1e-9);
    CHECK(behind.begin_pose().heading - before.end_pose().heading == doctest::Approx(std::max(0.0, turn - 0.2)));
  }
}

TEST_CASE("a lane that is driven both ways goes on backwards where its bounds meet others") {
  auto one = straight(1, {0, 0}, {50, 0}), two = straight(2, {50, 0}, {100, 0}), back = straight(3, {0, 0}, {-50, 0});
  one.both_directions = two.both_directions = true;
  one.successors = {2};
  auto const made = build_lanelet_map({one, two, back});
  auto const opposite = [&](std::int64_t id) { return lane_of(made, id).opposite; };
  auto const& lanes = made.map->lanes();
  CHECK(lane_of(made, 1).successors == std::vector{made.lanes.at(2)});
  CHECK(lanes[index_of(opposite(2))].successors == std::vector{opposite(1)});
  CHECK(lanes[index_of(opposite(1))].successors == std::vector{made.lanes.at(3)});
}

TEST_CASE("the UTM projection has the grid's known values") {
  cambium::map::detail::UtmProjection const zone31(0.0, 3.0);
  CHECK(zone31(0.0, 0.0).x() == doctest::Approx(166021.443 - 500000.0).epsilon(1e-9));
  CHECK(zone31(0.0, 0.0).y() == doctest::Approx(0.0));
  CHECK(zone31(45.0, 3.0).y() == doctest::Approx(4982950.400).epsilon(1e-9));  // 0.9996 of the meridian's arc
  CHECK(zone31(-45.0, 3.0).y() == doctest::Approx(-4982950.400).epsilon(1e-9));
  // The grid's north is that of the zone's middle: Bergen lies in zone 32, Longyearbyen in 33.
  auto const turn = [](double latitude, double longitude) {
    auto const north = cambium::map::detail::UtmProjection(latitude, longitude)(latitude + 0.01, longitude);
    return std::atan2(north.x(), north.y());
  };
  auto const expected = [](double latitude, double from_middle) {
    return -std::sin(latitude * 0.0174533) * from_middle * 0.0174533;
  };
  CHECK(turn(60.4, 5.3) == doctest::Approx(expected(60.4, 5.3 - 9.0)).epsilon(0.01));
  CHECK(turn(55.9, 5.3) == doctest::Approx(expected(55.9, 5.3 - 3.0)).epsilon(0.01));
  CHECK(turn(78.2, 15.6) == doctest::Approx(expected(78.2, 0.6)).epsilon(0.01));
  CHECK(turn(78.2, 22.0) == doctest::Approx(expected(78.2, -5.0)).epsilon(0.01));
}

TEST_CASE("INTERACTION's test map lies where its tracks do") {
  auto const file = corpus::find("scenarios/interaction/TestScenarioForScripts.osm");
  if (!file) return;
  auto const made = cambium::load_lanelet2(file->string());
  REQUIRE(made.diagnostics.size() == 1);
  CHECK(made.diagnostics[0].sentence == "location=city is neither urban nor nonurban; urban was taken (2 of them)");
  REQUIRE(made.lanes.size() == 2);
  auto const right = lane_of(made, 20).path, left = lane_of(made, 21).path;
  CHECK(right.pose(0.0).x == doctest::Approx(1.0).epsilon(1e-4));
  CHECK(right.pose(0.0).y == doctest::Approx(2.5).epsilon(1e-4));
  CHECK(right.length() == doctest::Approx(99.9).epsilon(1e-3));
  CHECK(left.pose(0.0).y == doctest::Approx(5.5).epsilon(1e-4));
  CHECK(std::cos(left.pose(0.0).heading) == doctest::Approx(-1.0));  // its way is written against its traffic
}

TEST_CASE("a Lanelet2 file says who follows whom, who lies beside whom, limits and signs") {
  auto const made = lanelet2_map(lanelet2_text());
  auto const only_the_merge = [](LaneletMap const& map) {
    return map.diagnostics.size() == 1 && map.diagnostics[0].sentence.find("was merged into") != std::string::npos;
  };
  CHECK_MESSAGE(only_the_merge(made), text_of(made.diagnostics));
  CHECK(lane_of(made, 20).right_neighbor == made.lanes.at(21));
  CHECK(lane_of(made, 20).may_change_right(10.0));
  CHECK(lane_of(made, 21).successors == std::vector{made.lanes.at(22)});
  CHECK(lane_of(made, 20).speed_limit_at(1.0) == doctest::Approx(50.0 / 3.6));
  CHECK(lane_of(made, 22).speed_limit_at(1.0) == doctest::Approx(30.0 * 0.44704));
  REQUIRE(lane_of(made, 21).signals.size() == 1);
  CHECK(lane_of(made, 21).signals[0].kind == cambium::map::SignalKind::give_way);
  CHECK(lane_of(made, 21).path.pose(10.0).y == doctest::Approx(-1.75));
  REQUIRE(lane_of(made, 22).signals.size() == 1);
  CHECK(lane_of(made, 22).signals[0].s == doctest::Approx(40.0));
  REQUIRE(made.map->lights().size() == 1);
  CHECK(made.map->lights()[0].name == "31");
  CHECK(made.map->roads()[0].elevation.value(10.0) == 0.0);
  auto high = lanelet2_text();
  std::size_t number = 0;
  for (auto at = high.find("</node>"); at != std::string::npos; at = high.find("</node>", at + 40))
    high.insert(at, "<tag k='ele' v='" + std::to_string(200 + number++ % 3) + "'/>");  // rises by 1 m in 50 m
  auto const hill = lanelet2_map(high);
  CHECK_MESSAGE(only_the_merge(hill), text_of(hill.diagnostics));
  CHECK(hill.map->road(lane_of(hill, 21).road).elevation.value(25.0) == doctest::Approx(200.5));
  auto const with_line = [](std::string const& subtype) {
    auto text = lanelet2_text();
    text.replace(text.find("v='dashed'"), 10, "v='" + subtype + "'");
    return lanelet2_map(text);
  };
  // The way is written against the traffic: solid on its left is solid for the right lane.
  auto const mixed = with_line("solid_dashed");
  CHECK(lane_of(mixed, 20).may_change_right(10.0));
  CHECK_FALSE(lane_of(mixed, 21).may_change_left(10.0));
  CHECK_FALSE(lane_of(with_line("solid"), 20).may_change_right(10.0));
}

TEST_CASE("a malformed Lanelet2 file is an error with its line, or a map with findings") {
  auto const text = lanelet2_text();
  auto const replaced = [&](std::string const& what, std::string const& by) {
    auto copy = text;
    copy.replace(copy.find(what), what.size(), by);
    return copy;
  };
  auto const error = [](std::string const& changed) { return support::error_of([&] { (void)lanelet2_map(changed); }); };
  CHECK(error("<xsm/>").find("a.osm:1: the root element is <xsm>") == 0);
  CHECK(error("<osm/>").find("it has no usable lanelet") != std::string::npos);
  CHECK(error(replaced("<tag k='local_x' v='0.000000'/>", "")).find("its nodes have no places: node") !=
        std::string::npos);
  CHECK(error(replaced("lat='0' lon='0'><tag k='local_x' v='0.000000'/>", "lat='x' lon='0'>")).find("a.osm:3: ") == 0);
  auto const lost = lanelet2_map(replaced("role='right' ref='12'", "role='right' ref='77'"));
  CHECK(lost.lanes.size() == 2);
  CHECK(text_of(lost.diagnostics).find("way 77 is not there") != std::string::npos);
}

TEST_CASE("what a Lanelet2 file says twice, wrongly or in vain is a finding") {
  struct Case {
    std::string what, by, finding;
  };
  std::string const limit = "v='50 km/h'/>", end = "</osm>";
  for (Case const& c : {
           Case{end, "<node id='1' lat='0' lon='0'/></osm>", "node 1 is there already"},
           Case{end, "<way id='10'/></osm>", "way 10 is there already"},
           Case{end,
                "<relation id='30'><tag k='type' v='regulatory_element'/><tag k='subtype' v='right_of_way'/>"
                "</relation></osm>",
                "rule 30 is there already"},
           Case{end, "<relation id='5'><tag k='type' v='regulatory_element'/></relation></osm>",
                "rules without a subtype are not read"},
           Case{"type='way' role='right' ref='14'", "type='node' role='right' ref='14'", "is a node, not a way"},
           Case{limit, limit + "<tag k='one_way' v='maybe'/>", "one_way=maybe is neither yes nor no"},
           Case{limit, limit + "<tag k='one_way:bicycle' v='no'/>", "one_way:bicycle=no has no effect"},
           Case{limit, limit + "<tag k='participant:vehicle' v='Yes'/>",
                "participant:vehicle=Yes is neither yes nor no"},
           Case{limit, limit + "<tag k='participant:vehicel' v='yes'/>", "this participant is not known"},
           Case{limit, limit + "<tag k='turn_direction' v='up'/>",
                "turn_direction=up is none of left, straight, right"},
           Case{"v='dashed'/>", "v='dashd'/>", "lines of the subtype dashd are not known"},
           Case{limit, limit + "<tag k='location' v='city'/>", "location=city is neither urban nor nonurban"},
           Case{limit, limit + "<tag k='dynamic' v='yes'/>", "dynamic=yes is not read"},
           Case{limit, "v='999999999'/>", "speed_limit=999999999 is no speed"},
           Case{"ref='30'/>", "ref='30'/><member type='way' role='centerline' ref='12'/>",
                "members in the role \"centerline\" of lanelets are not read"},
           Case{"role='yield' ref='21'/>", "role='yield' ref='21'/><member type='way' role='cancel_line' ref='15'/>",
                "members in the role \"cancel_line\" of rules are not read"},
           Case{end, "<node id='99'/></osm>", "node 99 has no place; it was left out, for no bound needs it"},
           Case{limit, limit + "<tag k='no_drivable_lane' v='yes'/>", "no_drivable_lane=yes is not read"},
           Case{limit, limit + "<tag k='speed_limit:vehicle:bus' v='30'/>", "speed_limit:vehicle:bus=30 is not read"},
           Case{"v='dashed'/>", "v='dashed'/><tag k='lane_change' v='YES'/>", "lane_change=YES is neither"},
           Case{"ref='30'/>", "ref='30'/><member type='relation' role='regulatory_element' ref='504'/>",
                "lanelet 21 names the rule 504, which is not there"},
           Case{"role='yield' ref='21'", "role='yield' ref='9999'", "lanelet 9999 in the role yield is not there"},
           Case{"role='ref_line' ref='15'", "role='ref_line' ref='88'", "way 88 in the role ref_line is not there"},
       }) {
    CAPTURE(c.finding);
    auto text = lanelet2_text();
    text.replace(text.find(c.what), c.what.size(), c.by);
    auto const made = lanelet2_map(text);
    CHECK_MESSAGE(text_of(made.diagnostics).find(c.finding) != std::string::npos, text_of(made.diagnostics));
  }
}

TEST_CASE("a bicycle lane beside a lane does not take the place of the lane's neighbour") {
  auto text = lanelet2_text();
  text.insert(text.find("<relation id='20'>"),
              "<relation id='19'><member type='way' role='left' ref='11'/><member type='way' role='right' ref='12'/>"
              "<tag k='type' v='lanelet'/><tag k='subtype' v='bicycle_lane'/></relation>");
  auto const made = lanelet2_map(text);
  CHECK(lane_of(made, 20).right_neighbor == made.lanes.at(21));
}

TEST_CASE("lanelets that meet at different heights are not joined") {
  for (double const height : {0.0, 6.0}) {
    auto low = straight(1, {0, 0}, {50, 0}), high = straight(2, {50, 0}, {100, 0});
    for (auto* lanelet : {&low, &high})
      lanelet->left_heights = lanelet->right_heights = std::vector(3, lanelet == &high ? height : 0.0);
    CHECK(lane_of(build_lanelet_map({low, high}), 1).successors.empty() == (height > 0.0));
  }
}

namespace {

/// A Lanelet2 file of straight lanelets of 3.5 m that meet, with local places or degrees about a longitude at the
/// equator.
struct Osm {
  std::optional<double> longitude{};
  std::string nodes{}, others{};
  std::map<std::pair<double, double>, int> ids{};
  int last = 1000;

  int node(Point const& p) {
    auto const [at, is_new] = ids.try_emplace({std::round(p.x() * 1e3), std::round(p.y() * 1e3)}, last + 1);
    if (!is_new) return at->second;
    double const degrees = longitude ? std::remainder(*longitude + p.x() / 111319.5, 360.0) : 0.0;
    nodes += "<node id='" + std::to_string(++last) + "' lat='" + std::to_string(longitude ? p.y() / 110574.0 : 0.0) +
             "' lon='" + std::to_string(degrees) + "'>";
    if (!longitude)
      nodes +=
          "<tag k='local_x' v='" + std::to_string(p.x()) + "'/><tag k='local_y' v='" + std::to_string(p.y()) + "'/>";
    nodes += "</node>\n";
    return last;
  }
  int way(Point const& from, Point const& to) {
    int const a = node(from), b = node(to);
    others += "<way id='" + std::to_string(++last) + "'><nd ref='" + std::to_string(a) + "'/><nd ref='" +
              std::to_string(b) + "'/></way>\n";
    return last;
  }
  void lanelet(int id, Point const& from, Point const& to, std::string const& more = "") {
    auto const given = straight(id, from, to);
    int const left = way(given.left.front(), given.left.back()), right = way(given.right.front(), given.right.back());
    others += "<relation id='" + std::to_string(id) + "'><member type='way' role='left' ref='" + std::to_string(left) +
              "'/><member type='way' role='right' ref='" + std::to_string(right) +
              "'/><tag k='type' v='lanelet'/><tag k='subtype' v='road'/>" + more + "</relation>\n";
  }
  /// Two roads that cross; the ways inside have the ids 2 and 12, and name the rules 30 and 31.
  void crossing() {
    std::string const rules =
        "<member type='relation' role='regulatory_element' ref='30'/>"
        "<member type='relation' role='regulatory_element' ref='31'/>";
    lanelet(1, {-60, 0}, {-10, 0});
    lanelet(2, {-10, 0}, {10, 0}, "<tag k='turn_direction' v='straight'/>" + rules);
    lanelet(3, {10, 0}, {60, 0});
    lanelet(11, {0, -60}, {0, -10});
    lanelet(12, {0, -10}, {0, 10}, "<tag k='turn_direction' v='straight'/>" + rules);
    lanelet(13, {0, 10}, {0, 60});
  }
  /// A sign of that code, as a member of a rule.
  std::string sign(std::string const& code) {
    int const id = way({0, -90}, {1, -90});
    others.insert(others.rfind("</way>"), "<tag k='type' v='traffic_sign'/><tag k='subtype' v='" + code + "'/>");
    return "<member type='way' role='refers' ref='" + std::to_string(id) + "'/>";
  }
  void rule(int id, std::string const& subtype, std::string const& members) {
    others += "<relation id='" + std::to_string(id) + "'>" + members +
              "<tag k='type' v='regulatory_element'/><tag k='subtype' v='" + subtype + "'/></relation>\n";
  }
  [[nodiscard]] LaneletMap map() const { return lanelet2_map("<osm>\n" + nodes + others + "</osm>"); }
};

std::string member(std::string const& role, int id) {
  return "<member type='" + std::string(role == "ref_line" ? "way" : "relation") + "' role='" + role + "' ref='" +
         std::to_string(id) + "'/>";
}

}  // namespace

TEST_CASE("right of way between approaches and ways inside a junction holds for the ways inside") {
  for (auto const& pair : {std::pair(2, 12), {2, 11}, {1, 12}}) {
    CAPTURE(pair.first);
    CAPTURE(pair.second);
    Osm osm;
    osm.crossing();
    osm.rule(30, "right_of_way", member("right_of_way", pair.first) + member("yield", pair.second));
    auto const made = osm.map();
    REQUIRE(made.map->junctions().size() == 1);
    auto const& priorities = made.map->junctions()[0].priorities;
    REQUIRE(priorities.size() == 1);
    CHECK(made.map->road(priorities[0].high).name == "2");
    CHECK(made.map->road(priorities[0].low).name == "12");
    CHECK(lane_of(made, 12).signals.empty());
  }
}

TEST_CASE("right of way with a stop sign makes those that yield stop") {
  for (std::string const code : {"de206", "de205", "us"}) {
    Osm osm;
    osm.crossing();
    bool const is_inside = code == "us";  // and R1-1
    osm.rule(30, "right_of_way",
             member("right_of_way", 1) + member("yield", 11) + osm.sign(is_inside ? "usr1-1" : code));
    if (!is_inside) {  // else both approaches lead to ways inside
      for (auto at = osm.others.find("turn_direction"); at != std::string::npos; at = osm.others.find("turn_direction"))
        osm.others.replace(at, 14, "direction");
    }
    auto const made = osm.map();
    auto const& signals = lane_of(made, 11).signals;
    REQUIRE(signals.size() == 1);
    CHECK(signals[0].kind == (code == "de205" ? cambium::map::SignalKind::give_way : cambium::map::SignalKind::stop));
  }
}

TEST_CASE("speed signs and signs without effect that a rule of signs names are findings") {
  Osm osm;
  osm.crossing();
  osm.rule(30, "traffic_sign", osm.sign("de274-50") + osm.sign("de267"));
  auto const text = text_of(osm.map().diagnostics);
  CHECK(text.find("its sign de274-50 is a speed, which only an element of the subtype speed_limit sets") !=
        std::string::npos);
  CHECK(text.find("signs de267 have no effect: only those of priority and speed have") != std::string::npos);
}

TEST_CASE("a node that no lanelet has does not decide where the others lie") {
  Osm osm;
  osm.lanelet(1, {0, 0}, {50, 0});
  osm.nodes += "<node id='5' lat='0' lon='0'/>";
  auto const made = osm.map();
  CHECK(lane_of(made, 1).length() == doctest::Approx(50.0));
  CHECK_MESSAGE(made.diagnostics.empty(), text_of(made.diagnostics));
}

TEST_CASE("a file without a usable place says why") {
  Osm osm;
  osm.lanelet(1, {0, 0}, {50, 0});
  osm.nodes.replace(osm.nodes.find("local_x"), 7, "other_x");
  CHECK(support::error_of([&] { (void)osm.map(); }).find("node 1001 has no local_x and local_y") != std::string::npos);
  Osm missing{10.0};
  missing.lanelet(1, {0, 0}, {50, 0});
  missing.nodes.erase(0, missing.nodes.find("</node>") + 7);
  CHECK(support::error_of([&] { (void)missing.map(); }).find("names node 1001, which is not there") !=
        std::string::npos);
  CHECK(support::error_of([&] { (void)lanelet2_map("\x1f\x8b packed"); }).find("compressed (gzip); unpack it first") !=
        std::string::npos);
}

TEST_CASE("who may use a lanelet is said by the most special word") {
  using cambium::map::LaneType;
  std::string const vehicles = "<tag k='participant:vehicle' v='yes'/>",
                    no_cars = "<tag k='participant:vehicle:car' v='no'/>",
                    no_buses = "<tag k='participant:vehicle:bus' v='no'/>";
  auto const type = [](std::string const& tags) {
    Osm osm;
    osm.lanelet(1, {0, 0}, {50, 0}, tags);
    osm.lanelet(2, {0, 50}, {50, 50});
    auto const made = osm.map();
    return made.lanes.contains(1) ? lane_of(made, 1).type : LaneType::none;
  };
  CHECK(type(vehicles) == LaneType::driving);
  CHECK(type(vehicles + no_cars) == LaneType::bus);
  CHECK(type(vehicles + no_cars + no_buses) == LaneType::none);
  CHECK(type("<tag k='participant:vehicle' v='no'/><tag k='participant:vehicle:car' v='yes'/>") == LaneType::driving);
}

TEST_CASE("what all lanelets say wrongly is one finding, and limits that are none are named") {
  Osm osm;
  for (int k = 1; k <= 5; ++k)
    osm.lanelet(k, {0, 10.0 * k}, {50, 10.0 * k}, "<tag k='location' v='city'/><tag k='speed_limit' v='900 km/h'/>");
  auto const text = text_of(osm.map().diagnostics);
  CHECK(text.find("location=city is neither urban nor nonurban; urban was taken (5 of them)") != std::string::npos);
  CHECK(text.find("speed_limit=900 km/h is no speed") != std::string::npos);
  auto fast = straight(1, {0, 0}, {50, 0});
  fast.speed_limit = 250.0;
  CHECK(text_of(build_lanelet_map({fast}).diagnostics).find("its limit of 250 m/s is not between 0.1 and 200") !=
        std::string::npos);
}

TEST_CASE("a stop line without a place of the bounds' kind does not move the map") {
  std::string const way = "<way id='77'><nd ref='75'/><nd ref='76'/></way>\n";
  for (std::string const place : {"lat='0' lon='0'", "lat='48' lon='11'", ""}) {
    CAPTURE(place);
    Osm osm;
    osm.lanelet(1, {0, 0}, {50, 0}, "<member type='relation' role='regulatory_element' ref='30'/>");
    osm.nodes += "<node id='75' " + place + "/><node id='76' " + place + "/>";
    osm.others += way;
    osm.rule(30, "traffic_light", member("ref_line", 77));
    auto const made = osm.map();
    CHECK(lane_of(made, 1).length() == doctest::Approx(50.0).epsilon(1e-6));
    REQUIRE(lane_of(made, 1).signals.size() == 1);
    CHECK(lane_of(made, 1).signals[0].s == doctest::Approx(50.0));
    CHECK(
        text_of(made.diagnostics)
            .find("way 77 names node 75, which is not there, or has no place of the kind that bounds have (local_x") !=
        std::string::npos);
  }
}

TEST_CASE("walkways go both ways unless they say otherwise") {
  for (bool const one_way : {false, true}) {
    Osm osm;
    osm.lanelet(1, {0, 0}, {50, 0});
    osm.lanelet(2, {100, 0}, {50, 0});
    for (auto at = osm.others.find("v='road'"); at != std::string::npos; at = osm.others.find("v='road'"))
      osm.others.replace(at, 8, one_way ? "v='walkway'/><tag k='one_way:pedestrian' v='yes'" : "v='walkway'");
    auto const made = osm.map();
    auto const& first = lane_of(made, 1);
    if (one_way) {
      CHECK(first.successors.empty());
    } else {
      REQUIRE(first.successors.size() == 1);
      CHECK(first.successors[0] == lane_of(made, 2).opposite);
    }
  }
}

TEST_CASE("of several that claim a neighbour, the one that it names has it") {
  auto one = straight(1, {0, 0}, {50, 0}), two = straight(2, {0, -3.5}, {50, -3.5}),
       far = straight(3, {0, -3.6}, {50, -3.6});
  far.left_neighbor = 1;
  one.right_neighbor = 2;
  two.left_neighbor = 1;
  auto const made = build_lanelet_map({far, one, two});
  CHECK(lane_of(made, 1).right_neighbor == made.lanes.at(2));
  CHECK(text_of(made.diagnostics).find("lanelet 3: its neighbour 1 has another one on that side") != std::string::npos);
}

TEST_CASE("driving lanes are cut into lanelets where limits and permitted changes change, and priorities are kept") {
  std::string const lane_text =
      "<lane id=\"ID\" type=\"driving\"><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/>"
      "<roadMark sOffset=\"0\" type=\"broken\" weight=\"standard\" color=\"standard\" width=\"0.1\"/>"
      "<roadMark sOffset=\"60\" type=\"solid\" weight=\"standard\" color=\"standard\" width=\"0.1\" "
      "laneChange=\"none\"/>"
      "<speed sOffset=\"0\" max=\"10\"/><speed sOffset=\"30\" max=\"20\"/></lane>";
  std::string lanes;
  for (std::string const id : {"-1", "-2"}) {
    auto text = lane_text;
    lanes += text.replace(text.find("ID"), 2, id);
  }
  lanes += "<lane id=\"-3\" type=\"sidewalk\"><width sOffset=\"0\" a=\"2\" b=\"0\" c=\"0\" d=\"0\"/></lane>";
  auto const map = cambium::parse_opendrive(
                       "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/><road name=\"\" length=\"100\" id=\"1\" "
                       "junction=\"-1\"><planView><geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"100\"><line/>"
                       "</geometry></planView><lanes><laneSection s=\"0\"><center><lane id=\"0\" type=\"none\"/>"
                       "</center><right>" +
                       lanes + "</right></laneSection></lanes></road></OpenDRIVE>")
                       .map;
  auto const lanelets = cambium::map::lanelets_of(*map, 1);
  REQUIRE(lanelets.size() == 6);
  auto const made = build_lanelet_map(lanelets);
  CHECK_MESSAGE(made.diagnostics.empty(), text_of(made.diagnostics));
  for (auto const& lane : map->lanes())
    for (double const s : {15.0, 45.0, 80.0}) {
      if (!lane.drivable()) continue;
      auto const p = lane.path.pose(s).position();
      auto const copy = made.map->nearest_lane({p.x(), p.y(), 0.0}, 0.5);
      REQUIRE(copy);
      auto const& part = made.map->lane(copy->lane);
      CHECK(part.speed_limit_at(copy->s) == lane.speed_limit_at(s));
      CHECK(part.may_change_left(copy->s) == lane.may_change_left(s));
      CHECK(part.may_change_right(copy->s) == lane.may_change_right(s));
      CHECK(part.successors.empty() == (s == 80.0));
    }
  std::size_t priorities = 0;
  for (auto const& lanelet : cambium::map::lanelets_of(*support::own_map("roundabout.xodr")))
    priorities += lanelet.goes_before.size();
  CHECK(priorities > 0);
}

TEST_CASE("signs for ways inside a junction stand before it, lights with a line before it at their begin") {
  Osm osm;
  osm.crossing();
  osm.rule(30, "all_way_stop", "");
  osm.rule(31, "traffic_light", member("ref_line", osm.way({-1.75, -22}, {1.75, -22})));
  auto const made = osm.map();
  REQUIRE(lane_of(made, 11).signals.size() == 1);
  CHECK(lane_of(made, 11).signals[0].kind == cambium::map::SignalKind::stop);
  CHECK(lane_of(made, 11).signals[0].s == doctest::Approx(50.0));
  REQUIRE(lane_of(made, 12).signals.size() == 1);
  CHECK(lane_of(made, 12).signals[0].kind == cambium::map::SignalKind::light);
  CHECK(lane_of(made, 12).signals[0].s == doctest::Approx(0.0));
}

TEST_CASE("a map lies where its lanelets do, on the antimeridian, too") {
  for (double const longitude : {10.0, 180.0, -180.0}) {
    CAPTURE(longitude);
    Osm osm{longitude};
    osm.lanelet(1, {-200, 0}, {200, 0});
    osm.nodes += "<node id='5' lat='50' lon='-40'/>";  // nobody's
    auto const made = osm.map();
    CHECK_MESSAGE(made.diagnostics.empty(), text_of(made.diagnostics));
    CHECK(lane_of(made, 1).length() == doctest::Approx(400.0).epsilon(0.002));
    CHECK(lane_of(made, 1).path.pose(0.0).position().norm() < 201.0);
  }
  Osm mixed{10.0};
  mixed.lanelet(1, {-200, 0}, {200, 0});
  mixed.nodes.insert(mixed.nodes.rfind("</node>"), "<tag k='local_x' v='1'/><tag k='local_y' v='1'/>");
  std::vector<Diagnostic> found;
  auto const text = "<osm>\n" + mixed.nodes + mixed.others + "</osm>";
  (void)cambium::map::read_lanelet2(text, {}, "a.osm", found);
  CHECK(text_of(found).find("node 1001 has no local_x and local_y") != std::string::npos);
}
