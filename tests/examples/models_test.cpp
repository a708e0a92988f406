// README's tables of the models are what the program prints, and no model is missing there.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <regex>
#include <string>

#include "program.hpp"

namespace {

namespace fs = std::filesystem;
using program::content_of;
using program::Program;

std::string readme() { return content_of(CAMBIUM_SOURCE_DIR "/README.md"); }

/// What README has between the marks, without the lines of those.
std::string tables() {
  auto const text = readme();
  std::string const begin = "<!-- models -->\n", end = "<!-- end of models -->";
  auto const from = text.find(begin), to = text.find(end);
  REQUIRE(from != std::string::npos);
  REQUIRE(to != std::string::npos);
  return text.substr(from + begin.size(), to - from - begin.size());
}

}  // namespace

TEST_CASE("README's tables of the models are the program's output") {
  Program const program("models");
  if (!program.is_there()) return;
  auto const run = program.run({});
  REQUIRE(run.code == 0);
  bool const same = tables() == run.out;
  CHECK_MESSAGE(same, "replace what stands between the marks by the output of examples/run models");
}

TEST_CASE("every model that asserts its concept in the headers is in README's tables") {
  std::regex const assertion(
      "\nstatic_assert\\((Behavior|Dynamic|Execution|Observer)Model<(\\w+)[<>]|"
      "\nstatic_assert\\((Corridor)Filter<(\\w+)[<>]");
  auto const text = tables();
  int models = 0;
  for (auto const& file : fs::recursive_directory_iterator(CAMBIUM_SOURCE_DIR "/include/cambium")) {
    if (file.path().extension() != ".hpp") continue;
    auto const header = content_of(file.path());
    for (std::sregex_iterator match(header.begin(), header.end(), assertion), end; match != end; ++match) {
      auto const name = (*match)[2].str() + (*match)[4].str();
      CAPTURE(name);
      CHECK(text.find("| `" + name) != std::string::npos);
      ++models;
    }
  }
  CHECK(models >= 25);
}

TEST_CASE("the program shows one model with all of its parameters, and names those it knows where there is none") {
  Program const program("models");
  if (!program.is_there()) return;
  auto const one = program.run({"IdmClassic"});
  CHECK(one.code == 0);
  CHECK(one.out.find("| time_headway | 1.5 | s | [0, 20] | time gap kept to the leader |") != std::string::npos);
  CHECK(program.run({"idm_classic"}).out == one.out);
  auto const none = program.run({"idm_modern"});
  CHECK(none.code == 2);
  CHECK(none.err.find("idm_classic") != std::string::npos);
}

TEST_CASE("a model of one's own takes README 25 lines, with all that uses it") {
  auto const text = readme();
  auto const model = text.find("struct OptimalVelocity");
  REQUIRE(model != std::string::npos);
  auto const begin = text.rfind("```cpp\n", model) + 7, end = text.find("```", model);
  CHECK(std::count(text.begin() + static_cast<std::ptrdiff_t>(begin), text.begin() + static_cast<std::ptrdiff_t>(end),
                   '\n') <= 25);
}
