// Traffic merges: samples dense situations at the on-ramp or lane drop of an OpenDRIVE map, rolls them forward with the
// Intelligent Driver Model, judges each, and writes figures, trajectories and a replay that plays in a browser.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <string>
#include <system_error>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/viewer/html_replay.hpp"

#include "../common/command_line.hpp"
#include "../common/map_file.hpp"
#include "report.hpp"

namespace cb = cambium;

namespace merging {
namespace {

/// Makes the folder and finds out now, not after the work, whether it takes files. Older results stay until there are
/// new ones.
void prepare(std::filesystem::path const& folder) {
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  if (problem)
    throw cb::Error(folder.string(), "the folder cannot be made (" + problem.message() + ")", "choose another --out");
  auto const probe = folder / ".probe";
  cb::write_file(probe, "");
  std::filesystem::remove(probe, problem);
}

/// "1 vehicle", "2 vehicles".
std::string counted(std::uint64_t count, std::string const& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

std::string in_words(Outcome const& outcome) {
  if (outcome.kind == Outcome::Kind::success) return "the ego merged";
  if (outcome.kind == Outcome::Kind::time_out) return "time ran out";
  return "agents " + to_string(outcome.collided_first) + " and " + to_string(outcome.collided_second) + " collide";
}

void write_results(std::filesystem::path const& folder, Site const& site, Settings const& settings,
                   std::vector<Outcome> const& outcomes, Totals const& totals) {
  auto const shown = totals.most_interesting;
  cb::Recording recording;
  auto const replayed = run_scenario(site, settings, shown, &recording);
  recording.title = "Merging on " + std::filesystem::path(settings.map_file).filename().string() + ", scenario " +
                    std::to_string(shown);
  recording.notes = {"Outcome: " + in_words(replayed) + "; " + counted(replayed.agents, "vehicle") + ", " +
                     counted(replayed.hard_brakings, "hard braking") + ", seed " + std::to_string(settings.seed)};
  std::string rows = trajectory_columns;
  for (std::uint64_t i = 0; i < outcomes.size(); ++i) rows += i == shown ? replayed.trajectory : outcomes[i].trajectory;
  auto const figures = summary(settings, site, outcomes, totals);
  cb::write_file(folder / "trajectories.csv", rows);
  cb::write_file(folder / "summary.json",
                 figures.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  cb::write_html_replay(folder / "replay.html", recording);
}

/// Runs all scenarios; what goes wrong is a matter of the map.
std::vector<Outcome> run_on(Site const& site, Settings const& settings) {
  try {
    return run_all(site, settings);
  } catch (cb::WorldError const& problem) {
    throw cb::MapError(settings.map_file, problem.what(), "look at it with examples/run map --picture");
  }
}

void run(Settings const& settings) {
  auto const site = find_site(examples::load_map(settings.map_file), settings.map_file);
  if (site.crossings > 0)
    std::cerr << "merging: " << settings.map_file << ": " << counted(site.crossings, "place")
              << " where the traffic's routes cross; nobody gives way there, so expect collisions\n";
  std::filesystem::path const folder(settings.out);
  prepare(folder);

  auto const begin = std::chrono::steady_clock::now();
  auto const outcomes = run_on(site, settings);
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  auto const totals = total(outcomes);

  write_results(folder, site, settings, outcomes, totals);
  print_table(settings, totals, seconds);
  std::cout << "  " << (folder / "replay.html").string() << "       plays scenario " << totals.most_interesting
            << " in a browser\n  " << (folder / "summary.json").string()
            << "      these figures and each scenario's outcome\n  " << (folder / "trajectories.csv").string()
            << "  paths of the first scenarios' vehicles and of the replayed one's\n";
}

}  // namespace
}  // namespace merging

int main(int argc, char** argv) {
  merging::Settings settings;
  CLI::App program("Samples dense merging situations, simulates and judges them.", "merging");
  auto const number = [&](char const* name, std::uint64_t& target, std::uint64_t low, std::uint64_t high,
                          char const* sentence) {
    program.add_option(name, target, sentence)
        ->type_name("N")
        ->check(examples::whole_number(low, high))
        ->capture_default_str();
  };
  number("--scenarios", settings.scenarios, 1, 10'000'000, "situations to sample");
  number("--seed", settings.seed, 0, ~std::uint64_t{0}, "of everything random");
  number("--threads", settings.threads, 1, 1024, "to run them on; the results do not depend on it");
  number("--steps", settings.steps, 1, 1'000'000, "of 0.2 s, after which a scenario is timed out");
  number("--trajectories", settings.trajectories, 0, 10'000'000,
         "scenarios whose trajectories are written, besides the replayed one");
  program.add_option("--map", settings.map_file, "OpenDRIVE map with a merge")
      ->type_name("FILE")
      ->capture_default_str();
  program.add_option("--out", settings.out, "folder for summary.json, trajectories.csv and replay.html")
      ->type_name("DIR")
      ->capture_default_str();
  return examples::run_program(program, argc, argv, [&] { merging::run(settings); });
}
