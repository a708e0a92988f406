// The examples that sample scenarios, as a user meets them: the built programs, run on the command line.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../support/corpus.hpp"
#include "program.hpp"

namespace {

using namespace program;

std::string own_map(std::string const& name) { return CAMBIUM_SOURCE_DIR "/maps/" + name + ".xodr"; }

constexpr char const* all_examples[] = {"merging", "zip_merge", "highway", "intersection"};

}  // namespace

TEST_CASE("--help lists the options of the sampled examples and is no error") {
  for (auto const* name : all_examples) {
    auto const help = Program(name).output({"--help"});
    for (char const* word : {"--scenarios", "--seed", "--threads", "--steps", "--trajectories", "--map", "--out",
                             "--help", "success:", "off-road:"}) {
      CAPTURE(name);
      CAPTURE(word);
      CHECK(has(help, word));
    }
  }
}

TEST_CASE("a mistake in the command line, the map or the folder gets one line that names it, and exit code 2") {
  browser::TemporaryFolder const folder;
  auto const file = [&](char const* name, std::string const& text) {
    std::ofstream(folder.file(name)) << text;
    return folder.file(name);
  };
  // Below a file nobody can make a folder, the superuser neither.
  auto const below = file("file", "") + "/below";
  auto const broken = file("broken.xodr", "<OpenDRIVE><road id=\"1\""), other = file("other.xodr", "<OpenSCENARIO/>"),
             empty = file("empty.xodr", ""), cut = file("cut.xodr", content_of(own_map("merging")).substr(0, 4000));
  struct Case {
    std::vector<std::string> words;
    std::string named;
  };
  std::vector<Case> const cases{{{"--frobnicate", "3"}, "--frobnicate"},
                                {{"stray"}, "stray"},
                                {{"--scenarios"}, "--scenarios"},
                                {{"--scenarios", "many"}, "--scenarios: needs a whole number"},
                                {{"--scenarios", "0"}, "--scenarios"},
                                {{"--scenarios=-3"}, "--scenarios"},
                                {{"--scenarios", "1e3"}, "'1e3'"},
                                {{"--seed", "99999999999999999999"}, "--seed"},
                                {{"--threads", "0"}, "--threads"},
                                {{"--steps", "2.5"}, "--steps"},
                                {{"--map", "nowhere.xodr"}, "nowhere.xodr"},
                                {{"--map", ""}, "--map"},
                                {{"--out", ""}, "--out"},
                                {{"--map", broken}, broken},
                                {{"--map", other}, other},
                                {{"--map", empty}, empty},
                                {{"--map", cut}, cut},
                                {{"--map", folder.path().string()}, folder.path().string()},
                                {{"--scenarios", "1", "--out", below}, below}};
  for (std::string const name : all_examples) {
    CAPTURE(name);
    for (auto const& [words, named] : cases) Program(name).refuses(words, named);
    auto const unfit = own_map(name == "highway" ? "roundabout" : "highway");
    Program(name).refuses({"--map", unfit}, unfit);
  }
}

