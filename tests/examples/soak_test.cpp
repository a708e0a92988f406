// The long test as a user meets it, in short: 3 minutes on each map, times CAMBIUM_SCALE.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "../support/scale.hpp"
#include "program.hpp"

using program::content_of;
using program::Program;

namespace {

std::string minutes() { return std::to_string(support::runs(3)); }

}  // namespace

TEST_CASE("mixed traffic flows into all maps for some minutes without a collision, the same on any threads") {
  Program const program("soak");
  if (!program.is_there()) return;
  browser::TemporaryFolder const folder;
  auto const file = [&](char const* name) { return (folder.path() / name).string(); };
  auto const one = program.run({"--minutes", minutes(), "--seed", "3", "--threads", "1", "--json", file("one.json")});
  REQUIRE(one.code == 0);
  CHECK(one.out.find("vehicle-km") != std::string::npos);
  REQUIRE(program.run({"--minutes", minutes(), "--seed", "3", "--threads", "2", "--json", file("two.json")}).code == 0);
  CHECK(content_of(file("one.json")) == content_of(file("two.json")));
  auto const json = nlohmann::json::parse(content_of(file("one.json")));
  CHECK(json["rows"].size() >= 7);
  double kilometres = 0.0;
  for (auto const& row : json["rows"]) {
    CAPTURE(row.dump());
    CHECK(row["collisions"] == 0);
    CHECK(row["flaws"]["jump"].get<int>() + row["flaws"]["step back"].get<int>() == 0);
    CHECK(row["flaws"]["failed step"].get<int>() + row["flaws"]["off its route"].get<int>() == 0);
    CHECK(row["vehicle_km"] > 0.5 * std::stod(minutes()));
    if (support::runs(3) >= 3) CHECK(row["throughput_per_min"] > 0.2 * row["capacity_per_min"].get<double>());
    kilometres += row["vehicle_km"].get<double>();
  }
  MESSAGE(kilometres << " vehicle-kilometres");
}

TEST_CASE("the long test repeats one run up to a step, and writes its replay") {
  Program const program("soak");
  if (!program.is_there()) return;
  browser::TemporaryFolder const folder;
  auto const map = CAMBIUM_SOURCE_DIR "/maps/roundabout.xodr";
  auto const run = program.run(
      {"--map", map, "--seed", "3", "--replay", "2", "--step", "200", "--out", (folder.path() / "out").string()});
  CHECK(run.code == 0);
  CHECK(run.err.empty());
  CHECK(run.out.find("step 200") != std::string::npos);
  auto const page = content_of(folder.path() / "out" / "replay.html");
  CHECK(page.find("</html>") != std::string::npos);
  CHECK(page.find("run 2") != std::string::npos);
}

TEST_CASE("the long test names what is wrong with its options") {
  Program const program("soak");
  if (!program.is_there()) return;
  for (auto const& words : {std::vector<std::string>{"--minutes", "0"},
                            {"--seed", "x"},
                            {"--map", "nowhere.xodr"},
                            {"--replay", "1"},
                            {"--minute", "1"}}) {
    auto const run = program.run(words);
    CAPTURE(words[0]);
    CHECK(run.code == 2);
    CHECK(run.err.find(words[0] == "--map" ? words[1] : words[0]) != std::string::npos);
    CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
  }
}
