// What real files hold that readers stumble over, each trap in the smallest file that has it, with what the map then
// is.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../support/allocations.hpp"
#include "../support/map_faults.hpp"
#include "cambium/map/lanes/lane_network.hpp"
#include "cambium/map/opendrive.hpp"
#include "road_text.hpp"
#include "../support/maps.hpp"

namespace {

using cambium::LaneId;
using cambium::Severity;
using road_text::connection;
using road_text::count;
using road_text::file;
using road_text::geometry;
using road_text::junction;
using road_text::lane_at;
using road_text::leads;
using road_text::number;
using road_text::Road;
using road_text::to_end;
using road_text::to_junction;
using road_text::to_start;
using road_text::width;

std::string lane(int id, std::string const& content) {
  return "<lane id=\"" + std::to_string(id) + "\" type=\"driving\">" + content + "</lane>";
}

std::string section(double s, std::string const& right, std::string const& center = "") {
  return "<laneSection s=\"" + number(s) + "\"><center><lane id=\"0\" type=\"none\">" + center +
         "</lane></center><right>" + right + "</right></laneSection>";
}

/// A file of one road.
std::string one_road(double length, std::string const& geometries, std::string const& lanes,
                     std::string const& others = "") {
  return "<OpenDRIVE><header revMajor=\"1\" revMinor=\"4\"/><road id=\"1\" length=\"" + number(length) +
         "\" junction=\"-1\"><planView>" + geometries + "</planView><lanes>" + lanes + "</lanes>" + others +
         "</road></OpenDRIVE>";
}

std::string const one_lane = section(0, lane(-1, width(0, 3)));

/// The map of a text, free of faults; and that it has no finding, where `is_clean`.
cambium::LoadedMap load(std::string const& text, bool is_clean = true) {
  auto loaded = road_text::load(text);
  CHECK(map_faults::first_fault(*loaded.map) == "");
  if (is_clean) CHECK_MESSAGE(loaded.diagnostics.empty(), to_string(loaded.diagnostics.front()));
  return loaded;
}

bool is_near(cambium::geometry::Pose const& pose, double x, double y, double within = 1e-6) {
  return std::hypot(pose.x - x, pose.y - y) < within;
}

}  // namespace

TEST_CASE("geometries down to 1e-15 m harm nothing, wherever they stand") {
  std::string geometries = geometry(0, 0, 0, 0, 1e-15) + geometry(1e-15, 0, 0, 0, 50);
  geometries += geometry(50, 50, 0, 0, 1e-4, "<arc curvature=\"0.01\"/>");
  geometries += geometry(50.0001, 50.0001, 0, 0, 1e-9, "<spiral curvStart=\"0.1\" curvEnd=\"-0.1\"/>");
  geometries += geometry(50.000100001, 50.0001, 0, 0, 50) + geometry(100.000100001, 100.0001, 0, 0, 1e-15);
  auto const loaded = load(one_road(100.0001, geometries, one_lane), false);
  CHECK(count(loaded, Severity::warning) == 1);
  CHECK(count(loaded, Severity::warning, "shorter than a millionth of a millimetre (and 1 more)") == 1);
  auto const& l = lane_at(loaded, {"1", 10.0, -1});
  CHECK(l.length() == doctest::Approx(100.0001).epsilon(1e-7));
  CHECK(is_near(l.path.end_pose(), 100.0001, -1.5, 1e-5));
}

TEST_CASE("sections down to a millimetre are lanes of their own, shorter ones are passed over") {
  auto const linked = [](double s, bool before, bool behind) {
    return section(s, lane(-1, std::string("<link>") + (before ? "<predecessor id=\"-1\"/>" : "") +
                                   (behind ? "<successor id=\"-1\"/>" : "") + "</link>" + width(0, 3)));
  };
  auto const loaded = load(one_road(100, geometry(0, 0, 0, 0, 100),
                                    linked(0, false, true) + linked(40, true, true) + linked(40.002, true, true) +
                                        linked(40.002 + 1e-7, true, true) + linked(99.995, true, false)),
                           false);
  CHECK(count(loaded, Severity::warning) == 0);
  auto const& map = *loaded.map;
  double total = 0.0;
  for (auto const& l : map.lanes()) total += l.length();
  CHECK(map.lanes().size() >= 3);
  CHECK(total == doctest::Approx(100.0).epsilon(1e-6));
  auto const route = map.shortest_route(map.find_lane("1", 0.0, -1), map.find_lane("1", 99.999, -1));
  CHECK(route.has_value());
  CHECK(map.nearest_lane({40.001, -1.5, 0.0}).has_value());
}

