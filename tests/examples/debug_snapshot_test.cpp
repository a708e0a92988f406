// The examples record_snapshots and debug_snapshot as a user meets them.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "../support/sealed.hpp"
#include "program.hpp"

using namespace program;

namespace {

std::vector<std::string> snapshots_in(fs::path const& folder) {
  std::vector<std::string> files;
  for (auto const& entry : fs::directory_iterator(folder)) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

TEST_CASE("the defect of the case study is found by its snapshot, as the README tells") {
  Program const record("record_snapshots"), debug("debug_snapshot");
  browser::TemporaryFolder const folder;
  auto const out = folder.path() / "snapshots";
  auto const drive = record.run({"--out", out.string()});
  CHECK(drive.code == 0);
  CHECK(has(drive.out, "46 cycles, 12.7 s; 3 snapshots in"));
  auto const files = snapshots_in(out);
  REQUIRE(files.size() == 3);
  auto const replay = folder.path() / "cycle.html";
  auto const again = debug.run({files[0], "--replay", replay.string(), "--as-test"});
  CHECK(again.code == 0);
  CHECK(again.err.empty());
  CHECK(has(again.out, "because   a jerk of 1.68889 m/s^3"));
  CHECK(has(again.out, "remembers: {\n \"planned_at\": 0.2,"));
  CHECK(has(again.out, "bit-equal to what was recorded"));
  CHECK(has(again.out, "TEST_CASE(\"the cycle of 00000001.snapshot comes out as recorded\")"));
  CHECK(has(content_of(replay), "00000001.snapshot, from 0.9 s"));
  CHECK(has(content_of(replay), "a jerk of 1.68889 m/s^3"));
  CHECK(has(content_of(folder.path() / "cycle.svg"), "<svg"));
  auto const mended = debug.run({files[0], "--edit", "behavior.mended=1"});
  CHECK(mended.code == 1);
  CHECK(has(mended.out, "-3.121 m/s^2"));
  CHECK(has(mended.out, "edited:\n  agent 0: smooth_follower, with these parameters, else defaults: {\"mended\": 1}"));
  CHECK(has(mended.out,
            "without the edit: a jerk of 1.68889 m/s^3; agent 0 at (31.053, -5.250), 8.266 m/s, -2.721 m/s^2"));
  auto const faster = debug.run({"--edit", "behavior.desired_speed=12", files[0]});
  CHECK(faster.code == 1);
  CHECK(has(faster.out, "\"desired_speed\": 12"));
  auto const same = debug.run({"--edit", "behavior.highest_acceleration=7.5", files[0]});
  CHECK(has(same.out, "The edit changes no agent's motion in this cycle."));
  auto const on = debug.run({files[0], "--into-simulation"});
  CHECK(on.code == 0);
  CHECK(has(on.out, "no collision"));
  CHECK(debug.run({files[0], "--cycles", "5"}).code == 0);
}

TEST_CASE("a memory that holds NaN is printed, and can be edited") {
  Program const record("record_snapshots"), debug("debug_snapshot");
  browser::TemporaryFolder const folder;
  REQUIRE(record.run({"--out", folder.path().string(), "--each-cycle", "--seconds", "0.5", "--format", "xml"}).code ==
          0);
  auto bytes = content_of(snapshots_in(folder.path()).back());
  std::string const begin = "<planned_at>";
  auto const at = bytes.find(begin);
  REQUIRE(at != bytes.npos);
  auto const value = at + begin.size();
  bytes.replace(value, bytes.find('<', value) - value, "nan:9221120237041090560");
  auto const file = folder.file("nan.snapshot");
  std::ofstream(file, std::ios::binary) << support::sealed_again(bytes);
  auto const run = debug.run({file});
  CHECK(run.code == 1);  // something else was recorded
  CHECK(has(run.out, "remembers: smooth_follower_memory: planned_at=nan s"));
  auto const edited = debug.run({file, "--edit", "memory.planned=[0,0,0,0,0]", "--edit", "memory.planned_at=0.2"});
  CHECK(edited.code < 2);
  CHECK(has(edited.out, "without the edit"));
  debug.refuses({file, "--edit", "memory.planned_at=0.2", "--edit", "memory.planned_at=1e999"},
                "1e999': has no value of JSON");
}

TEST_CASE("a tree search's cycles come out bit-equal in every format, with the map embedded or not") {
  Program const record("record_snapshots"), debug("debug_snapshot");
  for (std::string const format : {"binary", "text", "xml"}) {
    CAPTURE(format);
    browser::TemporaryFolder const folder;
    std::vector<std::string> words{
        "--out", folder.path().string(), "--planner", "search",   "--each-cycle", "--seconds",
        "1",     "--iterations",         "50",        "--format", format};
    if (format != "binary") words.emplace_back("--embed-map");
    REQUIRE(record.run(words).code == 0);
    auto const files = snapshots_in(folder.path());
    CHECK(files.size() >= 2);
    for (auto const& file : files) CHECK(debug.run({file}).code == 0);
  }
}

TEST_CASE("failures of the benchmark leave snapshots that open at the desk") {
  Program const benchmark("benchmark"), debug("debug_snapshot");
  browser::TemporaryFolder const folder;
  auto const db = folder.file("r.db");
  // IDM never gets to the goal; the others have no time to plan.
  REQUIRE(benchmark
              .run({"--set", "cut_out", "--populations", "aggressive,inattentive,mixed", "--behaviors", "idm",
                    "--scenarios", "1", "--db", db})
              .code == 0);
  REQUIRE(benchmark
              .run({"--set", "cut_out", "--populations", "aggressive,inattentive,mixed", "--scenarios", "1",
                    "--plan-limit", "1e-9", "--db", db})
              .code == 0);
  std::vector<std::string> found;
  for (auto const& file : snapshots_in(folder.path() / "r_replays"))
    if (file.ends_with(".snapshot")) found.push_back(file);
  REQUIRE(found.size() == 27);
  for (auto const& file : found) {
    CAPTURE(file);
    auto const again = debug.run({file, "--cycles", "2", "--as-test"});
    CHECK(again.code == 0);
    bool const is_idm = has(again.out, "component idm");
    CHECK(has(again.out, is_idm ? "because   cut_out, scenario " : "1 cycle before error: its plans took longer"));
    CHECK(has(again.out, "bit-equal to what was recorded"));
    CHECK(has(again.out, "benchmark::thaw("));
  }
  auto const edited = debug.run({found.front(), "--edit", "behavior.desired_speed=3"});
  CHECK(edited.code == 1);
  CHECK(has(edited.out, "without the edit: "));
  auto const is_search = [](auto const& file) { return has(file, "mcts_hypothesis"); };
  debug.refuses(
      {*std::find_if(found.begin(), found.end(), is_search), "--edit", "behavior.options.budget.iterations=0"},
      "iterations");
  auto const is_mobil = [](auto const& file) { return has(file, "cut_out_mobil"); };
  debug.refuses({*std::find_if(found.begin(), found.end(), is_mobil), "--edit", "memory.lateral.change.target=99"},
                "remembers a lane that its road lacks");
  auto const elsewhere = debug.run({found.front(), "--map", CAMBIUM_SOURCE_DIR "/maps/merging.xodr"});
  CHECK(elsewhere.code == 2);
  CHECK(has(elsewhere.err, "was taken on another map"));
}

TEST_CASE("debug_snapshot names what is wrong with its file and options") {
  Program const record("record_snapshots"), debug("debug_snapshot");
  browser::TemporaryFolder const folder;
  REQUIRE(record.run({"--out", folder.path().string(), "--each-cycle", "--seconds", "0.5"}).code == 0);
  auto const file = snapshots_in(folder.path()).front();
  debug.refuses({"/nowhere.snapshot"}, "/nowhere.snapshot: the file cannot be opened");
  debug.refuses({CAMBIUM_SOURCE_DIR "/README.md"}, "is no snapshot of cambium");
  debug.refuses({file, "--edit", "behavior.jerk"}, "write behavior.KEY=VALUE");
  debug.refuses({file, "--edit", "behavior.jerky=1"}, "jerky");
  debug.refuses({file, "--edit", "behavior.jerk=-inf"}, "--edit 'behavior.jerk=-inf'");
  debug.refuses({file, "--edit", ""}, "--edit");
  debug.refuses({file, "--edit", "behavior.jerk=1", "--as-test"}, "--as-test");
  debug.refuses({file, "--cycles", "0"}, "--cycles");
  debug.refuses({file, "--replay", file}, "ends in .html");
  auto const page = folder.file("page.html");
  fs::copy(file, page);
  debug.refuses({page, "--replay", page}, "is the snapshot itself");
  CHECK(debug.run({"--edit", "behavior.jerk=1", page, "--cycles", "2"}).code == 1);
  CHECK(debug.run({file, "--edit", "behavior.jerk=1", "--edit", "memory.planned_at=0.5"}).code == 1);
  auto const bytes = content_of(file);
  auto const cut = folder.file("cut");
  std::ofstream(cut, std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  debug.refuses({cut}, "is cut short");
  auto changed = bytes;
  auto const time = changed.find("\ntime ") + 6;
  changed.replace(time, changed.find('\n', time) - time, "now");
  std::ofstream(cut, std::ios::binary) << support::sealed_again(changed);
  debug.refuses({cut}, cut + ": 'now' is no number");
  CHECK(record.run({"--out", "/proc/none"}).code == 2);
  record.refuses({"--out", folder.path().string(), "--embed-map", "--map", file}, file);
  CHECK(record.run({}).code == 2);
}
