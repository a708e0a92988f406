// What the benchmark runner costs over a bare loop, how many rows a second the database takes, and how long a JSON set
// of 10 000 scenarios takes to read.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "cambium/benchmark.hpp"
#include "cambium/cambium.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/scenario/merging_site.hpp"
#include "cambium/scenario/scenario_file.hpp"

#include "yardstick/main.hpp"

namespace cb = cambium;

namespace {

using Traffic = cb::MergingSite::World;

cb::ScenarioSet<Traffic> merging(std::uint32_t scenarios) {
  std::string const file = CAMBIUM_SOURCE_DIR "/maps/merging.xodr";
  cb::ScenarioRecipe<Traffic> recipe{
      .map_file = file, .kind = cb::ScenarioRecipe<Traffic>::Kind::merging, .scenarios = scenarios};
  return {.scenarios = cb::draw(recipe, cb::load_opendrive(file).map)};
}

/// 10 000 scenarios of 20 vehicles in two flows.
void draw_flows(benchmark::State& state) {
  std::string const file = CAMBIUM_SOURCE_DIR "/maps/highway.xodr";
  auto const map = cb::load_opendrive(file).map;
  cb::ScenarioRecipe<Traffic> recipe{.map_file = file, .scenarios = 10'000};
  for (int const lane : {-2, -3}) {
    cb::LaneFlow<Traffic> flow{.from = map->find_lane("1", 0.0, lane)};
    flow.traffic = {.end = 400.0,
                    .speed = cb::Uniform{20.0, 25.0},
                    .desired_speed = cb::Uniform{22.0, 30.0},
                    .headway = cb::Uniform{0.8, 1.2}};
    recipe.flows.push_back(flow);
  }
  yardstick::measure_duration(state, [&] { benchmark::DoNotOptimize(cb::draw(recipe, map).size()); });
}

std::filesystem::path database() { return std::filesystem::temp_directory_path() / "cambium_benchmark_bench.db"; }

void remove_database() {
  for (char const* end : {"", "-wal", "-shm"}) std::filesystem::remove(database().string() + end);
}

constexpr std::uint32_t runs = 200;

/// The contender's runs alone, without jobs, locks and database.
void bare_loop(benchmark::State& state) {
  auto const set = merging(runs);
  auto const idm = cb::contender<Traffic>(cb::IdmClassic{.law = {.desired_speed = 22.0}});
  yardstick::measure_duration(state, [&] {
    for (auto const& scenario : set.scenarios)
      benchmark::DoNotOptimize(idm.run(scenario, {set.time_step, set.time_limit}, false).result.steps);
  });
}

/// The steps of these runs alone, without what judges them.
void step_loop(benchmark::State& state) {
  auto const set = merging(runs);
  yardstick::measure_duration(state, [&] {
    for (auto const& scenario : set.scenarios) {
      auto world = scenario.make_world();
      auto const ego = world.slot_of(scenario.ego);
      while (!world.reached_goal(ego) && world.time() < set.time_limit && world.step(set.time_step)) {
      }
      benchmark::DoNotOptimize(world.time());
    }
  });
}

void runner(benchmark::State& state, std::size_t threads) {
  auto const set = merging(runs);
  auto const idm = cb::contender<Traffic>(cb::IdmClassic{.law = {.desired_speed = 22.0}});
  remove_database();
  cb::ResultStore store(database());
  cb::BenchmarkOptions options;
  options.executor = cb::on_threads(threads);
  options.again = true;
  yardstick::measure_duration(state, [&] { cb::run_benchmark(set, std::vector{idm}, store, options); });
  remove_database();
}

void rows(benchmark::State& state) {
  remove_database();
  cb::ResultStore store(database());
  cb::ResultRow row;
  row.key = {.set_hash = 1, .scenario = 0, .behavior = "idm", .parameters_hash = 2};
  row.result.least_gap = 3.25;
  constexpr std::size_t count = 10'000;
  yardstick::measure_search(state, count, [&] {
    for (std::size_t i = 0; i < count; ++i) {
      ++row.key.scenario;
      store.add(row);
    }
    store.commit();
  });
  remove_database();
}

void read_json(benchmark::State& state) {
  auto const text = cb::to_json_text(merging(10'000));
  yardstick::measure_duration(
      state, [&] { benchmark::DoNotOptimize(cb::parse_scenarios<Traffic>(text, "/").scenarios.size()); });
}

void print_ratios(yardstick::Results const& results) {
  yardstick::print_targets(results, {{"benchmark/rows", 1e5},
                                     {"scenario/json_10000", 2000.0},
                                     {"scenario/draw_10000", 2000.0},
                                     {"scenario/flows_10000", 2000.0}});
  if (auto const ratio = yardstick::ratio(results, "benchmark/overhead", "benchmark/bare_loop"))
    std::printf("  runner over bare loop      %12.3f   target      1.05\n", *ratio);
  if (auto const ratio = yardstick::ratio(results, "benchmark/overhead", "benchmark/step_loop"))
    std::printf("  runner over steps alone    %12.2f   (judging included)\n", *ratio);
  if (auto const ratio = yardstick::ratio(results, "benchmark/overhead", "benchmark/threads_2"))
    std::printf("  2 threads over 1           %12.2f   target       1.9\n", *ratio);
}

}  // namespace

int main(int argc, char** argv) {
  yardstick::add("benchmark/bare_loop", bare_loop)->UseRealTime();
  yardstick::add("benchmark/step_loop", step_loop)->UseRealTime();
  yardstick::add("benchmark/overhead", [](benchmark::State& state) { runner(state, 1); })->UseRealTime();
  yardstick::add("benchmark/threads_2", [](benchmark::State& state) { runner(state, 2); })->UseRealTime();
  yardstick::add("benchmark/rows", rows)->UseRealTime();
  yardstick::add("scenario/json_10000", read_json);
  yardstick::add("scenario/draw_10000", [](benchmark::State& state) {
    yardstick::measure_duration(state, [] { benchmark::DoNotOptimize(merging(10'000).scenarios.size()); });
  });
  yardstick::add("scenario/flows_10000", draw_flows);
  return yardstick::run_benchmarks(argc, argv, "What the benchmark runner, its database and scenario files cost.",
                                   print_ratios);
}