TEST_CASE("a section that speaks for one side is a lane section of both, which goes on on the other side") {
  auto const loaded = load(one_road(
      100, geometry(0, 0, 0, 0, 100),
      "<laneSection s=\"0\"><left>" + lane(1, width(0, 3)) + "</left><center><lane id=\"0\"/></center><right>" +
          lane(-1, "<link><successor id=\"-1\"/></link>" + width(0, 3)) +
          "</right></laneSection><laneSection s=\"60\" singleSide=\"true\"><center><lane id=\"0\"/></center>"
          "<right>" +
          lane(-1, "<link><predecessor id=\"-1\"/></link>" + width(0, 3)) + "</right></laneSection>"));
  CHECK(loaded.map->lanes().size() == 4);
  CHECK(leads(loaded, {"1", 80.0, 1}, {"1", 20.0, 1}));
  CHECK(leads(loaded, {"1", 20.0, -1}, {"1", 80.0, -1}));
}

TEST_CASE("geometries whose s has gaps of less than a millimetre are one line") {
  auto const loaded = load(one_road(100, geometry(0, 0, 0, 0, 49.99993) + geometry(50, 50, 0, 0, 50), one_lane));
  CHECK(lane_at(loaded, {"1", 0.0, -1}).length() == doctest::Approx(100.0).epsilon(1e-9));
  for (double const s : {49.99992, 49.99996, 50.0, 50.00001})
    CHECK(cambium::map::point_at(loaded.map->roads()[0], s, 0.0).x == doctest::Approx(s).epsilon(1e-12));
}

TEST_CASE("a gap in the reference line is reported and kept") {
  auto const loaded = load(one_road(100, geometry(0, 0, 0, 0, 50) + geometry(50, 50, 0.008, 0, 50), one_lane), false);
  CHECK(count(loaded, Severity::warning, "0.008 m off the end") == 1);
  CHECK(is_near(loaded.map->lanes()[0].path.end_pose(), 100, -1.492));
}

TEST_CASE("a kink in the reference line has one direction on either side") {
  auto const loaded = load(one_road(100, geometry(0, 0, 0, 0, 50) + geometry(50, 50, 0, 1.2, 50), one_lane), false);
  CHECK(count(loaded, Severity::warning, "0 m and 1.2 rad off") == 1);
  auto const& line = loaded.map->roads()[0].reference_line;
  CHECK(line.at(50.0 - 1e-9).heading == 0.0);
  CHECK(line.at(50.0).heading == 1.2);
  auto const& l = loaded.map->lanes()[0];
  CHECK(is_near(l.path.end_pose(), 50 + 50 * std::cos(1.2) + 1.5 * std::sin(1.2),
                50 * std::sin(1.2) - 1.5 * std::cos(1.2)));
  CHECK(l.path.pose(40.0).heading == doctest::Approx(0.0));
  CHECK(l.path.pose(l.length() - 10.0).heading == doctest::Approx(1.2));
}

TEST_CASE("a paramPoly3 of another length than its attribute says is stretched along to that") {
  auto const text = [](double length) {
    return one_road(length,
                    geometry(0, 0, 0, 0, length,
                             "<paramPoly3 pRange=\"normalized\" aU=\"0\" bU=\"100\" cU=\"0\" dU=\"0\" aV=\"0\" "
                             "bV=\"0\" cV=\"0\" dV=\"0\"/>"),
                    one_lane);
  };
  (void)load(text(100.05));  // half a thousandth
  auto const loaded = load(text(125), false);
  CHECK(count(loaded, Severity::warning, "100 m long, its length attribute says 125 m") == 1);
  CHECK(cambium::map::point_at(loaded.map->roads()[0], 62.5, 0.0).x == doctest::Approx(50.0).epsilon(1e-9));
  CHECK(loaded.map->lanes()[0].length() == doctest::Approx(100.0).epsilon(1e-6));
  CHECK(loaded.map->lanes()[0].road_end == 125.0);
}

TEST_CASE("a width below 0 is a lane without width, and can be asked for as it is written") {
  auto const loaded =
      load(one_road(100, geometry(0, 0, 0, 0, 100), section(0, lane(-1, width(0, 3)) + lane(-2, width(0, 2, -0.04)))),
           false);
  CHECK(count(loaded, Severity::warning, "its width falls to -2 m") == 1);
  auto const& l = lane_at(loaded, {"1", 0.0, -2});
  for (auto const& w : l.widths) CHECK((w.left + w.right) >= -1e-9);
  CHECK(lane_point(loaded.map->roads()[0], 75.0, -2)->width == doctest::Approx(-1.0));
}

