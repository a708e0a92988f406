// The highway example as a user meets it: the built program, run on the command line.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "../support/corpus.hpp"
#include "../viewer/browser.hpp"
#include "sampled_example.hpp"

TEST_CASE("highway: options, errors and results are as those of the other sampled examples") {
  program::Program const program("highway");
  if (!program.is_there()) return;
  sampled_example::check_help(program);
  sampled_example::check_wrong_use(program, CAMBIUM_SOURCE_DIR "/maps/roundabout.xodr");
  sampled_example::check_same_on_any_threads(program, {});
}

TEST_CASE("highway: nobody collides, cars take their exits, and lanes are changed") {
  program::Program const program("highway");
  if (!program.is_there()) return;
  browser::TemporaryFolder const folder;
  REQUIRE(program.run({"--scenarios", "40", "--out", (folder.path() / "out").string()}).code == 0);
  auto const summary = program::content_of(folder.path() / "out" / "summary.json");
  CHECK(sampled_example::value_of(summary, "collision") == 0.0);
  CHECK(sampled_example::value_of(summary, "off_road") == 0.0);
  CHECK(sampled_example::value_of(summary, "success") > 0.6);
  CHECK(sampled_example::value_of(summary, "lane_changes") > 100.0);
  CHECK(sampled_example::value_of(summary, "exits") == 1.0);
}

TEST_CASE("highway: so it does on a real road with traffic on the left") {
  program::Program const program("highway");
  if (!program.is_there()) return;
  if (auto const map = corpus::find("opendrive/e6mini-lht.xodr"))
    sampled_example::check_same_on_any_threads(program, {"--map", map->string()});
}
