// The example of junctions as a user meets it: the built program, run on the command line.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "../support/skipped.hpp"
#include "../viewer/browser.hpp"
#include "program.hpp"

namespace {

using program::content_of;
using program::Program;

/// The number that follows `key` in a text; -1 where the key is missing.
double number_after(std::string const& text, std::string const& key) {
  auto const at = text.find(key);
  return at == std::string::npos ? -1.0 : std::strtod(text.c_str() + at + key.size(), nullptr);
}

}  // namespace

TEST_CASE("intersection --help lists the options and is no error") {
  Program const program("intersection");
  if (!program.is_there()) return;
  auto const help = program.run({"--help"});
  CHECK(help.code == 0);
  CHECK(help.err.empty());
  for (char const* option : {"--scenarios", "--seed", "--threads", "--steps", "--map", "--out", "--help"}) {
    CAPTURE(option);
    CHECK(help.out.find(option) != std::string::npos);
  }
}

TEST_CASE("intersection says in one line what is wrong, with exit code 2") {
  Program const program("intersection");
  if (!program.is_there()) return;
  struct Case {
    std::vector<std::string> words;
    std::string named;
  };
  Case const cases[] = {{{"--frobnicate", "3"}, "--frobnicate"},
                        {{"--scenarios", "0"}, "--scenarios"},
                        {{"--map", "nowhere.xodr"}, "nowhere.xodr"},
                        {{"--map", CAMBIUM_SOURCE_DIR "/maps/highway.xodr"}, "highway.xodr"}};
  for (auto const& wrong : cases) {
    CAPTURE(wrong.named);
    auto const run = program.run(wrong.words);
    CAPTURE(run.err);
    CHECK(run.code == 2);
    CHECK(run.out.empty());
    CHECK(run.err.find('\n') + 1 == run.err.size());
    CHECK(run.err.find(wrong.named) != std::string::npos);
  }
}

TEST_CASE("everybody gets through the project's junctions, and the files do not depend on the threads") {
  Program const program("intersection");
  if (!program.is_there()) return;
  for (std::string const name : {"intersection_4way", "intersection_3way", "roundabout"}) {
    CAPTURE(name);
    browser::TemporaryFolder const folder;
    auto const run = [&](char const* threads, char const* seed, char const* out) {
      return program.run({"--scenarios", "20", "--seed", seed, "--threads", threads, "--map",
                          CAMBIUM_SOURCE_DIR "/maps/" + name + ".xodr", "--out", (folder.path() / out).string()});
    };
    for (char const* threads : {"1", "2"}) {
      auto const result = run(threads, "7", threads);
      CAPTURE(result.err);
      CHECK(result.code == 0);
      CHECK(result.err.empty());
      CHECK(result.out.find("success") != std::string::npos);
    }
    REQUIRE(run("2", "8", "other").code == 0);
    for (char const* file : {"summary.json", "trajectories.csv"}) {
      CAPTURE(file);
      auto const one = content_of(folder.path() / "1" / file);
      CHECK_FALSE(one.empty());
      CHECK(one == content_of(folder.path() / "2" / file));
      CHECK(one != content_of(folder.path() / "other" / file));
    }
    auto const summary = content_of(folder.path() / "1" / "summary.json");
    CHECK(number_after(summary, "\"scenarios\":") == 20);
    CHECK(number_after(summary, "\"success\":") == 1.0);
    CHECK(number_after(summary, "\"collision\":") == 0.0);
    CHECK(number_after(summary, "\"agents\":") >= 40);
  }
}

TEST_CASE("the replay of a junction plays in a browser") {
  Program const program("intersection");
  if (!program.is_there()) return;
  auto const chromium = browser::find();
  if (!chromium) {
    support::skip("no browser: install chromium");
    return;
  }
  browser::TemporaryFolder const folder;
  REQUIRE(program.run({"--scenarios", "5", "--out", (folder.path() / "out").string()}).code == 0);
  auto const document = browser::document(*chromium, folder.path() / "out" / "replay.html", "play", 2000);
  int const frames = std::stoi("0" + browser::attribute(document, "<body", "data-ready"));
  CHECK(frames > 20);
  CHECK(std::stoi("0" + browser::attribute(document, "<body", "data-frame")) > 2);
}
