// What the sampled examples print and write, and what all examples say of a wrong command line.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "../../examples/common/version.hpp"
#include "../support/corpus.hpp"
#include "../support/scale.hpp"
#include "program.hpp"

using namespace program;

TEST_CASE("the table counts scenarios and gives intervals, and says how to give them more time") {
  Program const program("merging");
  browser::TemporaryFolder const folder;
  auto const said = program.output({"--scenarios", "8", "--steps", "5", "--out", folder.path().string()});
  for (char const* line : {"success        0 of 8    0.0 % (0.0-32.4)", "time-out       8 of 8  100.0 % (67.6-100.0)",
                           "8 scenarios ended by the limit of 5 steps (1 s); --steps raises it"})
    CHECK(has(said, line));
  auto const help = program.run({"--help"}).out;  // "N [200]" since CLI11 2.4
  CHECK((has(help, "--scenarios N=200") || has(help, "--scenarios N [200]")));
}

TEST_CASE("summary.json says who collided, when and in which scenario, with units, thresholds and the version") {
  Program const program("merging");
  browser::TemporaryFolder const folder;
  std::string const crossing = CAMBIUM_SOURCE_DIR "/maps/intersection_4way.xodr";  // where IDM drivers do collide
  REQUIRE(program.run({"--scenarios", "20", "--map", crossing, "--out", folder.path().string()}).code == 0);
  auto summary = nlohmann::json::parse(content_of(folder.path() / "summary.json"));
  CHECK(has(summary["cambium_version"].get<std::string>(), "."));
  CHECK(summary["units"]["mean_speed"] == "m/s");
  CHECK(summary["thresholds"]["hard_braking"]["acceleration_below"] == -4.0);
  std::size_t collisions = 0;
  for (auto const& outcome : summary["outcomes"]) collisions += outcome["outcome"] == "collision";
  REQUIRE(collisions > 0);
  REQUIRE(summary["collisions"].size() == collisions);
  CHECK(summary["counts"]["collision"] == collisions);
  for (auto const& collision : summary["collisions"]) {
    auto const& outcome = summary["outcomes"][collision["scenario"].get<std::size_t>()];
    CHECK(outcome["outcome"] == "collision");
    CHECK(collision["time"].get<double>() == doctest::Approx(0.2 * outcome["steps"].get<double>()));
    CHECK(collision["agents"].size() == 2);
    CHECK(collision["ego"].is_string());
  }
}

TEST_CASE("the trajectories' heading names units, and each line has lane, class and behaviour") {
  Program const program("merging");
  browser::TemporaryFolder const folder;
  REQUIRE(program.run({"--scenarios", "2", "--out", folder.path().string()}).code == 0);
  auto const lines = support::split(content_of(folder.path() / "trajectories.csv"), '\n');
  REQUIRE(lines.size() > 1);
  CHECK(lines[0] ==
        "scenario,time [s],agent,x [m],y [m],heading [rad],speed [m/s],acceleration [m/s^2],front [m],rear [m],"
        "width [m],road,lane,class,behavior,ego");
  std::set<std::string> classes;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    auto const cells = support::split(lines[i], ',');
    REQUIRE(cells.size() == 16);
    CHECK_FALSE(cells[11].empty());
    CHECK(std::stoi(cells[12]) != 0);
    classes.insert(cells[13]);
    CHECK(cells[14] == "idm_classic");
  }
  CHECK(classes == std::set<std::string>{"car", "truck"});
  CHECK(has(program.run({"--help"}).out, "acceleration is that of the step before"));
}

TEST_CASE("--replay chooses the scenario; without it a time-out is more telling than a hard braking") {
  Program const program("merging");
  browser::TemporaryFolder const folder;
  auto const run = [&](std::vector<std::string> words) {
    for (char const* word : {"--scenarios", "8", "--trajectories", "2", "--out"}) words.emplace_back(word);
    words.push_back(folder.path().string());
    return program.run(words);
  };
  auto const chosen = run({"--replay", "5"});
  REQUIRE(chosen.code == 0);
  CHECK(has(chosen.out, "plays scenario 5 (as --replay says)"));
  CHECK(has(content_of(folder.path() / "replay.html"), "scenario 5"));
  CHECK(has(content_of(folder.path() / "trajectories.csv"), "\n5,0.0,"));
  CHECK(has(run({"--steps", "5"}).out, "(a time-out)"));
  CHECK(has(run({}).out, "(the closest call)"));
  program.refuses({"--scenarios", "8", "--replay", "8"}, "--replay 8: the last scenario is number 7");
}

