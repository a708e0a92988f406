#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "../viewer/browser.hpp"
#include "program.hpp"

/// What all examples that sample scenarios have in common.
namespace sampled_example {

/// The number behind a key of summary.json; NaN where it is missing.
inline double value_of(std::string const& json, std::string const& key) {
  auto const at = json.find("\"" + key + "\":");
  return at == std::string::npos ? std::nan("") : std::strtod(json.c_str() + at + key.size() + 3, nullptr);
}

inline void check_help(program::Program const& program) {
  auto const help = program.run({"--help"});
  CHECK(help.code == 0);
  CHECK(help.err.empty());
  for (char const* option : {"--scenarios", "--seed", "--threads", "--steps", "--trajectories", "--map", "--out",
                             "--help", "success:", "off-road:"}) {
    CAPTURE(std::string(option));
    CHECK(help.out.find(option) != std::string::npos);
  }
}

/// Wrong words, files and maps: exit code 2 and one line that names them. `unfit`: a map that it has no use for.
inline void check_wrong_use(program::Program const& program, std::string const& unfit) {
  browser::TemporaryFolder const folder;
  auto const file = (folder.path() / "file").string();
  std::ofstream(file) << "<OpenSCENARIO/>";
  struct Case {
    std::vector<std::string> words;
    std::string named;
  };
  Case const cases[] = {{{"--frobnicate", "3"}, "--frobnicate"},
                        {{"--scenarios", "0"}, "--scenarios"},
                        {{"--steps", "2.5"}, "--steps"},
                        {{"--map", "nowhere.xodr"}, "nowhere.xodr"},
                        {{"--map", ""}, "--map"},
                        {{"--out", ""}, "--out"},
                        {{"--map", file}, file},
                        {{"--map", unfit}, unfit},
                        {{"--scenarios", "1", "--out", file + "/below"}, file + "/below"}};
  for (auto const& wrong : cases) {
    auto const run = program.run(wrong.words);
    CAPTURE(wrong.named);
    CAPTURE(run.err);
    CHECK(run.code == 2);
    CHECK(run.out.empty());
    CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
    CHECK(run.err.find(wrong.named) != std::string::npos);
  }
}

/// The same files on one thread and on two, others for another seed; a replay beside them.
inline void check_same_on_any_threads(program::Program const& program, std::vector<std::string> const& more) {
  browser::TemporaryFolder const folder;
  auto const run = [&](std::string const& name, std::vector<std::string> words) {
    words.insert(words.end(), more.begin(), more.end());
    for (auto const& word : {std::string("--scenarios"), std::string("12"), std::string("--out")})
      words.push_back(word);
    words.push_back((folder.path() / name).string());
    return program.run(words).code;
  };
  REQUIRE(run("1", {"--seed", "7", "--threads", "1"}) == 0);
  REQUIRE(run("2", {"--seed", "7", "--threads", "2"}) == 0);
  REQUIRE(run("other", {"--seed", "8"}) == 0);
  for (std::string const name : {"summary.json", "trajectories.csv"}) {
    CAPTURE(name);
    auto const one = program::content_of(folder.path() / "1" / name);
    CHECK_FALSE(one.empty());
    CHECK(one == program::content_of(folder.path() / "2" / name));
    CHECK(one != program::content_of(folder.path() / "other" / name));
  }
  auto const trajectories = program::content_of(folder.path() / "1" / "trajectories.csv");
  CHECK(trajectories.substr(0, trajectories.find('\n')).ends_with(",ego"));
  CHECK(trajectories.find(",1\n") != std::string::npos);
  CHECK(program::content_of(folder.path() / "1" / "replay.html").find("</html>") != std::string::npos);
  CHECK(value_of(program::content_of(folder.path() / "1" / "summary.json"), "scenarios") == 12.0);
}

}  // namespace sampled_example
