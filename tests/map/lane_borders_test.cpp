// Sampled lanes against the oracle's exact border points, on every map of the corpus.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "cambium/map/opendrive.hpp"
#include "../support/corpus.hpp"
#include "../support/maps.hpp"

namespace {

namespace cb = cambium;
using cb::geometry::Point;

double distance(cb::geometry::Line const& line, Point const& p) {
  if (line.empty()) return INFINITY;
  auto const foot = line.project(p);
  return std::hypot(foot.lateral, std::max({-foot.s, foot.s - line.length(), 0.0}));
}

struct Comparison {
  int rows = 0, left_out = 0;
  double largest = 0.0;  ///< [m]
};

Comparison compare(std::filesystem::path const& file) {
  Comparison result;
  auto const map = cambium::load_opendrive(file.string()).map;
  for (auto const& row : corpus::table(file.parent_path() / "oracle" / file.stem().concat(".csv"))) {
    if (std::stod(row[8]) < 0.05) continue;  // no border to speak of, or a negative width, which counts as 0
    cb::LaneId id;
    try {
      id = map->find_lane(row[0], std::stod(row[1]), std::stoi(row[2]));
    } catch (cb::MapError const&) {
      ++result.left_out;
      continue;
    }
    auto const& lane = map->lane(id);
    for (auto const column : {std::size_t{10}, std::size_t{12}}) {
      Point const p(std::stod(row[column]), std::stod(row[column + 1]));
      result.largest = std::max(result.largest, std::min(distance(lane.left, p), distance(lane.right, p)));
    }
    ++result.rows;
  }
  return result;
}

}  // namespace

TEST_CASE("the borders of sampled lanes pass within a centimetre of the exact ones on every map of the corpus") {
  auto const folder = corpus::find("opendrive");
  if (!folder) return;
  int rows = 0;
  for (auto const& file : corpus::maps(*folder)) {
    auto const c = compare(file);
    MESSAGE(file.stem().string() << ": " << c.rows << " rows (" << c.left_out << " left out), largest distance "
                                 << c.largest << " m");
    CAPTURE(file.stem().string());
    CHECK(c.largest < 0.01);
    CHECK(c.left_out <= 2);  // in lane sections shorter than a micrometre
    rows += c.rows;
  }
  CHECK(rows > 4500);
}
