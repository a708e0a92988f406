#include "cambium/viewer/map_picture.hpp"

#include <limits>
#include <string>

#include <doctest/doctest.h>

#include "cambium/map/opendrive.hpp"
#include "../map/road_text.hpp"
#include "../support/maps.hpp"
#include "../support/text.hpp"

using support::count;
using support::has;

namespace {

/// The value of the picture's attribute `name`.
double attribute(std::string const& picture, std::string const& name) {
  auto const at = picture.find(' ' + name + "=\"");
  REQUIRE(at != std::string::npos);
  return std::stod(picture.substr(at + name.size() + 3));
}

cambium::LoadedMap two_roads() {
  road_text::Road walked, far;
  walked.sections[0].lanes = {{.id = 1}, {.id = -1}, {.id = -2, .type = "sidewalk", .width = 2.0}};
  far.id = "far";
  far.x = 1000;
  far.sections[0].lanes = {{.id = -1, .direction = "both"}};
  return road_text::load(road_text::file({walked, far}));
}

}  // namespace

TEST_CASE("a picture's width is a number of pixels, and a map of nothing has a picture too") {
  auto const loaded = two_roads();
  for (double const width :
       {0.0, -5.0, 1e6, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    CAPTURE(width);
    CHECK_THROWS_AS((void)cambium::svg_map_picture(*loaded.map, {.width = width}), cambium::Error);
    CHECK_THROWS_AS((void)cambium::html_map_picture(*loaded.map, {.width = width}), cambium::Error);
  }
  auto const empty = cambium::svg_map_picture(cambium::Map({}));
  CHECK(attribute(empty, "width") == 1600.0);
  for (char const* wrong : {"nan", "inf", "null"}) CHECK_FALSE(has(empty, wrong));
}

TEST_CASE("the legend names what the picture has, and nothing else") {
  auto const loaded = two_roads();
  auto const all = cambium::svg_map_picture(*loaded.map);
  for (char const* entry : {"drivable lane", "lane of type sidewalk", "travel direction"})
    CHECK(count(all, std::string(">") + entry + "<") == 1);
  CHECK_FALSE(has(all, "of type median"));
  CHECK_FALSE(has(all, "in a junction"));
  CHECK_FALSE(has(all, ">leads to<"));
  auto const bare = cambium::svg_map_picture(*loaded.map, {.arrows = false, .links = false, .overlaps = false});
  for (char const* entry : {"travel direction", "leads to", "merges with another"}) CHECK_FALSE(has(bare, entry));
  CHECK_FALSE(has(cambium::svg_map_picture(*loaded.map, {.legend = false}), "class=\"legend\""));
  CHECK(count(cambium::html_map_picture(*loaded.map), "class=\"legend\"") == 1);
  auto const junction = cambium::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/intersection_4way.xodr");
  auto const crossing = cambium::svg_map_picture(*junction.map);
  CHECK(has(crossing, "shared area"));
  CHECK(has(crossing, ">leads to<"));
  CHECK(count(crossing, "<title>area shared by ") == 52);
}

TEST_CASE("the legend names those overlaps and ends that are drawn") {
  int shown = 0, left_out = 0;
  for (char const* const name : {"merging", "highway", "roundabout", "intersection_4way", "highway_exit"}) {
    CAPTURE(name);
    auto const map = support::own_map(std::string(name) + ".xodr");
    auto const picture = cambium::svg_map_picture(*map);
    for (auto const& [entry, drawn] : {std::pair("crosses another lane", ": crossing with "),
                                       {"merges with another", ": merge with "},
                                       {"splits from another", ": split with "},
                                       {"starts, no predecessor", " begins here<"},
                                       {"ends, no successor", " ends here<"}}) {
      CAPTURE(entry);
      bool const is_drawn = has(picture, drawn);
      CHECK(count(picture, std::string(">") + entry + "<") == (is_drawn ? 1 : 0));
      ++(is_drawn ? shown : left_out);
    }
  }
  CHECK(shown > 5);
  CHECK(left_out > 3);
}

TEST_CASE("a part shows the lanes in its box, and no more") {
  auto const loaded = two_roads();
  auto const part = cambium::svg_map_picture(*loaded.map, {.part = cambium::geometry::Box{990, -20, 1040, 20}});
  CHECK(has(part, "far:-1"));
  CHECK_FALSE(has(part, "1:1"));
  CHECK_FALSE(has(part, "sidewalk<"));
  CHECK(attribute(part, "data-west") == 990.0);
  CHECK(attribute(part, "data-north") == 20.0);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (auto const& box :
       {cambium::geometry::Box{}, cambium::geometry::Box{0, 0, 0, 5}, cambium::geometry::Box{0, 0, infinity, 5},
        cambium::geometry::Box{std::numeric_limits<double>::quiet_NaN(), 0, 1, 5}})
    CHECK_THROWS_AS((void)cambium::svg_map_picture(*loaded.map, {.part = box}), cambium::Error);
}

TEST_CASE("a lane for both directions has one label and two names") {
  auto const picture = cambium::svg_map_picture(*two_roads().map);
  CHECK(count(picture, ">far:-1</text>") == 1);
  CHECK(has(picture, "far:-1, forward begins here"));
  CHECK(has(picture, "far:-1, backward begins here"));
}

TEST_CASE("a long map is neither a line nor a tower") {
  for (double const heading : {0.0, 1.5707963267948966}) {
    road_text::Road road;
    road.heading = heading;
    road.length = 5000;
    auto const loaded = road_text::load(road_text::file({road}));
    auto const picture = cambium::svg_map_picture(*loaded.map, {.width = 800, .legend = false});
    CHECK(attribute(picture, "width") == 800.0);
    CHECK(attribute(picture, "height") == doctest::Approx(heading == 0.0 ? 32.0 : 3200.0).epsilon(0.01));
  }
}