TEST_CASE("widths of lane 0 are ignored") {
  auto const loaded = load(one_road(100, geometry(0, 0, 0, 0, 100), section(0, lane(-1, width(0, 3)), width(0, 5))));
  CHECK(loaded.map->lanes().size() == 1);
  CHECK(is_near(loaded.map->lanes()[0].path.end_pose(), 100, -1.5));
}

TEST_CASE("lanes on either side of a gap in the ids are neighbours") {
  for (int const far : {-4, -1000000000}) {
    auto const loaded = load(
        one_road(100, geometry(0, 0, 0, 0, 100), section(0, lane(-1, width(0, 3)) + lane(far, width(0, 3)))), false);
    CHECK(count(loaded, Severity::warning, "no lane between -1") == 1);
    auto const &inner = lane_at(loaded, {"1", 0.0, -1}), &outer = lane_at(loaded, {"1", 0.0, far});
    CHECK(inner.right_neighbor == outer.id);
    CHECK(inner.may_change_right(50.0));
    CHECK(outer.may_change_left(50.0));
    CHECK(is_near(outer.path.end_pose(), 100, -4.5));
  }
}

TEST_CASE("a lane with several predecessors is entered from each of them") {
  Road road{.sections = {{0.0, {{-1, {}, {-1}}, {-2, {}, {-1}}}}, {50.0, {{-1, {-1, -2}, {}}}}}};
  auto const loaded = load(file({road}), false);
  CHECK(leads(loaded, {"1", 10.0, -1}, {"1", 60.0, -1}));
  CHECK(leads(loaded, {"1", 10.0, -2}, {"1", 60.0, -1}));
  CHECK(lane_at(loaded, {"1", 60.0, -1}).predecessors.size() == 2);
}

TEST_CASE("a contact point that contradicts the places of the roads is reported; the link counts as written") {
  Road first{.id = "1", .behind = to_end("2"), .sections = {{0.0, {{-1, {}, {1}}}}}};
  Road second{.id = "2", .x = 100.0, .before = to_start("1"), .sections = {{0.0, {{-1}, {1, {-1}, {}}}}}};
  auto const loaded = load(file({first, second}), false);
  CHECK(count(loaded, Severity::warning) > 0);
  CHECK_FALSE(leads(loaded, {"1", 10.0, -1}, {"2", 10.0, -1}));
}

TEST_CASE("a right lane's border that is given as a magnitude lies to the right") {
  auto const border = [](double t) {
    return "<border sOffset=\"0\" a=\"" + number(t) + "\" b=\"0\" c=\"0\" d=\"0\"/>";
  };
  for (double const sign : {1.0, -1.0}) {
    auto const loaded = load(
        one_road(100, geometry(0, 0, 0, 0, 100), section(0, lane(-1, border(3 * sign)) + lane(-2, border(5 * sign)))));
    CHECK(is_near(lane_at(loaded, {"1", 0.0, -1}).path.end_pose(), 100, -1.5));
    CHECK(is_near(lane_at(loaded, {"1", 0.0, -2}).path.end_pose(), 100, -4));
    CHECK(lane_point(loaded.map->roads()[0], 50.0, -2)->t == doctest::Approx(-4.0));
  }
}

TEST_CASE("a header without attributes, and words of any revision in any other, are read") {
  Road road{.sections = {{.lanes = {{1}, {.id = -1, .direction = "reversed"}}}}};
  auto text = file({road});
  for (auto const* header : {"<header/>", "<header revMajor=\"1\" revMinor=\"1\"/>", "<header revMinor=\"99\"/>"}) {
    auto changed = text;
    changed.replace(changed.find("<header"), changed.find("/>") + 2 - changed.find("<header"), header);
    auto const loaded = load(changed);
    CHECK_FALSE(lane_at(loaded, {"1", 0.0, -1}).along_road);
  }
}

TEST_CASE("road marks and signals beyond the road's end count for nothing, signs with a finding") {
  auto const mark = [](double s, char const* change) {
    return "<roadMark sOffset=\"" + number(s) + "\" type=\"solid\" laneChange=\"" + change + "\"/>";
  };
  auto const loaded =
      load(one_road(100, geometry(0, 0, 0, 0, 100),
                    section(0, lane(-1, width(0, 3) + mark(0, "both") + mark(130, "none")) + lane(-2, width(0, 3))),
                    "<signals><signal s=\"500\" t=\"-4\" id=\"7\" name=\"\" dynamic=\"no\" orientation=\"+\" "
                    "type=\"206\"/></signals>"),
           false);
  REQUIRE(loaded.diagnostics.size() == 1);
  CHECK(to_string(loaded.diagnostics[0]).find("road 1, signal 7: it counts for no lane") != std::string::npos);
  auto const& l = lane_at(loaded, {"1", 0.0, -1});
  CHECK(l.right_changes == std::vector{cambium::map::PathStretch{0.0, l.length()}});
}

