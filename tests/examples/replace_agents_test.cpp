// The replace_agents example as a user meets it.
#include <doctest/doctest.h>

#include <string>

#include <nlohmann/json.hpp>

#include "program.hpp"

using program::content_of;
using program::Program;

TEST_CASE("replace_agents prints the paper's table, the same on any number of threads, and from the files it writes") {
  Program const program("replace_agents");
  if (!program.is_there()) return;
  browser::TemporaryFolder const folder;
  auto const file = [&](char const* name) { return (folder.path() / name).string(); };
  auto const run = [&](std::vector<std::string> words) {
    words.insert(words.end(), {"--iterations", "5"});
    return program.run(words);
  };
  auto const own = run({"--recordings", "1", "--threads", "2", "--json", file("a.json"), "--write", file("zip.csv")});
  CHECK(own.code == 0);
  CHECK(own.err.empty());
  CHECK(own.out.find("replayed without a change, 0 of them collide") != std::string::npos);
  CHECK(own.out.find("A6  66, 68, 65, 67") != std::string::npos);
  REQUIRE(run({"--recordings", "1", "--threads", "1", "--json", file("b.json")}).code == 0);
  CHECK(content_of(file("a.json")) == content_of(file("b.json")));

  auto const cells = nlohmann::json::parse(content_of(file("a.json")))["cells"];
  REQUIRE(cells.size() == 7 * 4 * 4);
  for (auto const& cell : cells)
    if (cell["behavior"] == "IDM" && cell["parameters"] == "P1") CHECK(cell["collisions"] == 0);

  REQUIRE(run({"--tracks", file("zip.csv"), "--map", file("zip.csv.xodr"), "--json", file("c.json")}).code == 0);
  auto const again = nlohmann::json::parse(content_of(file("c.json")))["cells"];
  REQUIRE(again.size() == cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i]["behavior"] == "MCTS") continue;  // a rounding of the speeds may turn a search
    CHECK(again[i]["collisions"] == cells[i]["collisions"]);
    CHECK(again[i]["displacement_m"] == doctest::Approx(double(cells[i]["displacement_m"])).epsilon(1e-3));
  }
}

TEST_CASE("replace_agents names the fault in its options") {
  Program const program("replace_agents");
  if (!program.is_there()) return;
  auto const error = [&](std::vector<std::string> const& words) {
    auto const run = program.run(words);
    CHECK(run.code == 2);
    return run.err;
  };
  CHECK(error({"--tracks", "/nowhere.csv"}).find("--map") != std::string::npos);
  CHECK(error({"--tracks", "/nowhere.csv", "--map", "/nowhere.osm"}).find("/nowhere.csv") != std::string::npos);
  CHECK(error({"--ids", "65,66"}).find("four") != std::string::npos);
  CHECK(error({"--ids", "65,66,67,99"}).find("track 99") != std::string::npos);
}
