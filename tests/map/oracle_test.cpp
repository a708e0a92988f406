// Exact geometry on every map of the corpus is that of the reference evaluation, whose tables have a row for each lane
// at some stations.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include <doctest/doctest.h>

#include "cambium/core/error.hpp"
#include "cambium/map/lanes/road_lanes.hpp"
#include "cambium/map/road/road_surface.hpp"
#include "corpus_maps.hpp"
#include "lanes_by_hand.hpp"

using namespace by_hand;

namespace {

/// What is compared, and how far it may be off [m, rad].
struct Quantity {
  char const* name;
  double tolerance;
};
constexpr std::array quantities{Quantity{"reference position", 1e-6},
                                Quantity{"reference heading", 1e-8},
                                Quantity{"reference curvature", 1e-8},
                                Quantity{"elevation", 1e-5},
                                Quantity{"superelevation", 1e-6},
                                Quantity{"lane centre", 1e-6},
                                Quantity{"lane heading", 1e-8},
                                Quantity{"lane width", 1e-6},
                                Quantity{"lane t", 1e-6},
                                Quantity{"border", 1e-6},
                                Quantity{"sampled border", 0.01},
                                Quantity{"s of a place", 2e-6},
                                Quantity{"t of a place", 1e-6},
                                Quantity{"distance of a place", 1e-6}};

/// The largest differences of a map.
struct Differences {
  std::array<double, quantities.size()> largest{};
  int rows = 0, places = 0, unsampled = 0;

  void note(std::string const& name, double difference) {
    auto const at = std::find_if(quantities.begin(), quantities.end(), [&](auto const& q) { return q.name == name; });
    CHECK_MESSAGE(std::abs(difference) < at->tolerance, name);
    auto& worst = largest[static_cast<std::size_t>(at - quantities.begin())];
    worst = std::max(worst, std::abs(difference));
  }
};

/// Where only one road covers the point, its place is found on that road, in that lane.
void compare_place(Map const& map, std::vector<std::string> const& row, Differences& differences) {
  auto const number = [&row](std::size_t column) { return std::stod(row[column]); };
  if (row[23] != "1" || number(8) <= 0.5) return;  // of narrow ones a neighbour's centre may be as near
  auto const places = road_places(map, Point(number(5), number(6)));
  REQUIRE(!places.empty());
  CHECK(map.road(places.front().road).name == row[0]);
  CHECK(places.front().number == std::stoi(row[2]));
  differences.note("s of a place", places.front().s - number(1));
  differences.note("t of a place", places.front().t - number(9));
  differences.note("distance of a place", places.front().distance);
  ++differences.places;
}

void compare_row(Map const& map, std::vector<std::string> const& row, Differences& differences) {
  auto const number = [&row](std::size_t column) { return std::stod(row[column]); };
  auto const& road = map.find_road(row[0]);
  double const s = number(1);
  auto const reference = road.reference_line.at(s);
  differences.note("reference position", std::hypot(reference.x - number(14), reference.y - number(15)));
  differences.note("reference heading", geometry::angle_difference(reference.heading, number(16)));
  differences.note("reference curvature", reference.curvature - number(17));
  differences.note("elevation", road.elevation.value(s) + road.elevation_offset - number(18));
  differences.note("superelevation", road.superelevation.value(s) - number(19));
  auto const p = lane_point(road, s, std::stoi(row[2]));
  REQUIRE(p.has_value());
  differences.note("lane centre", std::hypot(p->center.x - number(5), p->center.y - number(6)));
  differences.note("lane heading", geometry::angle_difference(p->center.heading, number(7)));
  differences.note("lane width", p->width - number(8));
  differences.note("lane t", p->t - number(9));
  bool const is_sampled = number(8) >= 0.05;  // else there is no border to speak of, or the width counts as 0
  for (auto const& [t, column] : {std::pair(p->inner_t, 10u), {p->outer_t, 12u}}) {
    auto const at = offset_point(p->reference, {t, 0.0, 0.0});
    Point const border(number(column), number(column + 1));
    differences.note("border", (Point(at.x, at.y) - border).norm());
    if (!is_sampled) continue;
    try {
      auto const& lane = map.lane(map.find_lane(row[0], s, std::stoi(row[2])));
      differences.note("sampled border", std::min(distance(lane.left, border), distance(lane.right, border)));
    } catch (MapError const&) {
      ++differences.unsampled;
    }
  }
  compare_place(map, row, differences);
  ++differences.rows;
}

}  // namespace

TEST_CASE("reference lines, lanes, places and heights agree with the oracle on every map of the corpus") {
  int rows = 0, places = 0, banked = 0;
  bool const is_there = for_each_corpus_map([&](auto const& file, Map const& map) {
    Differences differences;
    for (auto const& row : corpus::table(file.parent_path() / "oracle" / file.stem().concat(".csv"))) {
      CAPTURE(row[0]);
      CAPTURE(row[1]);
      CAPTURE(row[2]);
      compare_row(map, row, differences);
      auto const axes = surface_at(map.find_road(row[0]), std::stod(row[1]), 0.0).axes;
      CHECK((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm() < 1e-12);
      banked += std::stod(row[19]) != 0.0;
    }
    std::string text = file.stem().string() + ": " + std::to_string(differences.rows) + " rows, largest differences";
    for (std::size_t i = 0; i < quantities.size(); ++i)
      text += std::string(", ") + quantities[i].name + " " + cambium::detail::rounded_text(differences.largest[i]);
    MESSAGE(text);
    CHECK(differences.unsampled <= 4);  // borders, in lane sections shorter than a micrometre
    rows += differences.rows;
    places += differences.places;
  });
  if (!is_there) return;
  CHECK(rows > 5500);
  CHECK(places > 2000);
  CHECK(banked > 90);
}
