// The experiment of BARK's paper (Bernhard et al. 2020, Fig. 5): the ego changes lanes in dense traffic by tree search,
// while its prediction of the others is wrong by a given amount. Prints a table and writes a plot.

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cambium/core/write_file.hpp"
#include "cambium/map/building/map_builder.hpp"

#include "../common/command_line.hpp"
#include "../common/on_threads.hpp"
#include "../common/part_file.hpp"
#include "../common/report.hpp"
#include "plot.hpp"
#include "scenario.hpp"

namespace {

using lane_change::Cell;
using lane_change::End;
using lane_change::Outcome;

struct Settings {
  std::uint64_t scenarios = 600, seed = 2000;
  std::uint64_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::uint64_t> iterations{2000, 4000, 8000};
  std::vector<double> variations{0.0, 0.2, 0.4, 0.8};
  std::string preset = "cambium", json, out = "out/lane_change";
  examples::ParameterFile parameters{};
};

std::shared_ptr<cambium::Map const> two_lanes() {
  namespace m = cambium::map;
  m::MapBuilder builder;
  builder.add_road(
      {.id = "1", .line = m::lay_from({}, {{400.0, 0.0, 0.0}}), .sections = {{.right = m::equal_lanes(2)}}});
  return builder.build();
}

/// Runs all scenarios of a cell. The outcomes do not depend on the number of threads.
std::vector<Outcome> run(std::shared_ptr<cambium::Map const> const& map, Cell const& cell, Settings const& settings,
                         std::string const& what) {
  std::vector<Outcome> outcomes(settings.scenarios);
  auto const one = [&](std::uint64_t i) {
    outcomes[i] = play(sample(map, cell, settings.seed, static_cast<std::uint32_t>(i)));
  };
  examples::run_on_threads(settings.scenarios, settings.threads, one, what);
  return outcomes;
}

lane_change::Row judge(Cell const& cell, std::vector<Outcome> const& outcomes, double seconds, std::uint64_t threads) {
  lane_change::Row row;
  row.preset = cell.is_paper ? "paper" : "cambium";
  row.iterations = cell.iterations;
  row.variation = cell.variation;
  row.scenarios = outcomes.size();
  double steps = 0.0, all_steps = 0.0;
  for (auto const& outcome : outcomes) {
    row.success += outcome.end == End::success;
    row.collision += outcome.end == End::collision;
    row.time_out += outcome.end == End::time_out;
    if (outcome.end == End::success) steps += outcome.steps;
    all_steps += outcome.steps;
  }
  row.mean_steps = row.success > 0 ? steps / static_cast<double>(row.success) : std::nan("");
  row.iterations_per_second = all_steps * static_cast<double>(cell.iterations) / seconds /
                              static_cast<double>(std::min<std::uint64_t>(threads, outcomes.size()));
  return row;
}

void print(lane_change::Row const& row) {
  auto const share = [&](std::uint64_t count) {
    char text[128];
    std::snprintf(text, sizeof text, "%7llu: %-23s", static_cast<unsigned long long>(count),
                  examples::share_text(count, row.scenarios).c_str());
    return std::string(text);
  };
  char steps[16];
  std::snprintf(steps, sizeof steps, "%.1f", row.mean_steps);
  std::printf("%-8s %6zu  %4.0f %%  %s%s%s %5s   %7.0f\n", row.preset.c_str(), row.iterations, 100 * row.variation,
              share(row.success).c_str(), share(row.collision).c_str(), share(row.time_out).c_str(),
              row.success > 0 ? steps : "-", row.iterations_per_second);
  std::fflush(stdout);
}

/// Checks the file's parameters; prints them if that is asked for, and returns whether.
bool take_parameters(Settings& settings) {
  auto const take = [&](auto planner) { settings.parameters.take(planner); };
  if (settings.preset == "paper")
    take(lane_change::paper_planner());
  else
    take(lane_change::own_planner());
  auto others = lane_change::driver(lane_change::headway);
  settings.parameters.take(others);
  return settings.parameters.finish();
}

void run_grid(Settings& settings) {
  if (take_parameters(settings)) return;
  std::filesystem::path const folder(settings.out);
  examples::prepare_folder(folder);
  std::optional<examples::PartFile> json;  // opened now, so that a bad path fails before the work
  if (!settings.json.empty()) json.emplace(settings.json, examples::PartFile::Unfinished::kept);
  auto const map = two_lanes();
  std::printf(
      "%llu scenarios per cell: counts, and shares with their 95 %% intervals (Wilson); steps: mean of the\n"
      "successes; iterations/s: of one thread\n\n"
      "%-8s %6s  %6s        %-26s%-26s%-26s  %5s   %s\n",
      static_cast<unsigned long long>(settings.scenarios), "preset", "iter.", "var.", "success", "collision",
      "time-out", "steps", "iterations/s");
  std::vector<lane_change::Row> rows;
  auto const cells = std::to_string(settings.variations.size() * settings.iterations.size());
  for (auto const variation : settings.variations)
    for (auto const iterations : settings.iterations) {
      Cell const cell{settings.preset == "paper", static_cast<std::size_t>(iterations), variation, settings.parameters};
      auto const begin = std::chrono::steady_clock::now();
      auto const outcomes = run(map, cell, settings, "cell " + std::to_string(rows.size() + 1) + " of " + cells + ":");
      std::chrono::duration<double> const spent = std::chrono::steady_clock::now() - begin;
      rows.push_back(judge(cell, outcomes, spent.count(), settings.threads));
      if (json) json->append((rows.size() == 1 ? "[\n " : ",\n ") + as_json(rows.back()).dump(), "\n]\n");
      print(rows.back());
    }
  if (json) json->finish();
  auto const picture = folder / (settings.preset + ".svg");
  cambium::write_file(picture, lane_change::plot(rows));
  std::printf("\n%s  a plot of this table\n", picture.c_str());
}

void add_options(CLI::App& program, Settings& settings) {
  auto const number = [&](char const* name, std::uint64_t& target, std::uint64_t low, std::uint64_t high,
                          char const* sentence) {
    program.add_option(name, target, sentence)
        ->type_name("N")
        ->check(examples::whole_number(low, high))
        ->capture_default_str();
  };
  number("--scenarios", settings.scenarios, 1, 1'000'000, "number of scenarios per cell");
  number("--seed", settings.seed, 0, ~std::uint64_t{0} >> 1, "seed of all random numbers");
  number("--threads", settings.threads, 1, 1024, "number of threads; the outcomes do not depend on it");
  examples::add_list(program, "--iterations", settings.iterations, examples::whole_number(1, 100'000'000),
                     "numbers of iterations of a search, a cell each")
      ->type_name("N,...");
  examples::add_list(program, "--variation", settings.variations, examples::number(0.0, 0.99),
                     "by how much the others' headways are shorter than predicted, a cell each")
      ->type_name("SHARE,...");
  settings.parameters.add_options(program);
  program.add_option("--preset", settings.preset, "the paper's choices, or cambium's")
      ->check(CLI::IsMember({"paper", "cambium"}))
      ->capture_default_str();
  program
      .add_option("--json", settings.json, "write a row per cell, once all are done; until then they are in FILE.part")
      ->type_name("FILE")
      ->check(examples::not_empty());
  program.add_option("--out", settings.out, "folder for the plot")
      ->type_name("DIR")
      ->capture_default_str()
      ->check(examples::not_empty());
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App program("Repeats the lane change of BARK's paper: tree search with a wrong prediction.", "lane_change");
  add_options(program, settings);
  return examples::run_program(program, argc, argv, [&] { run_grid(settings); });
}
