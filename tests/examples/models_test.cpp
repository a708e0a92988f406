// The tables of the models in the rooms' READMEs are what the program prints, and no model is missing there.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>

#include "program.hpp"

using namespace program;

namespace {

fs::path const rooms = CAMBIUM_SOURCE_DIR "/include/cambium";

/// The rows that name a model, goal, driver or shape.
std::set<std::string> rows_of(std::string const& text) {
  std::set<std::string> rows;
  for (auto const& line : support::split(text, '\n'))
    if (line.starts_with("| `")) rows.insert(line);
  return rows;
}

/// What a room's README has between the marks, without the lines of those; nothing where it has none.
std::string tables(fs::path const& room) {
  if (!fs::exists(room / "README.md")) return {};
  auto const text = content_of(room / "README.md");
  std::string const begin = "<!-- models -->\n", end = "<!-- end of models -->";
  auto const from = text.find(begin), to = text.find(end);
  if (from == std::string::npos) return {};
  REQUIRE(to != std::string::npos);
  return text.substr(from + begin.size(), to - from - begin.size());
}

}  // namespace

TEST_CASE("the tables of the models in the rooms' READMEs are the program's output, row by row") {
  Program const program("models");
  auto const printed = rows_of(program.output({}));
  CHECK(printed.size() > 90);
  std::map<std::string, std::string> homes;  // of the rows
  for (auto const& room : fs::directory_iterator(rooms)) {
    for (auto const& row : rows_of(tables(room.path()))) {
      auto const file = (room.path() / "README.md").string();
      CHECK_MESSAGE(printed.contains(row), "examples/run models does not print this row of " << file << ": " << row);
      CHECK_MESSAGE(homes.emplace(row, file).second, "this row of " << file << " is in " << homes[row] << ", too");
    }
  }
  for (auto const& row : printed)
    CHECK_MESSAGE(homes.contains(row), "no README below include/cambium has this row of examples/run models: " << row);
}

TEST_CASE("every model, goal, driver and shape in the headers is in its room's tables") {
  struct Kind {
    fs::path folder;
    std::regex declaration;
    int least;
  };
  auto const kind = [](char const* folder, char const* declaration, int least) {
    return Kind{rooms / folder, std::regex(declaration), least};
  };
  for (auto const& one :
       {kind("behavior", "\nstatic_assert\\((?:BehaviorModel|CorridorFilter)<(\\w+)[<>]", 19),
        kind("planner", "\nstruct (Mcts|\\w+Planner) \\{", 4),
        kind("dynamics", "\nstatic_assert\\(DynamicModel<(\\w+)[<>]", 4),
        kind("execution", "\nstatic_assert\\(ExecutionModel<(\\w+)[<>]", 3),
        kind("observer", "\nstatic_assert\\(ObserverModel<(\\w+)[<>]", 4),
        kind("goal", "\nstruct ((?!GoalSituation)\\w+) \\{", 10), kind("behavior", "constexpr Idm (\\w+)\\(\\)", 5),
        kind("geometry", "constexpr Shape (\\w+)\\(\\)", 8)}) {
    auto const text = tables(one.folder);
    int found = 0;
    for (auto const& file : fs::recursive_directory_iterator(one.folder)) {
      if (file.path().extension() != ".hpp") continue;
      auto const header = content_of(file.path());
      for (std::sregex_iterator match(header.begin(), header.end(), one.declaration), end; match != end; ++match) {
        auto const name = (*match)[1].str();
        CAPTURE(name);
        CHECK(has(text, "| `" + name));
        ++found;
      }
    }
    CAPTURE(one.folder);
    CHECK(found >= one.least);
  }
}

TEST_CASE("the program shows one model with all of its parameters, and names those it knows where there is none") {
  Program const program("models");
  auto const one = program.output({"IdmClassic"});
  CHECK(has(one, "| law.time_headway | 1.5 | s | [0, 20] | time gap kept to the leader |"));
  CHECK(program.output({"idm_classic"}) == one);
  program.refuses({"idm_modern"}, "idm_classic");
}

TEST_CASE("a law, something to heed and a lane rule of one's own take README 20 lines each") {
  auto const text = content_of(CAMBIUM_SOURCE_DIR "/README.md");
  for (std::string const name : {"Gipps", "Fog", "Overtake"}) {
    CAPTURE(name);
    auto const begin = text.find("struct " + name + " {");
    REQUIRE(begin != std::string::npos);
    auto const end = text.find("\n};", begin);
    REQUIRE(end != std::string::npos);
    auto const at = [&](std::size_t i) { return text.begin() + static_cast<std::ptrdiff_t>(i); };
    CHECK(std::count(at(begin), at(end), '\n') < 19);
  }
}
