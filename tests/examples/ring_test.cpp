// The ring example as a user meets it.
#include <doctest/doctest.h>

#include <string>

#include "program.hpp"

using namespace program;

TEST_CASE("the ring example writes its table, figures, picture and replay, the same in every run") {
  Program const program("ring");
  browser::TemporaryFolder const folder;
  auto const run = [&](char const* name) {
    return program.run(
        {"--length", "800", "--minutes", "3", "--density", "50", "--out", (folder.path() / name).string()});
  };
  auto const first = run("a");
  CHECK(first.code == 0);
  CHECK(first.err.empty());
  CHECK(has(first.out, "string"));
  CHECK_FALSE(has(first.out, "failed"));
  REQUIRE(run("b").code == 0);
  for (char const* file : {"summary.json", "ring.svg", "replay.html"}) {
    CAPTURE(file);
    auto const text = content_of(folder.path() / "a" / file);
    CHECK(text.size() > 1000);
    CHECK(text == content_of(folder.path() / "b" / file));
  }
}

TEST_CASE("the ring example names the fault in its options") {
  Program const program("ring");
  for (auto const& words : {std::vector<std::string>{"--driver", "nobody"}, {"--length", "1"}, {"--density", "x"}})
    program.refuses(words, words[0]);
}
