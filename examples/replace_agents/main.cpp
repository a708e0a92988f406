// Replaces agents of recorded traffic by behaviour models, as the paper of BARK does with a merge of the INTERACTION
// data set (Bernhard, Esterle, Hart, Kessler 2020, section V-B, Table I): who collides, and how far does he get away
// from what was recorded? Without --tracks it records merges of its own (see zip_recording.hpp).

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/open_loop/static_trajectory.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/metrics/displacement.hpp"
#include "cambium/evaluation/metrics/per_agent.hpp"
#include "cambium/map/opendrive/writer.hpp"
#include "cambium/planner/mcts/mcts.hpp"
#include "cambium/scenario/dataset/recorded_scenario.hpp"
#include "cambium/scenario/dataset/track_table.hpp"

#include "../common/command_line.hpp"
#include "../common/map_file.hpp"
#include "../common/on_threads.hpp"
#include "../common/parameter_file.hpp"
#include "zip_recording.hpp"

namespace replace_agents {
namespace {

using Predicted =
    cb::World<cb::BehaviorSet<cb::MacroActions, cb::IdmClassic>, cb::InterpolateExecution, cb::SingleTrack>;
using Search = cb::Mcts<Predicted>;
using Sim = cb::World<cb::BehaviorSet<cb::StaticTrajectory, cb::IdmClassic, cb::Mobil, Search, cb::ZipMerge>,
                      cb::InterpolateExecution, cb::SingleTrack>;

constexpr double dt = 0.2;                                    // [s]
constexpr double minimum_distances[] = {2.0, 3.0, 4.0, 5.0};  // of P1 to P4 [m], the paper's Table II
constexpr char const* models[] = {"IDM", "MOBIL", "MCTS", "Zip"};
constexpr std::size_t parameter_sets = std::size(minimum_distances), columns = std::size(models) * parameter_sets;

struct Settings {
  std::string tracks, map, json, write;
  std::uint64_t recordings = 5, seed = 1, iterations = 100, threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::uint64_t> ids{65, 66, 67, 68};
  double begin = -1e9, end = 1e9;
  examples::ParameterFile parameters{};
};

/// The agents that a row of the table replaces.
struct AgentSet {
  std::string name;
  std::vector<std::int64_t> ids;
};

/// The paper's seven sets, of the agents a, b, c, d in the order in which they pass the merge.
std::vector<AgentSet> agent_sets(std::vector<std::uint64_t> const& ids) {
  auto const id = [&](std::size_t i) { return static_cast<std::int64_t>(ids[i]); };
  return {{"A0", {id(1)}},
          {"A1", {id(3)}},
          {"A2", {id(1), id(3)}},
          {"A3", {id(0)}},
          {"A4", {id(2)}},
          {"A5", {id(0), id(2)}},
          {"A6", {id(1), id(3), id(0), id(2)}}};
}

/// Model `number` of `models` with the paper's parameters (Table II): 5 m/s, 1.7 m/s^2, 1 s, and the minimum distance.
Sim::Behavior driver(std::size_t number, double minimum_distance, std::uint64_t iterations) {
  cb::Idm const idm{.desired_speed = 5.0,
                    .time_headway = 1.0,
                    .minimum_gap = minimum_distance,
                    .maximum_acceleration = 1.7,
                    .comfortable_deceleration = 1.7};
  if (number == 0) return cb::IdmClassic{.law = idm};
  if (number == 1) {
    cb::Mobil mobil;
    mobil.law = idm;
    return mobil;
  }
  if (number == 3) {
    cb::ZipMerge zip;
    zip.law = idm;
    return zip;
  }
  Search search{.others = cb::IdmClassic{.law = idm}};
  search.actions.law = idm;
  search.reward.desired_speed = idm.desired_speed;
  search.options.budget.iterations = iterations;
  return search;
}

/// What became of one run.
struct Outcome {
  bool collision = false;
  double displacement = 0.0;  ///< mean distance of the replaced agents from where they were recorded [m]
};

/// Runs one recording with some of its agents replaced, until two collide or it ends.
Outcome run(cb::RecordedTraffic const& traffic, cb::RecordingWindow const& window, AgentSet const& set,
            std::optional<Sim::Behavior> const& behavior) {
  auto const is_replaced = [&](std::int64_t id) {
    return std::find(set.ids.begin(), set.ids.end(), id) != set.ids.end();
  };
  auto const recorded = cb::recorded_scenario<Sim>(traffic, window, [&](cb::Track const& track) {
    return is_replaced(track.id) ? behavior : std::optional<Sim::Behavior>{};
  });
  auto world = recorded.make_world();
  cb::PerAgent<cb::Displacement> displacements(std::span<cb::AgentId const>{}, {});
  for (auto const id : set.ids)
    if (auto way = cb::way_of(*traffic.map, traffic.track(id), recorded.begin, recorded.end)) {
      for (auto& state : way->states) state.time -= recorded.begin;
      displacements.add(static_cast<cb::AgentId>(id), cb::Displacement(cb::StaticTrajectory(std::move(way->states))));
    }
  std::size_t entered = 0;
  Outcome outcome;
  while (!outcome.collision && world.time() + dt <= recorded.duration() + 1e-9) {
    entered = recorded.enter(world, entered);
    (void)world.step(dt);  // who finds no way on stands
    outcome.collision = cb::AnyCollision{}(world);
    displacements.observe(world, dt);
  }
  for (auto const& [id, displacement] : displacements.each())
    outcome.displacement += displacement.mean() / static_cast<double>(displacements.each().size());
  return outcome;
}

/// A cell of the table: all recordings.
struct Cell {
  std::uint64_t collisions = 0;
  double displacement = 0.0;
};

std::vector<cb::RecordedTraffic> recordings_of(Settings const& settings) {
  std::vector<cb::RecordedTraffic> all;
  if (settings.tracks.empty()) {
    auto const map = zip_map().build();
    for (std::uint64_t i = 0; i < settings.recordings; ++i) all.push_back(record_zip(map, settings.seed + i));
    return all;
  }
  all.push_back(cb::load_tracks(settings.tracks));
  for (auto const& found : all.front().diagnostics)
    if (found.severity != cb::Severity::info) std::cerr << to_string(found) << "\n";
  all.front().map = examples::load_map(settings.map);
  return all;
}

nlohmann::ordered_json summary(Settings const& settings, std::vector<AgentSet> const& sets, std::size_t runs,
                               std::vector<Cell> const& cells) {
  nlohmann::ordered_json json;
  json["tracks"] = settings.tracks.empty() ? "own zip merges" : settings.tracks;
  json["recordings"] = runs;
  json["seed"] = settings.seed;
  json["dt"] = dt;
  json["iterations"] = settings.iterations;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    auto const column = i % columns;
    json["cells"].push_back({{"set", sets[i / columns].name},
                             {"replaced", sets[i / columns].ids},
                             {"behavior", models[column / parameter_sets]},
                             {"parameters", "P" + std::to_string(column % parameter_sets + 1)},
                             {"minimum_distance_m", minimum_distances[column % parameter_sets]},
                             {"runs", runs},
                             {"collisions", cells[i].collisions},
                             {"displacement_m", cells[i].displacement / static_cast<double>(runs)}});
  }
  return json;
}

void print_head() {
  std::printf("  %-4s%-16s", "", "");
  for (auto const* model : models) std::printf("  %-19s", model);
  std::printf("\n  %-4s%-16s", "A", "replaced");
  for (std::size_t m = 0; m < std::size(models); ++m) std::printf("  %4s %4s %4s %4s", "P1", "P2", "P3", "P4");
  std::printf("\n");
}

/// One table of the paper's form; `print_cell` prints 5 characters.
template <class PrintCell>
void print_table(std::vector<AgentSet> const& sets, PrintCell const& print_cell) {
  print_head();
  for (std::size_t row = 0; row < sets.size(); ++row) {
    std::string ids;
    for (auto const id : sets[row].ids) ids += (ids.empty() ? "" : ", ") + std::to_string(id);
    std::printf("  %-4s%-16s", sets[row].name.c_str(), ids.c_str());
    for (std::size_t column = 0; column < columns; ++column) {
      if (column % parameter_sets == 0) std::printf(" ");
      print_cell(row * columns + column);
    }
    std::printf("\n");
  }
}

/// Model `number` of `models` with what the file of parameters says.
Sim::Behavior driver(std::size_t number, double minimum_distance, Settings const& settings) {
  auto behavior = driver(number, minimum_distance, settings.iterations);
  std::visit([&](auto& model) { settings.parameters.set(model); }, behavior);
  return behavior;
}

/// Checks the file's parameters; prints them if that is asked for, and returns whether.
bool take_parameters(Settings& settings) {
  for (std::size_t column = 0; column < columns; ++column) {
    auto behavior = driver(column / parameter_sets, minimum_distances[column % parameter_sets], settings.iterations);
    std::visit([&](auto& model) { settings.parameters.take(model); }, behavior);
  }
  return settings.parameters.finish();
}

void run_all(Settings& settings) {
  if (take_parameters(settings)) return;
  auto const recordings = recordings_of(settings);
  if (!settings.write.empty()) {
    cb::write_file(settings.write, interaction_text(recordings.front()));
    if (settings.tracks.empty())
      cb::write_file(settings.write + ".xodr", cb::map::write_opendrive(zip_map().document()));
  }
  auto const sets = agent_sets(settings.ids);
  cb::RecordingWindow const window{std::max(settings.begin, recordings.front().begin()),
                                   std::min(settings.end, recordings.front().end())};
  for (auto const id : settings.ids) (void)recordings.front().track(static_cast<std::int64_t>(id));

  std::uint64_t colliding = 0;
  for (auto const& traffic : recordings) colliding += run(traffic, window, {}, std::nullopt).collision;
  std::size_t const runs = recordings.size(), count = sets.size() * columns;
  std::vector<Outcome> outcomes(count * runs);
  examples::run_on_threads(outcomes.size(), settings.threads, [&](std::uint64_t i) {
    auto const cell = i / runs, column = cell % columns;
    auto const behavior = driver(column / parameter_sets, minimum_distances[column % parameter_sets], settings);
    outcomes[i] = run(recordings[i % runs], window, sets[cell / columns], behavior);
  });
  std::vector<Cell> cells(count);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    cells[i / runs].collisions += outcomes[i].collision;
    cells[i / runs].displacement += outcomes[i].displacement;
  }
  if (!settings.json.empty()) cb::write_file(settings.json, summary(settings, sets, runs, cells).dump(1) + "\n");

