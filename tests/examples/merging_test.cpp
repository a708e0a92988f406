// The main example as a user meets it: the built program, run on the command line.
#include <doctest/doctest.h>

#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "../support/corpus.hpp"
#include "../support/skipped.hpp"
#include "../viewer/browser.hpp"
#include "program.hpp"

namespace {

namespace fs = std::filesystem;
using program::content_of;
using program::Program;
using program::Run;

/// The whole number that follows `key` in a text; -1 where the key is missing.
long number_after(std::string const& text, std::string const& key) {
  auto const at = text.find(key);
  return at == std::string::npos ? -1 : std::strtol(text.c_str() + at + key.size(), nullptr, 10);
}

std::size_t occurrences(std::string const& text, std::string const& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// Runs 12 scenarios into `folder` / `name` with these further options.
Run run_into(Program const& program, fs::path const& folder, std::string const& name, std::vector<std::string> words) {
  for (char const* word : {"--scenarios", "12", "--out"}) words.emplace_back(word);
  words.push_back((folder / name).string());
  return program.run(words);
}

void check_same_on_any_threads(Program const& program, std::vector<std::string> const& map) {
  browser::TemporaryFolder const folder;
  auto const with = [&](std::vector<std::string> more) {
    more.insert(more.end(), map.begin(), map.end());
    return more;
  };
  for (char const* threads : {"1", "2"}) {
    auto const run = run_into(program, folder.path(), threads, with({"--seed", "7", "--threads", threads}));
    CHECK(run.code == 0);
    CHECK(run.err.empty());
  }
  REQUIRE(run_into(program, folder.path(), "other", with({"--seed", "8"})).code == 0);
  for (char const* file : {"summary.json", "trajectories.csv"}) {
    CAPTURE(file);
    auto const one = content_of(folder.path() / "1" / file);
    CHECK_FALSE(one.empty());
    CHECK(one == content_of(folder.path() / "2" / file));
    CHECK(one != content_of(folder.path() / "other" / file));
  }
  auto const summary = content_of(folder.path() / "1" / "summary.json");
  CHECK(number_after(summary, "\"scenarios\":") == 12);
  CHECK(number_after(summary, "\"seed\":") == 7);
  CHECK(occurrences(summary, "\"outcome\":") == 12);
  CHECK(summary.find("second") == std::string::npos);  // no times: they are never the same
}

}  // namespace

TEST_CASE("--help lists the options and is no error") {
  Program const program("merging");
  if (!program.is_there()) return;
  auto const help = program.run({"--help"});
  CHECK(help.code == 0);
  CHECK(help.err.empty());
  for (char const* option : {"--scenarios", "--seed", "--threads", "--steps", "--map", "--out", "--help"}) {
    CAPTURE(option);
    CHECK(help.out.find(option) != std::string::npos);
  }
}

TEST_CASE("a mistake in the command line, the map or the folder gets one line that names it, and exit code 2") {
  Program const program("merging");
  if (!program.is_there()) return;
  browser::TemporaryFolder const folder;
  auto const file = [&](char const* name, std::string const& text) {
    auto const path = (folder.path() / name).string();
    std::ofstream(path) << text;
    return path;
  };
  // Below a file nobody can make a folder, the superuser neither.
  auto const below = file("file", "") + "/below";
  auto const broken = file("broken.xodr", "<OpenDRIVE><road id=\"1\""), other = file("other.xodr", "<OpenSCENARIO/>"),
             empty = file("empty.xodr", "");
  auto const cut = file("cut.xodr", content_of(CAMBIUM_SOURCE_DIR "/maps/merging.xodr").substr(0, 4000));
  struct Case {
    std::vector<std::string> words;
    std::string named;
  };
  Case const cases[] = {{{"--frobnicate", "3"}, "--frobnicate"},
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
                        {{"--map", broken}, broken},
                        {{"--map", other}, other},
                        {{"--map", empty}, empty},
                        {{"--map", cut}, cut},
                        {{"--map", folder.path().string()}, folder.path().string()},
                        {{"--map", CAMBIUM_SOURCE_DIR "/maps/highway.xodr"}, "highway.xodr"},
                        {{"--scenarios", "1", "--out", below}, below}};
  for (auto const& wrong : cases) {
    CAPTURE(wrong.named);
    auto const run = program.run(wrong.words);
    CAPTURE(run.err);
    CHECK(run.code == 2);
    CHECK(run.out.empty());
    CHECK(occurrences(run.err, "\n") == 1);
    CHECK(run.err.ends_with("\n"));
    CHECK(run.err.find(wrong.named) != std::string::npos);
  }
}

TEST_CASE("the same seed gives the same files on any number of threads, another seed others") {
  Program const program("merging");
  if (!program.is_there()) return;
  check_same_on_any_threads(program, {});
}

TEST_CASE("so it does on the corpus' maps of real merges") {
  Program const program("merging");
  if (!program.is_there()) return;
  for (std::string const name : {"DR_DEU_Merging_MT_v01_shifted.xodr", "DR_DEU_Merging_MT_v01_centered.xodr",
                                 "DR_CHN_Merging_ZS_partial_v02.xodr"}) {
    CAPTURE(name);
    if (auto const map = corpus::find("opendrive/" + name))
      check_same_on_any_threads(program, {"--map", map->string()});
  }
}

namespace {

struct Place {
  double x{}, y{};
  [[nodiscard]] std::string text() const { return std::to_string(x) + ',' + std::to_string(y); }
};

/// The vehicles' places by frame and id, of one scenario of trajectories.csv.
std::vector<std::map<std::string, Place>> read_frames(fs::path const& file, long scenario) {
  std::vector<std::map<std::string, Place>> frames;
  std::ifstream stream(file);
  std::string line, time;
  for (std::getline(stream, line); std::getline(stream, line);) {
    std::istringstream row(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (cells.size() < 5 || std::stol(cells[0]) != scenario) continue;
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

/// The page's colours at these places in one frame.
std::vector<std::string> colours(fs::path const& chromium, fs::path const& page, std::size_t frame,
                                 std::vector<Place> const& places) {
  std::string hash = "frame=" + std::to_string(frame) + "&probe=";
  for (auto const& place : places) hash += place.text() + ';';
  std::istringstream text(browser::attribute(browser::document(chromium, page, hash), "<body", "data-pixel"));
  std::vector<std::string> list;
  for (std::string colour; std::getline(text, colour, ';');) list.push_back(colour);
  return list;
}

}  // namespace

TEST_CASE("replay.html plays the replayed scenario in a browser, with the ego where trajectories.csv has it") {
  Program const program("merging");
  if (!program.is_there()) return;
  auto const chromium = browser::find();
  if (!chromium) {
    support::skip("no browser: install chromium");
    return;
  }
  browser::TemporaryFolder const folder;
  REQUIRE(run_into(program, folder.path(), "out", {"--seed", "7"}).code == 0);
  auto const page = folder.path() / "out" / "replay.html";
  auto const scenario = number_after(content_of(folder.path() / "out" / "summary.json"), "\"replayed_scenario\":");
  auto const frames = read_frames(folder.path() / "out" / "trajectories.csv", scenario);
  auto const ego = ego_of(content_of(page));
  REQUIRE(frames.size() > 20);
  REQUIRE(frames[0].contains(ego));

  // A later frame in which the ego is where at first only the road is.
  std::size_t later = 20;
  while (later < frames.size() && !(frames[later].contains(ego) && is_free(frames[0], frames[later].at(ego)))) ++later;
  REQUIRE(later < frames.size());
  Place const start = frames[0].at(ego), end = frames[later].at(ego);

  auto const document = browser::document(*chromium, page, "play", 2000);
  CHECK(browser::attribute(document, "<body", "data-ready") == std::to_string(frames.size()));
  CHECK(browser::attribute(document, "<input id=\"slider\"", "max") == std::to_string(frames.size() - 1));
  int const shown = std::stoi("0" + browser::attribute(document, "<body", "data-frame"));
  CHECK(shown > 2);
  CHECK(shown < static_cast<int>(frames.size()));

  auto const first = colours(*chromium, page, 0, {start, end}), last = colours(*chromium, page, later, {start, end});
  REQUIRE(first.size() == 2);
  REQUIRE(last.size() == 2);
  auto const& asphalt = first[1];
  CHECK(first[0] != asphalt);
  CHECK(last[1] != asphalt);
  CHECK(last[1] == first[0]);
}
