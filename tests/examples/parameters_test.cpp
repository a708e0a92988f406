// `--parameters FILE` and `--print-parameters`, which all examples that run behaviours have.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "program.hpp"

using namespace program;

namespace {

std::string written(fs::path const& file, std::string const& text) {
  std::ofstream(file) << text;
  return file.string();
}

std::vector<std::string> joined(std::vector<std::string> words, std::vector<std::string> const& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST_CASE("sampled examples: printed parameters read back as the same results, changed ones give others") {
  struct Case {
    std::string name, change;
  };
  for (auto const& example : {Case{"merging", R"({"idm_classic": {"law": {"time_headway": 3}}})"},
                              Case{"zip_merge", R"({"format": 1, "zip_merge": {"law": {"time_headway": 3}}})"},
                              Case{"highway", R"({"mobil": {"law": {"desired_speed": 18}}})"},
                              Case{"intersection", R"({"junction_traffic": {"most_vehicles": 5}})"}}) {
    auto const &name = example.name, &change = example.change;
    CAPTURE(name);
    Program const program(name);
    browser::TemporaryFolder const folder;
    auto const summary = [&](std::string const& out, std::vector<std::string> const& more) {
      program.output(joined({"--scenarios", "60", "--out", folder.file(out)}, more));
      return content_of(folder.file(out + "/summary.json"));
    };
    auto const printed = program.output({"--scenarios", "60", "--print-parameters"});
    CHECK(has(printed, "\"format\": 1"));
    auto const usual = summary("usual", {});
    CHECK(value_of(usual, "scenarios") == 60.0);
    CHECK(summary("same", {"--parameters", written(folder.path() / "same.json", printed)}) == usual);
    auto const file = written(folder.path() / "other.json", change);
    CHECK(summary("other", {"--parameters", file}) != usual);
    CHECK(program.run({"--scenarios", "60", "--print-parameters", "--parameters", file}).out != printed);
  }
}

TEST_CASE("a wrong file of parameters is refused with file, key and remedy") {
  Program const program("highway");
  browser::TemporaryFolder const folder;
  auto const refusal = [&](std::string const& text) {
    auto const file = written(folder.path() / "p.json", text);
    auto const run = program.run({"--parameters", file, "--out", folder.file("out")});
    CHECK(run.code == 2);
    CHECK(run.out.empty());
    CHECK(run.err.find("highway: " + file + ": ") == 0);
    return run.err.substr(run.err.find("p.json: ") + 8);
  };
  CHECK(refusal(R"({"mobill": {}})") == "this program has no parameters \"mobill\"; is it mobil?\n");
  CHECK(refusal(R"({"mobil": {"lateral": {"rule": {"politness": 1}}}})") ==
        "mobil.lateral.rule: has no field \"politness\"; is it politeness?\n");
  // Keys of earlier versions, by the name of a field, of its type, and of a field in it.
  CHECK(refusal(R"({"mobil": {"politeness": 1}})") ==
        "mobil: has no field \"politeness\"; is it lateral.rule.politeness?\n");
  CHECK(refusal(R"({"mobil": {"idm": {"desired_speed": 9}}})") == "mobil: has no field \"idm\"; is it law?\n");
  CHECK(refusal(R"({"mobil": {"changing": {"safe_gap": 1}}})") ==
        "mobil: has no field \"changing\"; its safe_gap may be lateral.safe_gap\n");
  CHECK(refusal(R"({"mobil": {"law": {"desired_speed": "fast"}}})") ==
        "mobil.law.desired_speed: is \"fast\"; give a number\n");
  CHECK(refusal(R"({"mobil": {"law": {"time_headway": -1}}})").find("mobil.law.time_headway: is -1 s; give a value") ==
        0);
  CHECK(refusal(R"({"format": 2})") == "format: is not 1, the one that this version reads; write \"format\": 1\n");
  CHECK(refusal("[1]").find("is a list; give an object") == 0);
  program.refuses({"--parameters", "nowhere.json"}, "nowhere.json: the file cannot be opened");
}

TEST_CASE("ring, lane_change, replace_agents, soak and benchmark take parameters") {
  struct Case {
    std::string name, right, wrong, message;
    std::vector<std::string> words;
  };
  Case const cases[] = {{"ring",
                         R"({"idm": {"time_headway": 0.7}})",
                         R"({"idm_classic": {}})",
                         "no parameters \"idm_classic\"",
                         {"--length", "600", "--minutes", "1", "--density", "30"}},
                        {"lane_change",
                         R"({"idm_classic": {"law": {"desired_speed": 9}}})",
                         R"({"mcts": {"option": {}}})",
                         "is it options?",
                         {"--scenarios", "3", "--iterations", "20", "--variation", "0.4"}},
                        {"replace_agents",
                         R"({"mobil": {"law": {"desired_speed": 3}}})",
                         R"({"mobil": {"law": {"exponent": []}}})",
                         "mobil.law.exponent: is []",
                         {"--recordings", "1", "--iterations", "2"}},
                        {"soak",
                         R"({"urban_driver": {"law": {"time_headway": 3}}})",
                         R"({"urban_driver": {"heed": {}}})",
                         "is it heeds?",
                         {"--map", CAMBIUM_SOURCE_DIR "/maps/lane_drop.xodr", "--minutes", "2", "--threads", "1"}},
                        {"benchmark",
                         R"({"idm": {"law": {"time_headway": 3}}})",
                         R"({"mcts": {}})",
                         "is it mcts_",
                         {"--set", "merging", "--behaviors", "idm", "--scenarios", "3", "--threads", "1"}}};
  for (auto const& example : cases) {
    auto const &name = example.name, &right = example.right, &wrong = example.wrong, &message = example.message;
    auto const& words = example.words;
    CAPTURE(name);
    Program const program(name);
    browser::TemporaryFolder const folder;
    bool const has_json = name != "ring";
    auto const figures = [&](std::string const& label, std::vector<std::string> const& more) {
      auto all = joined(words, more);
      auto const file = folder.file(label + ".json");
      if (has_json) all = joined(all, {"--json", file});
      if (name == "benchmark") all = joined(all, {"--db", folder.file(label + ".db")});
      if (name == "ring" || name == "lane_change") all = joined(all, {"--out", folder.file(label)});
      auto const run = program.run(all);
      CAPTURE(run.err);
      CHECK(run.code == 0);
      return content_of(has_json ? file : folder.file(label + "/summary.json"));
    };
    auto const usual = figures("usual", {});
    CHECK(usual.size() > 100);
    CHECK(figures("changed", {"--parameters", written(folder.path() / "right.json", right)}) != usual);
    auto const printed = program.output({"--print-parameters"});
    auto const again = written(folder.path() / "printed.json", printed);
    CHECK(program.output({"--parameters", again, "--print-parameters"}) == printed);
    auto const refused = written(folder.path() / "wrong.json", wrong);
    program.refuses({"--parameters", refused}, refused);
    program.refuses({"--parameters", refused}, message);
  }
}
