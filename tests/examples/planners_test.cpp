// The examples lane_change and embed_in_planner as a user meets them.
#include <doctest/doctest.h>

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "program.hpp"

using namespace program;

TEST_CASE("the lane change example writes a row a cell, the same on any number of threads") {
  Program const program("lane_change");
  browser::TemporaryFolder const folder;
  auto const rows = [&](char const* preset, char const* threads) {
    auto const file = folder.path() / (std::string(preset) + threads + ".json");
    program.output({"--preset", preset, "--threads", threads, "--scenarios", "4", "--iterations", "50,100",
                    "--variation", "0,0.8", "--json", file.string(), "--out", folder.path().string()});
    auto json = nlohmann::json::parse(content_of(file));
    for (auto& row : json) {
      CHECK(row["iterations_per_second"].get<double>() > 0.0);
      row.erase("iterations_per_second");
    }
    return json;
  };
  auto const twice = program.run({"--scenarios", "1", "--iterations", "20,30,20", "--variation", "0.5,0.50", "--json",
                                  folder.file("twice.json"), "--out", folder.path().string()});
  CHECK(twice.code == 0);
  CHECK(nlohmann::json::parse(content_of(folder.path() / "twice.json")).size() == 2);
  for (char const* preset : {"paper", "cambium"}) {
    auto const one = rows(preset, "1");
    REQUIRE(one.size() == 4);
    CHECK(one == rows(preset, "2"));
    for (auto const& row : one) {
      CHECK(row["preset"] == preset);
      CHECK(row["scenarios"] == 4);
      std::uint64_t sum = 0;
      for (char const* kind : {"success", "collision", "time_out"}) {
        auto const& of = row[kind];
        sum += of["count"].get<std::uint64_t>();
        CHECK(of["low"].get<double>() <= of["share"].get<double>());
        CHECK(of["share"].get<double>() <= of["high"].get<double>());
        CHECK(of["low"].get<double>() < of["high"].get<double>());
      }
      CHECK(sum == row["scenarios"].get<std::uint64_t>());
    }
    CHECK(one[1]["iterations"] == 100);
    CHECK(one[2]["variation"] == 0.8);
    CHECK(has(content_of(folder.path() / (std::string(preset) + ".svg")), "collision"));
  }
}

TEST_CASE("an interrupted lane change leaves an earlier file as it is, and says where its rows are") {
  Program const program("lane_change");
  browser::TemporaryFolder const folder;
  auto const file = folder.path() / "rows.json", part = folder.path() / "rows.json.part";
  std::ofstream(file) << "earlier";
  // The first cell takes moments, the second hours.
  auto const command = program.command() + " --scenarios 2 --iterations 10,90000000 --variation 0 --json " +
                       browser::quoted(file.string()) + " --out " + browser::quoted(folder.path().string()) + " >" +
                       browser::quoted(folder.file("out")) + " 2>" + browser::quoted(folder.file("err")) +
                       " & while kill -0 $! && ! grep -q iterations_per_second " + browser::quoted(part.string()) +
                       "; do sleep 0.05; done 2>/dev/null; kill -TERM $!; wait $!";
  CHECK(WEXITSTATUS(std::system(("bash -c " + browser::quoted(command) + " 2>/dev/null").c_str())) ==
        143);  // by the signal
  CHECK(content_of(file) == "earlier");
  auto const rows = nlohmann::json::parse(content_of(part), nullptr, false);
  REQUIRE(rows.is_array());
  CHECK(rows.size() == 1);
  auto const err = content_of(folder.path() / "err");
  CHECK(has(err, "what was done is in " + part.string()));
  CHECK_FALSE(has(err, "left"));  // no progress where nobody looks
}

TEST_CASE("a lane change that is interrupted before its first row leaves nothing behind") {
  Program const program("lane_change");
  browser::TemporaryFolder const folder;
  auto const file = folder.path() / "rows.json", part = folder.path() / "rows.json.part";
  auto const command = program.command() + " --scenarios 2 --iterations 90000000 --json " +
                       browser::quoted(file.string()) + " --out " + browser::quoted(folder.path().string()) +
                       " >/dev/null 2>&1 & while kill -0 $! && ! test -e " + browser::quoted(part.string()) +
                       "; do sleep 0.05; done 2>/dev/null; kill -TERM $!; wait $!";
  CHECK(WEXITSTATUS(std::system(("bash -c " + browser::quoted(command) + " 2>/dev/null").c_str())) == 143);
  CHECK_FALSE(fs::exists(part));
  CHECK_FALSE(fs::exists(file));
}

TEST_CASE("rows can be written to a pipe") {
  Program const program("lane_change");
  browser::TemporaryFolder const folder;
  auto const out = folder.path() / "piped";
  auto const command =
      "cd " + browser::quoted(folder.path().string()) + " && " + program.command() +
      " --scenarios 2 --iterations 10 --variation 0 --json /dev/stderr --out results 2>&1 >/dev/null | cat >" +
      browser::quoted(out.string());
  CHECK(std::system(("bash -o pipefail -c " + browser::quoted(command)).c_str()) == 0);
  auto const rows = nlohmann::json::parse(content_of(out), nullptr, false);
  REQUIRE(rows.is_array());
  CHECK(rows.size() == 1);
  CHECK_FALSE(fs::exists(folder.path() / ".part"));
}

TEST_CASE("the lane change example names the fault in its options") {
  Program const program("lane_change");
  for (auto const& words : {std::vector<std::string>{"--preset", "mine"},
                            {"--iterations", "0"},
                            {"--iterations", "100,x"},
                            {"--iterations", "100,,200"},
                            {"--iterations", "100,"},
                            {"--variation", ""},
                            {"--variation", "1.5"},
                            {"--variation", "nan"},
                            {"--out", "/proc/none"},
                            {"--out", ""},
                            {"--scenarios", "-1"},
                            {"--json", "/proc/none/x.json"}}) {
    CAPTURE(words.back());
    program.refuses(words, words[0] == "--json" ? words[1] : words[0]);
  }
}

TEST_CASE("the list of a stack's objects becomes verdicts and modes, in at most 30 lines of the stack's") {
  std::ifstream source(fs::path(CAMBIUM_SOURCE_DIR) / "examples/embed_in_planner/main.cpp");
  int lines = -1;
  bool inside = false;
  for (std::string line; std::getline(source, line);) {
    inside = (inside || line == "// [embed") && line != "// embed]";
    lines += inside ? 1 : 0;
  }
  CHECK(lines > 15);
  CHECK(lines <= 30);
  Program const program("embed_in_planner");
  auto const said = program.output({"--map", std::string(CAMBIUM_SOURCE_DIR) + "/maps/intersection_4way.xodr"});
  for (auto const* part : {"follows its lane", "wrong way", "walks", "of a usual size", "as expected",
                           "refused: its position", "refused: an object before it"})
    CHECK(has(said, part));
  program.refuses({"--map", "/no/such.xodr"}, "--map");
  program.refuses({"--cycles", "0"}, "--cycles");
}