TEST_CASE("the same seed gives the same files on any number of threads, another seed others") {
  struct Case {
    std::string name, map;
  };
  std::vector<Case> cases{{"merging", own_map("merging")},
                          {"zip_merge", own_map("lane_drop")},
                          {"highway", own_map("highway")},
                          {"intersection", own_map("intersection_4way")},
                          {"intersection", own_map("intersection_3way")},
                          {"intersection", own_map("roundabout")}};
  for (auto const& [name, map] : {Case{"merging", "DR_DEU_Merging_MT_v01_shifted"},
                                  {"merging", "DR_DEU_Merging_MT_v01_centered"},
                                  {"merging", "DR_CHN_Merging_ZS_partial_v02"},
                                  {"highway", "e6mini-lht"}})
    if (auto const file = corpus::find("opendrive/" + map + ".xodr")) cases.push_back({name, file->string()});
  for (auto const& [name, map] : cases) {
    CAPTURE(name);
    CAPTURE(map);
    browser::TemporaryFolder const folder;
    auto const run = [&](char const* out, char const* seed, char const* threads) {
      Program(name).output(
          {"--scenarios", "12", "--map", map, "--seed", seed, "--threads", threads, "--out", folder.file(out)});
    };
    run("1", "7", "1");
    run("2", "7", "2");
    run("other", "8", "2");
    for (std::string const file : {"/summary.json", "/trajectories.csv"}) {
      CAPTURE(file);
      auto const one = content_of(folder.file("1" + file));
      CHECK_FALSE(one.empty());
      CHECK(one == content_of(folder.file("2" + file)));
      CHECK(one != content_of(folder.file("other" + file)));
    }
    auto const trajectories = content_of(folder.file("1/trajectories.csv"));
    CHECK(trajectories.substr(0, trajectories.find('\n')).ends_with(",ego"));
    CHECK(has(trajectories, ",1\n"));
    CHECK(has(content_of(folder.file("1/replay.html")), "</html>"));
    auto const summary = content_of(folder.file("1/summary.json"));
    CHECK(value_of(summary, "scenarios") == 12.0);
    CHECK(value_of(summary, "seed") == 7.0);
    CHECK(count(summary, "\"outcome\":") == 12);
    CHECK_FALSE(has(summary, "second"));  // no times: they are never the same
  }
}

TEST_CASE("nobody collides; all merge and get through junctions, cars take their exits, and lanes are changed") {
  constexpr double most = 1e9;
  struct Case {
    std::string name, map, scenarios;
    double least_success;
    struct Bound {
      std::string key;
      double low, high;
    };
    std::vector<Bound> bounds;
  };
  std::vector<Case> cases{
      {"highway", "highway_exit", "40", 0.601, {{"off_road", 0, 0}, {"lane_changes", 101, most}, {"exits", 1, 1}}}};
  for (char const* map : {"lane_drop", "merging"})
    cases.push_back({"zip_merge", map, "60", 1.0, {{"pairs_at_merge", 201, most}}});
  for (char const* map : {"intersection_4way", "intersection_3way", "roundabout"})
    cases.push_back({"intersection", map, "20", 1.0, {{"agents", 40, most}}});
  for (auto const& [name, map, scenarios, least_success, bounds] : cases) {
    CAPTURE(name);
    CAPTURE(map);
    browser::TemporaryFolder const folder;
    Program(name).output({"--scenarios", scenarios, "--map", own_map(map), "--out", folder.file("out")});
    auto const summary = content_of(folder.file("out/summary.json"));
    CHECK(value_of(summary, "collision") == 0.0);
    CHECK(value_of(summary, "success") >= least_success);
    for (auto const& [key, low, high] : bounds) {
      CAPTURE(key);
      CHECK(value_of(summary, key) >= low);
      CHECK(value_of(summary, key) <= high);
    }
    if (name == "zip_merge")  // seldom two of one lane one after the other
      CHECK(value_of(summary, "of_one_lane") < 0.4 * value_of(summary, "pairs_at_merge"));
  }
}

TEST_CASE("the READMEs have the figures that the merging example prints, on each map") {
  Program const program("merging");
  browser::TemporaryFolder const folder;
  auto const front = content_of(CAMBIUM_SOURCE_DIR "/README.md");
  for (auto const& line : support::split(program.output({"--scenarios", "200", "--out", folder.file("front")}), '\n')) {
    if (has(line, "agent-steps")) break;  // a time
    CHECK_MESSAGE(has(front, line + '\n'), "README.md lacks this line of examples/run merging: " << line);
  }
  int rows = 0;
  for (auto const& line : support::split(content_of(CAMBIUM_SOURCE_DIR "/examples/README.md"), '\n')) {
    auto const cells = support::split(line, '|');
    if (cells.size() != 6 || !(has(cells[1], ".xodr") || has(cells[1], "`DR_"))) continue;
    auto const name = support::split(cells[1], '`').at(1);
    auto const map = has(name, ".xodr") ? std::optional<fs::path>(fs::path(CAMBIUM_SOURCE_DIR) / name)
                                        : corpus::find("opendrive/" + name + ".xodr");
    if (!map) continue;
    CAPTURE(line);
    program.output({"--scenarios", "200", "--seed", "7", "--map", map->string(), "--out", folder.file("row")});
    auto const summary = content_of(folder.file("row/summary.json"));
    std::size_t cell = 2;
    for (char const* key : {"success", "collision", "time_out", "off_road"})
      CHECK(value_of(summary, key) == doctest::Approx(std::stod(cells[cell++]) / 100.0));
    ++rows;
  }
  CHECK(rows >= 2);
}

