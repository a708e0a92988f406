// The benchmark example as a user meets it.
#include <doctest/doctest.h>

#include <signal.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "cambium/benchmark/result_store.hpp"
#include "cambium/core/write_file.hpp"
#include "program.hpp"

using program::content_of;
using program::Program;

namespace {

/// All rows of a database but their times, as text.
std::string results_in(std::string const& file) {
  cambium::ResultStore store(file);
  std::string text;
  store.for_each([&](cambium::ResultRow const& row) {
    text += row.key.behavior + " " + std::to_string(row.key.scenario) + " " + to_string(row.result) + "\n";
  });
  return text;
}

/// Number of results in a database; 0 if there is none yet.
std::size_t rows_in(std::string const& file) {
  std::size_t rows = 0;
  try {
    auto store = cambium::ResultStore::existing(file);
    store.for_each([&](auto const&) { ++rows; });
  } catch (cambium::StoreError const&) {
  }
  return rows;
}

}  // namespace

TEST_CASE("the benchmark gives the same results on any number of threads, and goes on after it was killed") {
  Program const program("benchmark");
  if (!program.is_there()) return;
  browser::TemporaryFolder const folder;
  auto const file = [&](char const* name) { return (folder.path() / name).string(); };
  std::vector<std::string> const what{
      "--set", "merging,junction_lights", "--behaviors", "idm,mobil,intersection", "--scenarios", "40"};
  auto const with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), what.begin(), what.end());
    return more;
  };
  auto const one = program.run(with({"--threads", "1", "--db", file("one.db"), "--json", file("one.json")}));
  CHECK(one.code == 0);
  CHECK(one.err.empty());
  CHECK(one.out.find("240 runs") != std::string::npos);
  auto const rows = nlohmann::json::parse(content_of(file("one.json")));
  REQUIRE(rows.size() == 6);
  for (auto const& row : rows) {
    CHECK(row["scenarios"] == 40);
    CHECK(row["error"] == 0.0);
    double const ends = double(row["success"]) + double(row["collision"]) + double(row["timed_out"]);
    CHECK(ends <= 1.0 + 1e-9);
  }
  CHECK(rows[0]["set"] == "merging");
  CHECK(rows[0]["situation"] == "merging");
  CHECK(rows[0]["planner"] == "idm");
  CHECK(rows[0]["traffic"].is_null());
  CHECK(rows[0]["success"] == 1.0);

  auto const expected = results_in(file("one.db"));
  REQUIRE(program.run(with({"--threads", "3", "--db", file("three.db")})).code == 0);
  CHECK(results_in(file("three.db")) == expected);
  auto const processes = program.run(with({"--processes", "2", "--db", file("processes.db")}));
  CHECK(processes.out.find("240 runs in ") != std::string::npos);
  CHECK(processes.out.find(" on 2 processes; ") != std::string::npos);
  CHECK(results_in(file("processes.db")) == expected);

  std::size_t kept = 0;
  for (std::size_t const wanted : {1u, 40u, 100u}) {
    pid_t const child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      auto words = with({"--threads", "2", "--db", file("killed.db")});
      words.insert(words.begin(), CAMBIUM_EXAMPLES_DIR "/benchmark");
      std::vector<char*> argv;
      for (auto& word : words) argv.push_back(word.data());
      argv.push_back(nullptr);
      if (std::freopen("/dev/null", "w", stdout) == nullptr) _exit(1);
      execv(argv[0], argv.data());
      _exit(1);
    }
    for (int tries = 0; tries < 10'000 && rows_in(file("killed.db")) < wanted; ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    auto const found = rows_in(file("killed.db"));
    CHECK(found >= wanted);
    CHECK(found >= kept);
    kept = found;
  }
  auto const again = program.run(with({"--db", file("killed.db")}));
  CHECK(again.code == 0);
  CHECK(again.out.find("\n  " + std::to_string(240 - kept) + " run") != std::string::npos);  // those that it lacked
  CHECK(results_in(file("killed.db")) == expected);
  auto const nothing = program.run(with({"--db", file("killed.db")}));
  CHECK(nothing.out.find("0 runs") != std::string::npos);
  CHECK(nothing.out.find("240 results were there already; --again runs all anew") != std::string::npos);
  CHECK(nothing.out.find("successes (collisions)") != std::string::npos);
}

TEST_CASE("the benchmark repeats one scenario and writes its replay") {
  Program const program("benchmark");
  if (!program.is_there()) return;
  browser::TemporaryFolder const folder;
  auto const replay = (folder.path() / "replay.html").string();
  auto const run = program.run({"--set", "merging", "--only", "merging:3:idm", "--replay", replay});
  CHECK(run.code == 0);
  CHECK(run.out.find("success: true") != std::string::npos);
  CHECK(content_of(replay).find("merging, scenario 3, idm") != std::string::npos);
  auto const snapshot = (folder.path() / "replay.snapshot").string();
  REQUIRE(program.run({"--set", "exit", "--only", "exit:2:idm", "--replay", replay}).code == 0);
  CHECK(std::filesystem::exists(snapshot));
  REQUIRE(program.run({"--set", "merging", "--only", "merging:3:idm", "--replay", replay}).code == 0);
  CHECK_FALSE(std::filesystem::exists(snapshot));  // it would be of another run
}

