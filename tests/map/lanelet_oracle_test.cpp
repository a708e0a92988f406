// Lanelet2 maps against tables of who follows whom, lies beside whom and may change lanes, counted by others.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "cambium/map/lanelet/lanelet2.hpp"

#include "../support/corpus.hpp"

using cambium::is_valid;
using cambium::LaneId;

namespace {

std::set<std::string> words_of(std::string const& cell) {
  std::set<std::string> words;
  for (std::size_t begin = 0; begin < cell.size();) {
    std::size_t const end = std::min(cell.find('|', begin), cell.size());
    words.insert(cell.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

/// Lanes by the ids of their lanelets, with a minus where they are driven backwards.
struct Named {
  cambium::map::LaneletMap made;
  std::map<LaneId, std::string> names{};
  std::map<std::string, LaneId> lanes{};

  explicit Named(std::string const& file) : made(cambium::load_lanelet2(file)) {
    for (auto const& [id, lane] : made.lanes) {
      enter(lane, std::to_string(id));
      if (auto const back = made.map->lane(lane).opposite; is_valid(back)) enter(back, std::to_string(-id));
    }
  }
  void enter(LaneId lane, std::string const& name) {
    names[lane] = name;
    lanes[name] = lane;
  }
  [[nodiscard]] std::string name(LaneId lane) const { return is_valid(lane) ? names.at(lane) : ""; }
};

}  // namespace

TEST_CASE("lanelets follow each other, lie beside each other, permit changes and limit speeds as counted") {
  for (std::string const name : {"mapping_example", "autoware_intersection", "four_track_highway"}) {
    auto const table = corpus::find("lanelet2/oracle/" + name + ".csv"),
               file = corpus::find("lanelet2/" + name + ".osm");
    if (!table || !file) return;
    CAPTURE(name);
    Named const map(file->string());
    int lanes = 0, links = 0;
    for (auto const& row : corpus::table(*table)) {
      if (row[1] == "rail" || (row[2] != "1" && row[0][0] == '-')) continue;
      CAPTURE(row[0]);
      REQUIRE(map.lanes.contains(row[0]));
      auto const& lane = map.made.map->lane(map.lanes.at(row[0]));
      CHECK(lane.drivable() == (row[2] == "1"));
      std::set<std::string> successors;
      if (!is_valid(lane.merges_into))
        for (auto const next : lane.successors) successors.insert(map.name(next));
      if (!lane.drivable()) {  // footways and bicycle lanes go on as anything may go on
        CHECK(successors == words_of(row[15]));
        continue;
      }
      CHECK(successors == words_of(row[5]));
      CHECK(map.name(lane.left_neighbor) == row[7]);
      CHECK(map.name(lane.right_neighbor) == row[8]);
      CHECK(!lane.left_changes.empty() == (row[11] == "1"));
      CHECK(!lane.right_changes.empty() == (row[12] == "1"));
      CHECK(lane.speed_limit_at(1.0) == doctest::Approx(std::strtod(row[18].c_str(), nullptr) / 3.6));
      ++lanes;
      links += static_cast<int>(successors.size());
    }
    CHECK(lanes > 30);
    CHECK(links > 20);
  }
}

TEST_CASE("no lane of a Lanelet2 map turns by more than its bounds do") {
  for (std::string const name : {"mapping_example", "autoware_intersection", "four_track_highway"}) {
    auto const file = corpus::find("lanelet2/" + name + ".osm");
    if (!file) return;
    CAPTURE(name);
    Named const map(file->string());
    auto const turning = [](std::vector<double> const& headings) {
      double sum = 0.0;
      for (std::size_t i = 1; i < headings.size(); ++i)
        sum += std::abs(cambium::geometry::angle_difference(headings[i], headings[i - 1]));
      return sum;
    };
    for (auto const& lane : map.made.map->lanes()) {
      CAPTURE(map.name(lane.id));
      std::vector<double> path;
      for (auto const& sample : lane.path.samples()) path.push_back(sample.heading);
      double bounds = 0.0;
      for (auto const* bound : {&lane.left, &lane.right}) {
        std::vector<double> headings;
        for (auto const& segment : bound->segments()) headings.push_back(segment.heading);
        bounds = std::max(bounds, turning(headings));
      }
      if (!is_valid(lane.merges_into)) CHECK(turning(path) < bounds + 0.5);
    }
  }
}
