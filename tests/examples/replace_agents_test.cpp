// The replace_agents example as a user meets it.
#include <doctest/doctest.h>

#include <string>

#include <nlohmann/json.hpp>

#include "program.hpp"

using namespace program;

TEST_CASE("replace_agents prints the paper's table, the same on any number of threads, and from the files it writes") {
  Program const program("replace_agents");
  browser::TemporaryFolder const folder;
  auto const run = [&](std::vector<std::string> words) {
    words.insert(words.end(), {"--iterations", "5"});
    return program.run(words);
  };
  auto const own =
      run({"--recordings", "1", "--threads", "2", "--json", folder.file("a.json"), "--write", folder.file("zip.csv")});
  CHECK(own.code == 0);
  CHECK(own.err.empty());
  CHECK(has(own.out, "replayed without a change, 0 of them collide"));
  CHECK(has(own.out, "A6  66, 68, 65, 67"));
  REQUIRE(run({"--recordings", "1", "--threads", "1", "--json", folder.file("b.json")}).code == 0);
  CHECK(content_of(folder.file("a.json")) == content_of(folder.file("b.json")));

  auto const cells = nlohmann::json::parse(content_of(folder.file("a.json")))["cells"];
  REQUIRE(cells.size() == 7 * 4 * 4);
  for (auto const& cell : cells)
    if (cell["behavior"] == "IDM" && cell["parameters"] == "P1") CHECK(cell["collisions"] == 0);

  REQUIRE(
      run({"--tracks", folder.file("zip.csv"), "--map", folder.file("zip.csv.xodr"), "--json", folder.file("c.json")})
          .code == 0);
  auto const again = nlohmann::json::parse(content_of(folder.file("c.json")))["cells"];
  REQUIRE(again.size() == cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i]["behavior"] == "MCTS") continue;  // a rounding of the speeds may turn a search
    CHECK(again[i]["collisions"] == cells[i]["collisions"]);
    CHECK(again[i]["displacement_m"] == doctest::Approx(double(cells[i]["displacement_m"])).epsilon(1e-3));
  }
}

TEST_CASE("replace_agents names the fault in its options") {
  Program const program("replace_agents");
  program.refuses({"--tracks", "/nowhere.csv"}, "--map");
  program.refuses({"--tracks", "/nowhere.csv", "--map", "/nowhere.osm"}, "/nowhere.csv");
  program.refuses({"--ids", "65,66"}, "four");
  program.refuses({"--ids", "65,66,67,99"}, "track 99");
}
