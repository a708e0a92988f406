// The field example as a user meets it. Costs 5 s.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "program.hpp"

using namespace program;

TEST_CASE("the field example measures the wave in a jam as people's, and writes the same rows in every run") {
  Program const program("field");
  browser::TemporaryFolder const folder;
  auto const file = (folder.path() / "rows.json").string(), again = (folder.path() / "again.json").string();
  REQUIRE(program.run({"--only", "queue", "--seed", "3", "--json", file}).err.empty());
  REQUIRE(program.run({"--only", "queue", "--seed", "3", "--json", again, "--threads", "1"}).err.empty());
  auto const text = content_of(file);
  CHECK(text == content_of(again));
  auto const rows = nlohmann::json::parse(text).at("rows");
  REQUIRE(rows.size() == 1);
  for (auto const* const key : {"quantity", "people", "cambium", "sumo", "unit", "source"})
    CHECK(rows[0].contains(key));
  CHECK(rows[0]["cambium"].get<double>() < -15.0);
  CHECK(rows[0]["cambium"].get<double>() > -21.0);
}

TEST_CASE("the field example names the fault in its options") {
  Program const program("field");
  for (auto const& words : {std::vector<std::string>{"--only", "nothing"}, {"--threads", "0"}, {"--seed", "x"}})
    program.refuses(words, words[0]);
}