TEST_CASE("a road that touches a junction with both ends is left and entered at either") {
  // A ring: road 1 leaves the junction to the right and comes back to it from the left, where road 2 closes it.
  double const half = std::acos(-1.0) * 50.0;
  Road arc{.id = "1", .length = half, .before = to_junction("9"), .behind = to_junction("9"), .curvature = 0.02};
  arc.sections[0].lanes = {{-1}};
  Road back{.id = "2",
            .x = 0.0,
            .y = 100.0,
            .heading = std::acos(-1.0),
            .length = half,
            .before = to_end("1"),
            .behind = to_start("1"),
            .curvature = 0.02,
            .junction = "9"};
  back.sections[0].lanes = {{-1, {-1}, {-1}}};
  auto const loaded = load(file({arc, back}, junction("9", connection("1", "2", "start", -1, -1))), false);
  CHECK(count(loaded, Severity::warning) == 0);
  CHECK(leads(loaded, {"1", 10.0, -1}, {"2", 10.0, -1}));
  CHECK(leads(loaded, {"2", 10.0, -1}, {"1", 10.0, -1}));
  auto const ring = loaded.map->find_lane("1", 0.0, -1);
  CHECK(loaded.map->shortest_route({ring, 20.0}, {ring, 10.0}).has_value());
}

TEST_CASE("on and under a bridge both lanes are found, the one with the vehicle's direction first") {
  Road below{.id = "1"};
  Road above{.id = "2", .x = 50.0, .y = -50.0, .heading = std::acos(0.0)};
  auto text = file({below, above});
  auto const at = text.rfind("<lanes>");
  text.insert(at, "<elevationProfile><elevation s=\"0\" a=\"6\" b=\"0\" c=\"0\" d=\"0\"/></elevationProfile>");
  auto const loaded = load(text);
  auto const& map = *loaded.map;
  auto const hits = map.lanes_near({51.0, -1.0}, 0.0);
  CHECK(hits.size() == 2);
  CHECK(map.nearest_lane({51.0, -1.0, 0.0})->lane == map.find_lane("1", 0.0, -1));
  CHECK(map.nearest_lane({51.0, -1.0, std::acos(0.0)})->lane == map.find_lane("2", 0.0, -1));
  for (auto const& l : map.lanes()) CHECK(l.overlaps.empty());
}

namespace {

/// A straight road of 3 km per thousand of what is asked for many times.
struct Many {
  int geometries = 1, sections = 1, widths = 1;

  [[nodiscard]] std::string text() const {
    double const length = 3.0 * std::max({geometries, sections, widths});
    std::string plan, lanes, records;
    for (int i = 0; i < geometries; ++i) {
      double const s = length * i / geometries;
      plan += geometry(s, s, 0, 0, length / geometries);
    }
    for (int i = 0; i < widths; ++i) records += width(length * i / widths, i % 2 == 0 ? 3.0 : 3.1);
    for (int i = 0; i < sections; ++i)
      lanes += section(length * i / sections, lane(-1, "<link><predecessor id=\"-1\"/><successor id=\"-1\"/></link>" +
                                                           (widths > 1 ? records : width(0, 3))));
    return one_road(length, plan, lanes);
  }
};

}  // namespace

TEST_CASE("three thousand geometries, sections or widths are loaded, with about twice the allocations of half") {
  for (auto many : {Many{.geometries = 1500}, Many{.sections = 1500}, Many{.widths = 1500}}) {
    auto const half = many.text();
    for (int* n : {&many.geometries, &many.sections, &many.widths})
      if (*n > 1) *n *= 2;
    auto const whole = many.text();
    auto const allocated_by = [](std::string const& text) {
      auto const before = support::allocations();
      auto const loaded = load(text, false);
      return support::allocations() - before;
    };
    auto const few = allocated_by(half), all = allocated_by(whole);
    CHECK(static_cast<double>(all) <= 2.2 * static_cast<double>(few));  // 0 where they are not counted
    auto const loaded = load(whole, false);
    CHECK(loaded.map->lanes().size() == static_cast<std::size_t>(many.sections));
    double length = 0.0;
    for (auto const& l : loaded.map->lanes()) length += l.length();
    CHECK(length > 8999.0);
  }
}