TEST_CASE("trajectories.csv is written while simulating, in memory that does not grow with it") {
  Program const program("merging");
  browser::TemporaryFolder const folder;
  if (std::system("/usr/bin/env python3 -c pass 2>/dev/null") != 0)
    return support::skip("no python3 to measure memory with: install it");
  auto const peak = [&](char const* trajectories) {  // [KiB]
    auto const out = folder.path() / trajectories;
    auto const command =
        "/usr/bin/env python3 -c \"import resource,subprocess,sys;"
        "subprocess.run(sys.argv[1:],stdout=subprocess.DEVNULL,check=True);"
        "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)\" " +
        program.command() + " --scenarios 300 --threads 2 --trajectories " + trajectories + " --out " +
        browser::quoted(out.string()) + " >" + browser::quoted(out.string() + ".txt");
    REQUIRE(std::system(command.c_str()) == 0);
    return std::strtol(content_of(out.string() + ".txt").c_str(), nullptr, 10);
  };
  auto const none = peak("0"), all = peak("300");
  REQUIRE(none > 0);
  auto const size = fs::file_size(folder.file("300/trajectories.csv")) / 1024;
  CAPTURE(size);
  if (!support::has_sanitizer) CHECK(all - none < static_cast<long>(size / 4));
  CHECK(std::distance(fs::directory_iterator(folder.path() / "300"), {}) == 3);  // no part is left
}

TEST_CASE("on a map whose merges are not at its edge the example says what is missing") {
  Program const program("merging");
  auto const map = corpus::find("opendrive/Town04.xodr");
  if (!map) return;
  browser::TemporaryFolder const folder;
  auto const run = program.run({"--scenarios", "1", "--map", map->string(), "--out", folder.file("never")});
  CHECK(run.code == 2);
  CHECK(has(run.err, "it has 432 merges, but"));  // behind warnings about the map
}

TEST_CASE("every example has --version") {
  for (std::string const name : {"merging", "highway", "intersection", "zip_merge", "lane_change", "map", "models",
                                 "ring", "make_maps", "embed_in_planner"})
    CHECK(Program(name).output({"--version"}) == name + " of cambium " + examples::version() + "\n");
}

TEST_CASE("an unknown option names near ones, and where all are listed") {
  Program const program("merging");
  auto const said = [&](std::vector<std::string> const& words) { return program.run(words).err; };
  CHECK(said({"--scenario", "3"}) ==
        "merging: there is no option --scenario; is it --scenarios? (--help lists the options)\n");
  CHECK(has(said({"--sede=3"}), "is it --seed"));
  CHECK(said({"--scenarios", "3", "--scenarios", "4"}) ==
        "merging: --scenarios: given more than once (--help lists the options)\n");
  CHECK(said({"--scenarios"}) == "merging: --scenarios: not as many values as it takes (--help lists the options)\n");
  CHECK(said({"--frobnicate"}) == "merging: there is no option --frobnicate (--help lists the options)\n");
  CHECK(said({"stray"}) == "merging: does not know what to do with 'stray' (--help lists the options)\n");
}

TEST_CASE("examples/run knows the version without building anything") {
  browser::TemporaryFolder const folder;
  auto const out = folder.path() / "out";
  auto const command =
      browser::quoted(CAMBIUM_SOURCE_DIR "/examples/run") + " --version >" + browser::quoted(out.string());
  CHECK(std::system(command.c_str()) == 0);
  CHECK(content_of(out) == "cambium " + examples::version() + "\n");
}

TEST_CASE("a terminal sees how far a long work is, a file does not") {
  Program const program("merging");
  browser::TemporaryFolder const folder;
  std::string const words =
      program.command() + " --scenarios 2000 --threads 1 --trajectories 0 --out " + folder.path().string();
  auto const seen = folder.path() / "seen", err = folder.path() / "err";
  if (std::system("script -qec true /dev/null >/dev/null 2>&1") == 0) {
    CHECK(std::system(("script -qec " + browser::quoted(words) + " /dev/null >" + seen.string()).c_str()) == 0);
    CHECK(has(content_of(seen), " of 2000, "));
    CHECK(has(content_of(seen), " s left"));
  } else {
    support::skip("no script (of util-linux) that can be a terminal: install it");
  }
  CHECK(std::system((words + " >/dev/null 2>" + err.string()).c_str()) == 0);
  CHECK(content_of(err).empty());
}
