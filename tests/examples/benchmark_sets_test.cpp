// The sets that ship beside the default one.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "cambium/benchmark/result_store.hpp"
#include "cambium/core/text.hpp"
#include "program.hpp"

using namespace program;

TEST_CASE(
    "the lane change experiment is a set: a planner that changes lanes succeeds, a driver who keeps his does not") {
  Program const program("benchmark");
  browser::TemporaryFolder const folder;
  program.output({"--set", "lane_change", "--behaviors", "idm,frenet", "--scenarios", "40", "--db",
                  folder.file("lane_change.db"), "--json", folder.file("rows.json")});
  std::set<std::string> sets;
  for (auto const& row : nlohmann::json::parse(content_of(folder.file("rows.json")))) {
    CAPTURE(row.dump());
    sets.insert(std::string(row["set"]));
    CHECK(row["scenarios"] == 40);
    CHECK(row["error"] == 0.0);
    for (char const* name : {"prediction_error_1s", "prediction_error_3s", "prediction_error_5s"})
      CHECK(row[name].is_number() == (row["behavior"] == "frenet"));  // idm expects nothing
    CHECK(row["prediction_brier"].is_null());                         // and frenet one course only
    if (row["behavior"] == "idm")
      CHECK(row["success"] == 0.0);
    else
      CHECK(row["success"] > 0.0);
  }
  CHECK(sets == std::set<std::string>{"lane_change_0", "lane_change_20", "lane_change_40", "lane_change_80"});
}

TEST_CASE("planners turn left before oncoming traffic that yields, and before such that does not") {
  Program const program("benchmark");
  browser::TemporaryFolder const folder;
  program.output({"--set", "left_turn", "--behaviors", "idm,policy_tree,frenet", "--scenarios", "6", "--replays",
                  "none", "--db", folder.file("left_turn.db"), "--json", folder.file("rows.json")});
  auto const rows = nlohmann::json::parse(content_of(folder.file("rows.json")));
  CHECK(rows.size() == 6);
  int hit = 0;
  for (auto const& row : rows) {
    CAPTURE(row.dump());
    if (row["behavior"] == "idm")
      hit += row["collision"] > 0.0;  // it gives way to nobody
    else
      CHECK(row["success"] == 1.0);
  }
  CHECK(hit > 0);
}

TEST_CASE("the exam has twenty situations among five populations, and other scenarios to train on") {
  Program const program("benchmark");
  browser::TemporaryFolder const folder;
  std::set<std::string> brake_hard;                              // runs in which others have to
  using Seeds = std::map<std::string, std::set<std::uint64_t>>;  // by set: a title has one hash for each split
  auto const run = [&](std::string const& split, std::string const& name) {
    program.output({"--set", "planners", "--behaviors", "idm,urban", "--scenarios", "1", "--split", split, "--replays",
                    "none", "--db", folder.file(name + ".db"), "--json", folder.file(name + ".json")});
    Seeds seeds;
    cambium::ResultStore::existing(folder.file(name + ".db")).for_each([&](cambium::ResultRow const& row) {
      auto const hash = cambium::hash_text(row.key.set_hash);
      seeds[hash].insert(row.seed);
      if (row.result.imposed_braking > 4.0) brake_hard.insert(hash + row.key.behavior + row.population);
    });
    return seeds;
  };
  auto const test = run("test", "test"), train = run("train", "train");
  CHECK(test.size() == 20);
  CHECK(train.size() == 20);
  CHECK(run("train", "again") == train);
  std::set<std::uint64_t> all;
  for (auto const& seeds : {test, train})
    for (auto const& [hash, of_set] : seeds) {
      CHECK(of_set.size() == 1);  // the same for all populations
      all.insert(of_set.begin(), of_set.end());
    }
  CHECK(all.size() == 2 * 20);  // no scenario is in both

  std::set<std::string> kinds;
  double idm = 0.0, intersection = 0.0;
  for (auto const& row : nlohmann::json::parse(content_of(folder.file("test.json")))) {
    CAPTURE(row.dump());
    CHECK(row["scenarios"] == 1);
    CHECK(row["error"] == 0.0);
    CHECK(row["traffic"].is_null());
    auto const key = std::string(row["set_hash"]) + std::string(row["behavior"]) + std::string(row["population"]);
    CHECK(row["imposed_hard_braking"] == (brake_hard.contains(key) ? 1.0 : 0.0));
    kinds.insert(std::string(row["situation"]) + ", " + std::string(row["population"]));
    (row["planner"] == "idm" ? idm : intersection) += double(row["success"]) / 100.0;
  }
  CHECK(kinds.size() == 100);
  CHECK(idm > 0.2);  // an exam that can be passed, but not by following the next vehicle
  CHECK(idm < 0.8);
  CHECK(intersection > idm);
}
