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

using namespace program;

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
  browser::TemporaryFolder const folder;
  std::vector<std::string> const what{
      "--set", "merging,junction_lights", "--behaviors", "idm,mobil,urban", "--scenarios", "40"};
  auto const with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), what.begin(), what.end());
    return more;
  };
  CHECK(has(program.output(with({"--threads", "1", "--db", folder.file("one.db"), "--json", folder.file("one.json")})),
            "240 runs"));
  auto const rows = nlohmann::json::parse(content_of(folder.file("one.json")));
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

  auto const expected = results_in(folder.file("one.db"));
  REQUIRE(program.run(with({"--threads", "3", "--db", folder.file("three.db")})).code == 0);
  CHECK(results_in(folder.file("three.db")) == expected);
  auto const processes = program.run(with({"--processes", "2", "--db", folder.file("processes.db")}));
  CHECK(has(processes.out, "240 runs in "));
  CHECK(has(processes.out, " on 2 processes; "));
  CHECK(results_in(folder.file("processes.db")) == expected);

  std::size_t kept = 0;
  for (std::size_t const wanted : {1u, 40u, 100u}) {
    pid_t const child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      auto words = with({"--threads", "2", "--db", folder.file("killed.db")});
      words.insert(words.begin(), CAMBIUM_EXAMPLES_DIR "/benchmark");
      std::vector<char*> argv;
      for (auto& word : words) argv.push_back(word.data());
      argv.push_back(nullptr);
      if (std::freopen("/dev/null", "w", stdout) == nullptr) _exit(1);
      if (std::freopen(folder.file("said").c_str(), "w", stderr) == nullptr) _exit(1);
      execv(argv[0], argv.data());
      _exit(1);
    }
    for (int tries = 0; tries < 10'000 && rows_in(folder.file("killed.db")) < wanted; ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    bool const by_hand = wanted == 100;
    kill(child, by_hand ? SIGINT : SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    if (by_hand) {
      REQUIRE(WIFSIGNALED(status));
      CHECK(has(content_of(folder.file("said")), "interrupted: the same command goes on where it was"));
    }
    auto const found = rows_in(folder.file("killed.db"));
    CHECK(found >= wanted);
    CHECK(found >= kept);
    kept = found;
  }
  auto const again = program.run(with({"--db", folder.file("killed.db")}));
  CHECK(again.code == 0);
  CHECK(has(again.out, "\n  " + std::to_string(240 - kept) + " run"));  // those that it lacked
  CHECK(results_in(folder.file("killed.db")) == expected);
  auto const nothing = program.run(with({"--db", folder.file("killed.db")}));
  CHECK(has(nothing.out, "0 runs"));
  CHECK(has(nothing.out, "240 results were there already; --again runs all anew"));
  CHECK(has(nothing.out, "successes (collisions)"));
}

TEST_CASE("the benchmark repeats one scenario and writes its replay") {
  Program const program("benchmark");
  browser::TemporaryFolder const folder;
  auto const replay = folder.file("replay.html");
  auto const run = program.run({"--set", "merging", "--only", "merging:3:idm", "--replay", replay});
  CHECK(run.code == 0);
  CHECK(has(run.out, "success: true"));
  CHECK(has(content_of(replay), "merging, scenario 3, idm"));
  auto const snapshot = folder.file("replay.snapshot");
  REQUIRE(program.run({"--set", "exit", "--only", "exit:2:idm", "--replay", replay}).code == 0);
  CHECK(fs::exists(snapshot));
  REQUIRE(program.run({"--set", "merging", "--only", "merging:3:idm", "--replay", replay}).code == 0);
  CHECK_FALSE(fs::exists(snapshot));  // it would be of another run
}

