// CommonRoad's networks against tables of who follows whom and lies beside whom, counted by others.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "cambium/core/text.hpp"
#include "cambium/scenario/dataset/common_road.hpp"

#include "../support/corpus.hpp"
#include "../support/named_by.hpp"

using namespace cambium;

namespace {

/// The parts of "1|2".
std::set<std::string> ids_in(std::string const& text) {
  std::set<std::string> ids;
  for (auto const part : detail::split(text, "|"))
    if (!part.empty()) ids.emplace(part);
  return ids;
}

}  // namespace

TEST_CASE("lanelets of CommonRoad follow each other and lie beside each other as counted, or a finding names them") {
  for (std::string const name : {"DEU_Test-1_1_T-1", "ZAM-Ramp-1_1-T-1", "ZAM_Over-1_1", "ZAM_Tjunction-1_42_T-1",
                                 "ZAM_Tutorial-1_2_T-1", "test_reading_all", "test_reading_lanelets"}) {
    auto const table = corpus::find("lanelet2/oracle/" + name + ".csv"),
               file = corpus::find("scenarios/commonroad/" + name + ".xml");
    if (!table || !file) return;
    CAPTURE(name);
    auto const traffic = load_common_road(file->string());
    std::map<LaneId, std::string> names;
    for (auto const& [id, lane] : traffic.lanes) {
      names[lane] = std::to_string(id);
      if (auto const back = traffic.map->lane(lane).opposite; is_valid(back)) names[back] = "-" + names[lane];
    }
    auto const named = support::named_by(traffic.diagnostics);
    for (auto const& row : corpus::table(*table)) {
      CAPTURE(row[0]);
      auto const& lane = traffic.map->lane(traffic.lanes.at(std::stoll(row[0])));
      std::string successors;
      if (!is_valid(lane.merges_into))
        for (auto const next : lane.successors) successors += (successors.empty() ? "" : "|") + names.at(next);
      auto const beside = [&](LaneId id) { return is_valid(id) ? names.at(id) : std::string(); };
      // Where the file's word differs, a finding is about that link.
      auto const agree = [&](std::string const& ours, std::string const& theirs) {
        std::set<std::string> a = ids_in(ours), b = ids_in(theirs), differing;
        std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(),
                                      std::inserter(differing, differing.end()));
        return std::all_of(differing.begin(), differing.end(), [&](std::string const& id) {
          return named.contains({row[0], id});
        });
      };
      CHECK(agree(successors, row[2]));
      CHECK(agree(beside(lane.left_neighbor), row[6] == "same" ? row[5] : ""));
      CHECK(agree(beside(lane.right_neighbor), row[8] == "same" ? row[7] : ""));
      CHECK(successors == row[4]);  // where the bounds meet
      if (is_valid(lane.left_neighbor) && row[9] != "unsaid") CHECK(!lane.left_changes.empty() == (row[9] == "yes"));
      if (is_valid(lane.right_neighbor) && row[10] != "unsaid")
        CHECK(!lane.right_changes.empty() == (row[10] == "yes"));
    }
  }
}

TEST_CASE(
    "a lane that forks inside an intersection has all successors; lanes in a tight bend turn as their road does") {
  auto const fork = corpus::find("cases/cr_fork_inside_intersection.xml"),
             tee = corpus::find("cases/cr_tight_tee_short.xml"),
             bend = corpus::find("cases/cr_six_lanes_bend_right_02.xml");
  if (!fork || !tee || !bend) return;
  for (auto const& file : {*fork, *tee}) {
    CAPTURE(file.string());
    auto const traffic = load_common_road(file.string());
    std::size_t links = 0, named = 0;
    for (auto const& lanelet : traffic.lanelets) {
      named += lanelet.successors.size();
      links += traffic.map->lane(traffic.lanes.at(lanelet.id)).successors.size();
    }
    CHECK(links == named);
    CHECK(traffic.diagnostics.empty());
  }
  auto const bent = load_common_road(bend->string());
  CHECK(bent.map->lanes().size() == 6);
  double road = 0.0;
  for (auto const& lane : bent.map->lanes()) {
    double turn = 0.0;
    for (auto const& segment : lane.path.segments()) turn += std::abs(segment.curvature) * segment.length;
    if (road == 0.0) road = turn;
    CHECK(turn == doctest::Approx(road).epsilon(0.05));
  }
}
