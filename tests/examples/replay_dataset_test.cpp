// The example that replays recorded traffic.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "../support/corpus.hpp"
#include "program.hpp"

using namespace program;

TEST_CASE("a recording is listed by windows, replayed, and driven anew by a model") {
  auto const folder = corpus::find("scenarios/interaction");
  if (!folder) return;
  Program const program("replay_dataset");
  browser::TemporaryFolder const out;
  std::vector<std::string> const files{"--tracks", (*folder / "TestScenarioForScripts_vehicle_tracks_000.csv").string(),
                                       "--map", (*folder / "TestScenarioForScripts.osm").string()};
  auto const run = [&](std::vector<std::string> const& more) {
    auto words = files;
    words.insert(words.end(), more.begin(), more.end());
    return program.run(words);
  };
  CHECK(has(run({"--list"}).out, "       0    0.1   10.0  2"));
  auto const replayed = run({"--out", out.file("a")});
  CHECK(has(replayed.out, "9.9 s from 0.1 s of the recording, 2 road users, 0 of them driven by urban"));
  CHECK(has(replayed.out, "collision: none"));
  CHECK(std::filesystem::exists(out.file("a") + "/replay.html"));
  auto const driven = run({"--replace-all", "--driver", "idm", "--out", out.file("b")});
  CHECK(has(driven.out, "2 of them driven by idm"));
  CHECK(has(driven.out, "mean distance from the recording: "));
  CHECK(has(run({"--window", "7"}).err, "--window 7: there is no such window; give a number below 1"));
  CHECK(has(run({"--replace", "999"}).err, "999"));
  CHECK(has(program.run({"--tracks", files[1]}).err, "--map: is missing"));
}

TEST_CASE("a planning problem is solved, and the solution written") {
  auto const file = corpus::find("scenarios/commonroad/ZAM-Ramp-1_1-T-1.xml");
  if (!file) return;
  Program const program("replay_dataset");
  browser::TemporaryFolder const out;
  auto const run = program.run({"--tracks", file->string(), "--solution", out.file("s.xml"), "--out", out.file("a")});
  CAPTURE(run.out);
  CHECK(run.code == 0);
  CHECK(has(run.out, "collision: none"));
  bool const solved = has(run.out, "is the solution of planning problem 1");
  CHECK(solved == std::filesystem::exists(out.file("s.xml")));
  CHECK((solved || has(run.out, "the goal was not reached in time")));
}

TEST_CASE("a planning problem is solved in one goal's area at that goal's time") {
  Program const program("replay_dataset");
  browser::TemporaryFolder const out;
  auto const bound = [](std::string const& name, std::string const& y) {
    return "<" + name + "><point><x>0</x><y>" + y + "</y></point><point><x>400</x><y>" + y + "</y></point></" + name +
           ">";
  };
  auto const goal = [](std::string const& x, std::string const& from, std::string const& to) {
    return "<goalState><position><rectangle><length>10</length><width>4</width><center><x>" + x +
           "</x><y>0</y></center></rectangle></position><time><intervalStart>" + from +
           "</intervalStart><intervalEnd>" + to + "</intervalEnd></time></goalState>";
  };
  std::ofstream(out.file("two_goals.xml"))
      << "<commonRoad benchmarkID='ZAM_Test-1_1_T-1' commonRoadVersion='2020a' timeStepSize='0.1'><lanelet id='1'>" +
             bound("leftBound", "2") + bound("rightBound", "-2") +
             "</lanelet><planningProblem id='50'><initialState><position><point><x>5</x><y>0</y></point></position>"
             "<orientation><exact>0</exact></orientation><time><exact>0</exact></time><velocity><exact>10</exact>"
             "</velocity></initialState>" +
             goal("60", "900", "990") + goal("380", "0", "500") + "</planningProblem></commonRoad>";
  auto const run = program.run({"--tracks", out.file("two_goals.xml"), "--solution", out.file("s.xml"), "--driver",
                                "idm", "--out", out.file("a")});
  CAPTURE(run.out);
  CHECK(has(run.out, "1 road user, 1 of them driven by idm"));
  REQUIRE(has(run.out, "is the solution of planning problem 50"));
  auto const solution = content_of(out.file("s.xml"));
  auto const last = solution.rfind("<x>");
  REQUIRE(last != std::string::npos);
  CHECK(std::stod(solution.substr(last + 3)) > 374.0);
}