namespace {

struct Place {
  double x{}, y{};
  [[nodiscard]] std::string text() const { return std::to_string(x) + ',' + std::to_string(y); }
};

/// The vehicles' places by frame and id, of one scenario of trajectories.csv.
std::vector<std::map<std::string, Place>> read_frames(fs::path const& file, double scenario) {
  std::vector<std::map<std::string, Place>> frames;
  std::string time;
  for (auto const& cells : corpus::table(file)) {
    if (std::stod(cells[0]) != scenario) continue;
    if (frames.empty() || cells[1] != time) frames.emplace_back();
    time = cells[1];
    frames.back()[cells[2]] = {std::stod(cells[3]), std::stod(cells[4])};
  }
  return frames;
}

/// The id that stands before the mark of the ego in the page's data.
std::string ego_of(std::string const& page) {
  auto const end = page.find("\",1,\"ego\"");
  auto const begin = page.rfind('"', end - 1) + 1;
  return end == std::string::npos ? "" : page.substr(begin, end - begin);
}

bool is_free(std::map<std::string, Place> const& frame, Place const& at) {
  for (auto const& [id, place] : frame)
    if (std::hypot(place.x - at.x, place.y - at.y) < 20.0) return false;
  return true;
}

}  // namespace

TEST_CASE("replay.html plays the replayed scenario in a browser, with the ego where trajectories.csv has it") {
  auto const chromium = browser::find();
  if (!chromium) return;
  for (std::string const name : {"merging", "intersection"}) {
    CAPTURE(name);
    browser::TemporaryFolder const folder;
    Program(name).output({"--scenarios", "12", "--seed", "7", "--out", folder.file("out")});
    auto const page = folder.file("out/replay.html");
    auto const scenario = value_of(content_of(folder.file("out/summary.json")), "replayed_scenario");
    auto const frames = read_frames(folder.file("out/trajectories.csv"), scenario);
    auto const ego = ego_of(content_of(page));
    REQUIRE(frames.size() > 20);
    REQUIRE(frames[0].contains(ego));
    auto const document = browser::document(*chromium, page, "play", 2000);
    CHECK(browser::attribute(document, "<body", "data-ready") == std::to_string(frames.size()));
    CHECK(browser::attribute(document, "<input id=\"slider\"", "max") == std::to_string(frames.size() - 1));
    int const shown = std::stoi("0" + browser::attribute(document, "<body", "data-frame"));
    CHECK(shown > 2);
    CHECK(shown < static_cast<int>(frames.size()));
    if (name != "merging") continue;

    // A later frame in which the ego is where at first only the road is.
    std::size_t later = 20;
    while (later < frames.size() && !(frames[later].contains(ego) && is_free(frames[0], frames[later].at(ego))))
      ++later;
    REQUIRE(later < frames.size());
    std::string const places = "&probe=" + frames[0].at(ego).text() + ';' + frames[later].at(ego).text();
    auto const first = browser::pixels(*chromium, page, "frame=0" + places),
               last = browser::pixels(*chromium, page, "frame=" + std::to_string(later) + places);
    REQUIRE(first.size() == 2);
    REQUIRE(last.size() == 2);
    auto const& asphalt = first[1];
    CHECK(first[0] != asphalt);
    CHECK(last[1] != asphalt);
    CHECK(last[1] == first[0]);
  }
}
