#include "cambium/map/map.hpp"

#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "lanes_by_hand.hpp"
#include "road_text.hpp"
#include "../support/error_of.hpp"

namespace {

using cambium::geometry::Box;

/// What the map says where it has no such lane.
std::string refusal(cambium::Map const& map, double s, int number) {
  return support::error_of([&] { (void)map.find_lane("1", s, number); });
}

}  // namespace

TEST_CASE("a map's bounds hold all its lanes, of any type, and nothing more") {
  road_text::Road road{
      .x = 20, .y = -5, .sections = {{.lanes = {{.id = 1}, {.id = -1}, {.id = -2, .type = "sidewalk", .width = 2.0}}}}};
  auto const loaded = road_text::load(road_text::file({road}));
  auto const& box = loaded.map->bounds();
  CHECK(box.min_x == doctest::Approx(20));
  CHECK(box.max_x == doctest::Approx(120));
  CHECK(box.min_y == doctest::Approx(-10.5));
  CHECK(box.max_y == doctest::Approx(-1.5));
  CHECK(loaded.map->lanes_in(box).size() == loaded.map->lanes().size());
  CHECK(cambium::Map({}).bounds() == Box{});
}

TEST_CASE("the bounds of curved lanes hold every point of their borders") {
  by_hand::Numbers random{7};
  std::vector<cambium::map::Lane> lanes;
  for (int i = 0; i < 30; ++i)
    by_hand::add_lane(
        lanes, by_hand::arc({random(-90, 90), random(-90, 90), random(-3, 3)}, random(-0.05, 0.05), random(5, 60)));
  cambium::Map::Parts parts;
  parts.lanes = lanes;
  cambium::Map const map(std::move(parts));
  for (auto const& lane : lanes)
    for (auto const* line : {&lane.left, &lane.right, &lane.path})
      for (auto const& p : line->points()) CHECK(map.bounds().contains(p));
  Box const smaller = map.bounds().grown(-1e-6);
  auto const sticks_out = [&](cambium::geometry::Point const& p) { return !smaller.contains(p); };
  int out = 0;
  for (auto const& lane : lanes)
    for (auto const* line : {&lane.left, &lane.right, &lane.path})
      for (auto const& p : line->points()) out += sticks_out(p);
  CHECK(out >= 4);
}

TEST_CASE("the error for a missing lane says where it is") {
  road_text::Road road{.sections = {{20, {{.id = 1}, {.id = -1}}},
                                    {30, {{.id = -1}, {.id = -2}}},
                                    {50, {{.id = -1}}},
                                    {70, {{.id = -1}, {.id = -2}}}}};
  auto const loaded = road_text::load(road_text::file({road}));
  auto const& map = *loaded.map;
  REQUIRE(map.roads()[0].sections.size() == 4);
  double const begin = map.roads()[0].sections[0].begin;
  CAPTURE(begin);
  CHECK(refusal(map, 60, -2) ==
        "road 1, s 60: there is no lane -2; the road has it from 30 to 50 m, from 70 to 100 m; "
        "ask for one of -1");
  CHECK(refusal(map, 40, 1).find("there is no lane 1; the road has it from") != std::string::npos);
  CHECK(refusal(map, 40, 7) == "road 1, s 40: there is no lane 7, nor elsewhere on the road; ask for one of -1, -2");
  CHECK(refusal(map, 40, 0).find("there is no lane 0") != std::string::npos);
  CHECK(refusal(map, -1, -1).find("it lies before the road's lanes; give a place from s ") != std::string::npos);
  CHECK(refusal(map, 101, -1).find("the road is 100 m long; give a place from s ") != std::string::npos);
  CHECK(refusal(map, std::numeric_limits<double>::quiet_NaN(), -1).find("it is no number") != std::string::npos);
  CHECK(refusal(map, 100, -1) == "no error");
}