  std::printf("\n  %zu recording%s of %.1f s, %zu tracks; replayed without a change, %llu of them collide%s\n\n", runs,
              runs == 1 ? "" : "s", window.end - window.begin, recordings.front().tracks.size(),
              static_cast<unsigned long long>(colliding), runs == 1 && colliding == 1 ? "s" : "");
  std::printf("  Collisions [%%]\n");
  print_table(sets, [&](std::size_t i) {
    std::printf(" %4.0f", 100.0 * static_cast<double>(cells[i].collisions) / static_cast<double>(runs));
  });
  std::printf("\n  Mean displacement from the recording [m]\n");
  print_table(sets, [&](std::size_t i) { std::printf(" %4.1f", cells[i].displacement / static_cast<double>(runs)); });
  std::printf("\n  P1 to P4: minimum distance 2, 3, 4, 5 m; desired speed 5 m/s, time headway 1 s, 1.7 m/s^2\n");
}

}  // namespace
}  // namespace replace_agents

int main(int argc, char** argv) {
  replace_agents::Settings settings;
  CLI::App program("Replaces agents of recorded traffic by behaviour models and counts collisions.", "replace_agents");
  auto const whole = [&](char const* name, std::uint64_t& target, std::uint64_t low, std::uint64_t high,
                         char const* sentence) {
    program.add_option(name, target, sentence)
        ->type_name("N")
        ->check(examples::whole_number(low, high))
        ->capture_default_str();
  };
  auto* const tracks =
      program.add_option("--tracks", settings.tracks, "INTERACTION track file; default: merges recorded here")
          ->type_name("FILE");
  auto* const map =
      program.add_option("--map", settings.map, "its map: OpenDRIVE, Lanelet2 (.osm) or CommonRoad (.xml)")
          ->type_name("FILE");
  tracks->needs(map);
  map->needs(tracks);
  examples::add_list(program, "--ids", settings.ids, examples::whole_number(0, 4'000'000'000),
                     "four tracks, in the order in which they pass the merge")
      ->type_name("LIST");
  program.add_option("--begin", settings.begin, "of the part to replay [s]; the paper: 232")
      ->type_name("S")
      ->check(examples::number(-1e9, 1e9));
  program.add_option("--end", settings.end, "its end [s]")->type_name("S")->check(examples::number(-1e9, 1e9));
  whole("--recordings", settings.recordings, 1, 10'000, "number of merges to record");
  whole("--seed", settings.seed, 0, 4'000'000'000, "seed of the first of them");
  whole("--iterations", settings.iterations, 1, 1'000'000, "of the tree search");
  whole("--threads", settings.threads, 1, 256, "number of threads; the results do not depend on it");
  program.add_option("--json", settings.json, "writes the cells to this file")->type_name("FILE");
  program
      .add_option("--write", settings.write,
                  "writes the first recording as an INTERACTION track file, and its map as FILE.xodr")
      ->type_name("FILE");
  settings.parameters.add_options(program);
  return examples::run_program(program, argc, argv, [&] {
    if (settings.ids.size() != 4)
      throw cambium::Error("--ids", "these are not four different tracks", "give four numbers, such as 65,66,67,68");
    replace_agents::run_all(settings);
  });
}