TEST_CASE("failed runs leave replays that the report links, and a command that repeats them") {
  Program const program("benchmark"), report("report");
  if (!program.is_there() || !report.is_there()) return;
  browser::TemporaryFolder const folder;
  auto const file = [&](char const* name) { return (folder.path() / name).string(); };
  std::vector<std::string> const words{"--set", "exit", "--behaviors", "idm", "--scenarios", "3", "--db", file("r.db")};
  REQUIRE(program.run(words).code == 0);
  std::vector<std::string> replays;
  std::size_t snapshots = 0;
  for (auto const& entry : std::filesystem::directory_iterator(folder.path() / "r_replays")) {
    auto const name = entry.path().filename().string();
    if (name.ends_with(".html")) replays.push_back(name);
    snapshots += name.ends_with(".snapshot");
  }
  std::sort(replays.begin(), replays.end());
  REQUIRE(replays.size() == 3);
  CHECK(snapshots == 3);
  CHECK(replays.front().find("exit_idm_") == 0);
  CHECK(content_of(file(("r_replays/" + replays.front()).c_str())).find("exit, scenario 0, idm") != std::string::npos);
  REQUIRE(report.run({"--db", file("r.db"), "--html", file("r.html")}).code == 0);
  auto const page = content_of(file("r.html"));
  CHECK(page.find("\"made\":[0,1,2]") != std::string::npos);
  CHECK(page.find("\"frozen\":[0,1,2]") != std::string::npos);
  CHECK(page.find("\"source\":\"--set examples/exit --scenarios 3\"") != std::string::npos);
  auto const again = program.run({"--set", "examples/exit", "--scenarios", "3", "--only", "exit:2:idm"});
  CHECK(again.code == 0);
  CHECK(again.out.find("success: false") != std::string::npos);

  auto const none = program.run({"--set", "exit", "--behaviors", "idm", "--scenarios", "3", "--db", file("none/r.db"),
                                 "--replays", "none", "--plan-limit", "1e-9", "--json", file("r.json")});
  CHECK(none.code == 0);
  CHECK_FALSE(std::filesystem::exists(file("none/r_replays")));
  auto const row = nlohmann::json::parse(content_of(file("r.json")))[0];
  CHECK(row["error"] == 1.0);
  CHECK(row["mean_time_s"].is_null());

  cambium::write_file(file("its parameters.json"), R"({"idm": {"time_headway": 3}})");
  REQUIRE(program
              .run({"--set", "exit", "--behaviors", "idm", "--scenarios", "1", "--db", file("with.db"), "--plan-limit",
                    "60", "--parameters", file("its parameters.json")})
              .code == 0);
  REQUIRE(report.run({"--db", file("with.db"), "--html", file("with.html")}).code == 0);
  auto const with = content_of(file("with.html"));
  CHECK(with.find("\"source\":\"--set examples/exit --scenarios 1 --plan-limit 60\"") != std::string::npos);
  CHECK(with.find("\"command\":\"examples/run benchmark --parameters '" + file("its parameters.json") + "'\"") !=
        std::string::npos);
}

TEST_CASE("the benchmark names the fault in its options") {
  Program const program("benchmark");
  if (!program.is_there()) return;
  browser::TemporaryFolder const folder;
  auto const error = [&](std::vector<std::string> const& words) {
    auto const run = program.run(words);
    CHECK(run.code == 2);
    return run.err;
  };
  auto const says = [&](std::vector<std::string> const& words, std::string const& text) {
    auto const message = error(words);
    CAPTURE(message);
    CHECK(message.find(text) != std::string::npos);
  };
  says({"--sets", "merging"}, "is it --set or --seed?");
  says({"--set"}, "lacks its value");
  says({"--set", "nowhere"}, "is neither a scenario file nor a folder");
  says({"--set", "merging", "--behaviors", "idmm"}, "is it idm?");
  says({"--threads", "0"}, "give a whole number from 1 to 4096");
  says({"--threads", "1", "--threads", "2"}, "is given twice");
  says({"--threads", "1", "--processes", "2"}, "is given beside --threads");
  says({"--shard", "2/2"}, "write i/n");
  says({"--set", "merging", "--only", "merging:99:idm"}, "give a number from 0 to 7");
  says({"--set", "merging", "--only", "merging"}, "write SET:NUMBER:BEHAVIOR");
  says({"--set", "merging", "--replay", "x.html"}, "needs --only");
  says({"--set", "merging", "--only", "merging:3:idm", "--replay", "x.snapshot"}, "a name that ends in .html");
  says({"--split", "half"}, "write train or test");
  says({"--replays", "some"}, "write failures, all or none");
  says({"--plan-limit", "0"}, "give a number of seconds above 0");
  says({"--db", ""}, "--db: is empty; name a file");
  says({"--scenarios", "100001"}, "give a whole number from 1 to 100000");
  auto const own = [&](std::string const& text) {
    cambium::write_file(folder.path() / "own.json", text);
    return (folder.path() / "own.json").string();
  };
  std::string const map = R"("map_file": ")" CAMBIUM_SOURCE_DIR R"(/maps/merging.xodr")";
  says({"--set", own(R"({"format": 1})")}, "has no scenarios; give it");
  std::string const agents = R"("agents": [{"id": 0, "position": {"x": 20, "y": -5.25}, "heading": 0, "speed": 9}]})";
  says({"--set", own(R"({"scenarios": [{)" + map + ", " + agents + "]}")}, "own.json: scenario 0: has no ego");
  says({"--set", own(R"({"scenarios": [{)" + map + R"(, "ego": 0, )" + agents + "]}"), "--seed", "3"},
       "has no recipes to which --scenarios, --seed and --split could apply");
  auto const replay = (folder.path() / "replay.html").string();
  REQUIRE(program.run({"--set", "merging", "--only", "merging:0:idm", "--replay", replay}).code == 0);
  says({"--set", "merging", "--db", replay + "/in_a_file.db"}, "in_a_file.db");
  says({"--set", "merging", "--behaviors", "idm", "--db", replay}, "replay.html");
  CHECK(program.run({"--help"}).out.find("--shard i/n") != std::string::npos);
  CHECK(program.run({"--list"}).out.find("mcts_hypothesis") != std::string::npos);
}
