// The sets that ship beside the default one.
#include <doctest/doctest.h>

#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "program.hpp"

TEST_CASE(
    "the lane change experiment is a set: a planner that changes lanes succeeds, a driver who keeps his does not") {
  program::Program const program("benchmark");
  if (!program.is_there()) return;
  browser::TemporaryFolder const folder;
  auto const file = [&](char const* name) { return (folder.path() / name).string(); };
  auto const run = program.run({"--set", "lane_change", "--behaviors", "idm,frenet", "--scenarios", "40", "--db",
                                file("lane_change.db"), "--json", file("rows.json")});
  CHECK(run.code == 0);
  CHECK(run.err.empty());
  std::set<std::string> sets;
  for (auto const& row : nlohmann::json::parse(program::content_of(file("rows.json")))) {
    CAPTURE(row.dump());
    sets.insert(std::string(row["set"]));
    CHECK(row["scenarios"] == 40);
    CHECK(row["error"] == 0.0);
    if (row["behavior"] == "idm")
      CHECK(row["success"] == 0.0);
    else
      CHECK(row["success"] > 0.0);
  }
  CHECK(sets == std::set<std::string>{"lane_change_0", "lane_change_20", "lane_change_40", "lane_change_80"});
}
