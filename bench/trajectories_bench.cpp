// Where traffic drives, as one hash for each model and map: two versions drive alike, bit for bit, if they print the
// same. Save the output of the version before a change, and compare: bench/run trajectories --compare FILE.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cambium/behavior.hpp"
#include "cambium/map/opendrive.hpp"

#include "yardstick/driven.hpp"

namespace cb = cambium;

namespace {

template <class... Behaviors>
void drive_all(std::string const& name, std::shared_ptr<cb::Map const> const& map, std::vector<std::string>& lines) {
  (lines.push_back(yardstick::driven<Behaviors>(name, map)), ...);
}

std::vector<std::string> drive() {
  std::vector<std::filesystem::path> files;
  auto const look_in = [&](std::filesystem::path const& folder) {
    if (!std::filesystem::exists(folder)) return;
    for (auto const& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".xodr") files.push_back(entry.path());
  };
  look_in(std::filesystem::path(CAMBIUM_SOURCE_DIR) / "maps");
  if (char const* const corpus = std::getenv("CAMBIUM_CORPUS")) look_in(std::filesystem::path(corpus) / "opendrive");
  std::sort(files.begin(), files.end());
  std::vector<std::string> lines;
  for (auto const& file : files)
    drive_all<cb::IdmClassic, cb::IdmLaneTracking, cb::AdaptiveCruiseControl, cb::IdmStochastic, cb::Mobil,
              cb::LaneChangeRuleBased, cb::ZipMerge, cb::Intersection, cb::RssConformant<cb::IdmClassic>,
              cb::RandomMacroActions, cb::Pedestrian>(file.filename().string(), cb::load_opendrive(file.string()).map,
                                                      lines);
  return lines;
}

/// Prints the lines of one list that the other lacks; returns how many.
int print_missing(char const* what, std::vector<std::string> const& lines, std::vector<std::string> const& others) {
  std::set<std::string> const known(others.begin(), others.end());
  int count = 0;
  for (auto const& line : lines)
    if (!known.contains(line)) std::printf("%s %s\n", what, line.c_str()), ++count;
  return count;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Hashes of trajectories, by model and map: equal hashes mean equal bits.", "trajectories");
  std::string before;
  program.add_option("--compare", before, "what an earlier version printed: only differences are shown")
      ->check(CLI::ExistingFile);
  CLI11_PARSE(program, argc, argv);
  auto const lines = drive();
  if (before.empty()) {
    for (auto const& line : lines) std::printf("%s\n", line.c_str());
    return 0;
  }
  std::vector<std::string> earlier;
  std::ifstream file(before);
  for (std::string line; std::getline(file, line);) earlier.push_back(line);
  int const different = print_missing("-", earlier, lines) + print_missing("+", lines, earlier);
  if (different == 0) std::printf("%zu models on maps drive as before, bit for bit\n", lines.size());
  return different == 0 ? 0 : 1;
}
