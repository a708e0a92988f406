// The zip merge example as a user meets it: the built program, run on the command line.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "../viewer/browser.hpp"
#include "sampled_example.hpp"

TEST_CASE("zip_merge: options, errors and results are as those of the other sampled examples") {
  program::Program const program("zip_merge");
  if (!program.is_there()) return;
  sampled_example::check_help(program);
  sampled_example::check_wrong_use(program, CAMBIUM_SOURCE_DIR "/maps/highway.xodr");
  sampled_example::check_same_on_any_threads(program, {});
}

TEST_CASE("zip_merge: nobody collides, all merge, and seldom two of one lane one after the other") {
  program::Program const program("zip_merge");
  if (!program.is_there()) return;
  for (std::string const map : {"lane_drop", "merging"}) {
    browser::TemporaryFolder const folder;
    REQUIRE(program
                .run({"--scenarios", "60", "--out", (folder.path() / "out").string(), "--map",
                      CAMBIUM_SOURCE_DIR "/maps/" + map + ".xodr"})
                .code == 0);
    auto const summary = program::content_of(folder.path() / "out" / "summary.json");
    CAPTURE(map);
    CHECK(sampled_example::value_of(summary, "collision") == 0.0);
    CHECK(sampled_example::value_of(summary, "success") == 1.0);
    CHECK(sampled_example::value_of(summary, "pairs_at_merge") > 200.0);
    CHECK(sampled_example::value_of(summary, "of_one_lane") <
          0.4 * sampled_example::value_of(summary, "pairs_at_merge"));
  }
}
