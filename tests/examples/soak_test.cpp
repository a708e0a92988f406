// The long test as a user meets it, in short: 3 minutes on each map, times CAMBIUM_SCALE.
#include <doctest/doctest.h>

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cambium/core/write_file.hpp"

#include "../support/scale.hpp"
#include "program.hpp"

using namespace program;

namespace {

std::string minutes() { return std::to_string(support::runs(3)); }

}  // namespace

TEST_CASE("mixed traffic flows into all maps for some minutes without a collision, the same on any threads") {
  Program const program("soak");
  browser::TemporaryFolder const folder;
  auto const one =
      program.run({"--minutes", minutes(), "--seed", "3", "--threads", "1", "--json", folder.file("one.json")});
  REQUIRE(one.code == 0);
  CHECK(has(one.out, "vehicle-km"));
  REQUIRE(
      program.run({"--minutes", minutes(), "--seed", "3", "--threads", "2", "--json", folder.file("two.json")}).code ==
      0);
  CHECK(content_of(folder.file("one.json")) == content_of(folder.file("two.json")));
  auto const json = nlohmann::json::parse(content_of(folder.file("one.json")));
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
  browser::TemporaryFolder const folder;
  auto const map = CAMBIUM_SOURCE_DIR "/maps/roundabout.xodr";
  auto const run =
      program.run({"--map", map, "--seed", "3", "--replay", "2", "--step", "200", "--out", folder.file("out")});
  CHECK(run.code == 0);
  CHECK(run.err.empty());
  CHECK(has(run.out, "step 200"));
  auto const page = content_of(folder.file("out/replay.html"));
  CHECK(has(page, "</html>"));
  CHECK(has(page, "run 2"));
  auto const beyond =
      program.run({"--map", map, "--seed", "3", "--replay", "2", "--step", "1000000", "--out", folder.file("out")});
  CHECK(beyond.code == 2);
  CHECK(has(beyond.err, "--step 1000000: run 2 has "));
  CHECK(content_of(folder.file("out/replay.html")) == page);
}

TEST_CASE("the long test fails where it finds a collision, and its command repeats that") {
  Program const program("soak");
  browser::TemporaryFolder const folder;
  std::string const map = CAMBIUM_SOURCE_DIR "/maps/lane_drop.xodr", drivers = folder.file("its drivers.json");
  cambium::write_file(drivers, R"({"urban_driver": {"law": {"lowest_acceleration": -1, "time_headway": 0.1}}})");
  auto const run = program.run({"--map", map, "--minutes", "2", "--seed", "3", "--parameters", drivers});
  CHECK(run.code == 1);
  std::string const name = "examples/run soak ";
  REQUIRE(has(run.out, name));
  auto const begin = run.out.find(name) + name.size();
  std::istringstream command(run.out.substr(begin, run.out.find('\n', begin) - begin));
  std::vector<std::string> words{"--out", folder.file("out")};
  for (std::string word; command >> std::quoted(word, '\'');) words.push_back(word);
  auto const again = program.run(words);
  CHECK(again.code == 0);
  CHECK(has(again.out, "collision"));
  CHECK(has(content_of(folder.file("out/replay.html")), "collision"));
}

TEST_CASE("the long test names what is wrong with its options") {
  Program const program("soak");
  for (auto const& words : {std::vector<std::string>{"--minutes", "0"},
                            {"--seed", "x"},
                            {"--map", "nowhere.xodr"},
                            {"--map", CAMBIUM_SOURCE_DIR "/maps"},
                            {"--replay", "1"},
                            {"--step", "5"},
                            {"--minutes", "1", "--hours", "1"},
                            {"--hours", "1", "--replay", "3", "--map", "nowhere.xodr"},
                            {"--out", "out"},
                            {"--minute", "1"}})
    program.refuses(words, words[0] == "--map" ? words[1] : words[0]);
  browser::TemporaryFolder const folder;
  std::string const map = folder.file("map.xodr"), text = content_of(CAMBIUM_SOURCE_DIR "/maps/lane_drop.xodr");
  std::string const drivers = folder.file("drivers.json");
  cambium::write_file(map, text);
  cambium::write_file(drivers, "{}");
  for (auto const& input : {map, drivers})
    program.refuses({"--map", map, "--minutes", "0.1", "--parameters", drivers, "--json", input},
                    "that this run reads");
  CHECK(content_of(map) == text);
  CHECK(content_of(drivers) == "{}");
}