TEST_CASE("failed runs leave replays that the report links, and a command that repeats them") {
  Program const program("benchmark"), report("report");
  browser::TemporaryFolder const folder;
  std::vector<std::string> const words{"--set",       "exit", "--behaviors", "idm",
                                       "--scenarios", "3",    "--db",        folder.file("r.db")};
  REQUIRE(program.run(words).code == 0);
  std::vector<std::string> replays;
  std::size_t snapshots = 0;
  for (auto const& entry : fs::directory_iterator(folder.path() / "r_replays")) {
    auto const name = entry.path().filename().string();
    if (name.ends_with(".html")) replays.push_back(name);
    snapshots += name.ends_with(".snapshot");
  }
  std::sort(replays.begin(), replays.end());
  REQUIRE(replays.size() == 3);
  CHECK(snapshots == 3);
  CHECK(replays.front().find("exit_idm_") == 0);
  CHECK(has(content_of(folder.file("r_replays/" + replays.front())), "exit, scenario 0, idm"));
  REQUIRE(report.run({"--db", folder.file("r.db"), "--html", folder.file("r.html")}).code == 0);
  auto const page = content_of(folder.file("r.html"));
  CHECK(has(page, "\"made\":[0,1,2]"));
  CHECK(has(page, "\"frozen\":[0,1,2]"));
  CHECK(has(page, "\"source\":\"--set examples/exit --scenarios 3\""));
  auto const again = program.run({"--set", "examples/exit", "--scenarios", "3", "--only", "exit:2:idm"});
  CHECK(again.code == 0);
  CHECK(has(again.out, "success: false"));

  auto const none =
      program.run({"--set", "exit", "--behaviors", "idm", "--scenarios", "3", "--db", folder.file("none/r.db"),
                   "--replays", "none", "--plan-limit", "1e-9", "--json", folder.file("r.json")});
  CHECK(none.code == 0);
  CHECK_FALSE(fs::exists(folder.file("none/r_replays")));
  auto const row = nlohmann::json::parse(content_of(folder.file("r.json")))[0];
  CHECK(row["error"] == 1.0);
  CHECK(row["mean_time_s"].is_null());

  cambium::write_file(folder.file("its parameters.json"), R"({"idm": {"law": {"time_headway": 3}}})");
  REQUIRE(program
              .run({"--set", "exit", "--behaviors", "idm", "--scenarios", "1", "--db", folder.file("with.db"),
                    "--plan-limit", "60", "--parameters", folder.file("its parameters.json")})
              .code == 0);
  REQUIRE(report.run({"--db", folder.file("with.db"), "--html", folder.file("with.html")}).code == 0);
  auto const with = content_of(folder.file("with.html"));
  CHECK(has(with, "\"source\":\"--set examples/exit --scenarios 1 --plan-limit 60\""));
  CHECK(has(with, "\"command\":\"examples/run benchmark --parameters '" + folder.file("its parameters.json") + "'\""));
}

TEST_CASE("a file of parameters says how fast a planner likes to drive; without one, the scenario does") {
  Program const program("benchmark");
  browser::TemporaryFolder const folder;
  auto const time_with = [&](std::string const& parameters) {
    cambium::write_file(folder.file("p.json"), parameters);
    program.output({"--set", "merging", "--behaviors", "idm", "--scenarios", "1", "--db", folder.file("p.db"),
                    "--parameters", folder.file("p.json"), "--json", folder.file("r.json")});
    return double(nlohmann::json::parse(content_of(folder.file("r.json")))[0]["mean_time_s"]);
  };
  double const usual = time_with(R"({"idm": {"law": {"minimum_gap": 2.5}}})");
  CHECK(time_with(R"({"idm": {"law": {"desired_speed": 8}}})") > 1.3 * usual);
  auto const own = cambium::detail::rounded_text(cambium::IdmClassic{}.law.desired_speed);
  CHECK(time_with(R"({"idm": {"law": {"desired_speed": )" + own + "}}}") !=
        usual);  // also where it is the planner's own
  auto const printed = program.output({"--print-parameters"});
  CHECK(has(printed, "minimum_gap"));
  CHECK_FALSE(has(printed.substr(printed.find("\"idm\""), 400), "desired_speed"));
}

TEST_CASE("a table has rows by the titles and populations of recipes") {
  Program const program("benchmark");
  browser::TemporaryFolder const folder;
  auto const recipe = [](std::string const& more) {
    return R"({"map_file": ")" CAMBIUM_SOURCE_DIR R"(/maps/highway.xodr", "scenarios": 2, )" + more + "}";
  };
  auto const flow = [](std::string const& people) {
    return R"("flows": [{"from": "1/0/-2", "ego": "last", "traffic": {"end": 200}, "drivers": [{"behavior": "mobil")" +
           people + "}]}]";
  };
  std::string const person = R"(, "people": true)";
  cambium::write_file(folder.file("own.json"),
                      R"({"time_limit": 1, "recipes": [)" +
                          recipe(R"("title": "dense", "populations": ["timid", "as_given"], )" + flow(person)) + ", " +
                          recipe(R"("title": "light", "populations": ["timid"], )" + flow(person)) + ", " +
                          recipe(R"("title": "light", )" + flow("")) + ", " + recipe(flow("")) + "]}");
  program.output({"--set", folder.file("own.json"), "--behaviors", "idm", "--db", folder.file("own.db"), "--replays",
                  "none", "--json", folder.file("rows.json")});
  std::string rows;
  for (auto const& row : nlohmann::json::parse(content_of(folder.file("rows.json"))))
    rows += row["traffic"].dump() + " " + row["population"].dump() + " " + row["scenarios"].dump() + "; ";
  CHECK(rows == R"("dense" "timid" 2; "dense" "as_given" 2; "light" "timid" 2; "light" null 2; null null 2; )");
}

TEST_CASE("a folder of sets is run as a whole, wherever it is") {
  Program const program("benchmark");
  browser::TemporaryFolder const folder;
  program.refuses({"--set", folder.path().string()}, "has no scenario files (.json)");
  for (char const* name : {"merging.json", "exit.json"})
    fs::copy(CAMBIUM_SOURCE_DIR "/examples/benchmark/sets/examples/" + std::string(name), folder.path());
  program.refuses({"--set", folder.path().string()}, ".xodr");  // their maps are not there
  CHECK(
      has(program.output({"--set", "examples", "--behaviors", "idm", "--scenarios", "1", "--db", folder.file("r.db")}),
          "8 runs"));
}

TEST_CASE("the benchmark names the fault in its options") {
  Program const program("benchmark");
  browser::TemporaryFolder const folder;
  program.refuses({"--sets", "merging"}, "is it --set or --seed?");
  program.refuses({"--set"}, "lacks its value");
  program.refuses({"--set", "nowhere"}, "is neither a scenario file nor a folder");
  program.refuses({"--set", "merging", "--behaviors", "idmm"}, "is it idm?");
  program.refuses({"--threads", "0"}, "give a whole number from 1 to 4096");
  program.refuses({"--threads", "1", "--threads", "2"}, "is given twice");
  program.refuses({"--threads", "1", "--processes", "2"}, "is given beside --threads");
  program.refuses({"--shard", "2/2"}, "write i/n");
  program.refuses({"--set", "merging", "--only", "merging:99:idm"}, "give a number from 0 to 7");
  program.refuses({"--set", "merging", "--only", "merging"}, "write SET:NUMBER:BEHAVIOR");
  program.refuses({"--set", "merging", "--replay", "x.html"}, "needs --only");
  program.refuses({"--set", "merging", "--only", "merging:3:idm", "--replay", "x.snapshot"},
                  "a name that ends in .html");
  program.refuses({"--split", "half"}, "write train or test");
  program.refuses({"--replays", "some"}, "write failures, all or none");
  program.refuses({"--plan-limit", "0"}, "give a number of seconds above 0");
  program.refuses({"--db", ""}, "--db: is empty; name a file");
  program.refuses({"--scenarios", "100001"}, "give a whole number from 1 to 100000");
  auto const own = [&](std::string const& text) {
    cambium::write_file(folder.path() / "own.json", text);
    return folder.file("own.json");
  };
  std::string const map = R"("map_file": ")" CAMBIUM_SOURCE_DIR R"(/maps/merging.xodr")";
  program.refuses({"--set", own(R"({"format": 1})")}, "has no scenarios; give it");
  std::string const agents = R"("agents": [{"id": 0, "position": {"x": 20, "y": -5.25}, "heading": 0, "speed": 9}]})";
  program.refuses({"--set", own(R"({"scenarios": [{)" + map + ", " + agents + "]}")},
                  "own.json: scenario 0: has no ego");
  program.refuses({"--set", own(R"({"scenarios": [{)" + map + R"(, "ego": 0, )" + agents + "]}"), "--seed", "3"},
                  "has no recipes to which --scenarios, --seed, --split and --populations could apply");
  program.refuses(
      {"--set", own(R"({"scenarios": [{)" + map + R"(, "ego": 0, )" + agents + "]}"), "--populations", "as_given"},
      "has no recipes to which --scenarios, --seed, --split and --populations could apply");
  std::string const recipe =
      R"({"recipes": [{"scenarios": 1, "flows": [{"from": "1/0/-1", "ego": "first", "drivers": [{"people": true}]}], )";
  program.refuses({"--set", own(recipe + map + R"(, "populations": []}]})")},
                  "own.json: recipes[0]: has no populations; leave them out, or name some");
  program.refuses({"--set", own(recipe + map + R"(, "populations": ["timid"]}]})"), "--populations", "mixed,as_given"},
                  "own.json: has none of the populations of --populations; leave out the option, or name others");
  program.refuses({"--set", "merging", "--populations", "timid"}, "has none of the populations of --populations");
  auto const replay = folder.file("replay.html");
  REQUIRE(program.run({"--set", "merging", "--only", "merging:0:idm", "--replay", replay}).code == 0);
  program.refuses({"--set", "merging", "--db", replay + "/in_a_file.db"}, "in_a_file.db");
  program.refuses({"--set", "merging", "--behaviors", "idm", "--db", replay}, "replay.html");
  CHECK(has(program.run({"--help"}).out, "--shard i/n"));
  CHECK(has(program.run({"--list"}).out, "mcts_hypothesis"));
}
