// Replays recorded traffic on its map: lists windows of the recording, replays one, lets a behaviour model drive any of
// its road users, and counts what comes of it. On a CommonRoad scenario it also drives the planning problem's ego and
// writes the solution.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/open_loop/static_trajectory.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/metrics/displacement.hpp"
#include "cambium/evaluation/metrics/per_agent.hpp"
#include "cambium/scenario/dataset/common_road.hpp"
#include "cambium/scenario/dataset/common_road_solution.hpp"
#include "cambium/scenario/dataset/recorded_scenario.hpp"
#include "cambium/scenario/dataset/track_table.hpp"
#include "cambium/viewer/html_replay.hpp"
#include "cambium/viewer/record_world.hpp"
#include "cambium/world/world.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"

#include "../common/command_line.hpp"
#include "../common/map_file.hpp"

namespace replay_dataset {
namespace {

namespace cb = cambium;
using Sim = cb::World<cb::BehaviorSet<cb::StaticTrajectory, cb::IdmClassic, cb::Mobil, cb::UrbanDriver>,
                      cb::InterpolateExecution, cb::SingleTrack>;

struct Settings {
  std::string tracks, map, format = "interaction", driver = "urban", solution, out = "out/replay_dataset";
  double length = 10.0, every = 0.0, step = 0.1;
  std::uint64_t window = 0;
  std::optional<std::int64_t> ego;
  std::vector<std::int64_t> replaced;
  std::vector<double> origin;
  bool lists = false, replaces_all = false;
};

bool is_common_road(Settings const& settings) { return std::filesystem::path(settings.tracks).extension() == ".xml"; }

cb::RecordedTraffic read(Settings const& settings) {
  auto const origin = examples::origin_of(settings.origin, settings.map);
  cb::RecordedTraffic traffic;
  if (is_common_road(settings)) {
    traffic = cb::load_common_road(settings.tracks);
    if (!traffic.map) throw cb::Error(settings.tracks, "it has no lanelets", "give a scenario with lanelets");
  } else {
    if (settings.map.empty())
      throw cb::Error("--map", "is missing: the file of tracks has no map", "name its map (.osm, .xodr or .xml)");
    auto const table = settings.format == "highd"   ? cb::highd_tracks()
                       : settings.format == "ngsim" ? cb::ngsim_tracks()
                                                    : cb::interaction_tracks();
    traffic = cb::load_tracks(settings.tracks, table);
    traffic.map = examples::load_map(settings.map, origin);
  }
  for (auto const& found : traffic.diagnostics)
    if (found.severity != cb::Severity::info) std::cerr << to_string(found) << "\n";
  return traffic;
}

/// The windows that are asked for: one, from the begin to the end, where the recording is shorter.
std::vector<cb::RecordingWindow> windows(cb::RecordedTraffic const& traffic, Settings const& settings) {
  auto all = windows_of(traffic, settings.length, settings.every > 0.0 ? settings.every : settings.length);
  if (all.empty()) all.push_back({traffic.begin(), traffic.end()});
  return all;
}

void list(cb::RecordedTraffic const& traffic, std::vector<cb::RecordingWindow> const& all) {
  std::printf("  window   from     to  road users\n");
  for (std::size_t i = 0; i < all.size(); ++i) {
    auto const count = std::count_if(traffic.tracks.begin(), traffic.tracks.end(), [&](cb::Track const& track) {
      return !track.stands && track.begin() < all[i].end && track.end() > all[i].begin;
    });
    std::printf("  %6zu %6.1f %6.1f  %td\n", i, all[i].begin, all[i].end, count);
  }
}

Sim::Behavior driver(std::string const& name) {
  if (name == "idm") return cb::IdmClassic{};
  if (name == "mobil") return cb::Mobil{};
  return cb::UrbanDriver{};
}

/// What became of a run.
struct Outcome {
  std::string collision{};  ///< who, and when
  std::vector<cb::State> ego{};
  bool solved = false;
  cb::PerAgent<cb::Displacement> displacements{std::span<cb::AgentId const>{}, {}};
};

/// Runs the scenario until two collide, its time is over, or the ego of `problem` is at its goal in time; films it.
Outcome run(cb::RecordedScenario<Sim> const& recorded, Settings const& settings, cb::PlanningProblem const* problem,
            Outcome outcome, cb::WorldRecorder* film, Sim& world) {
  auto const ego = recorded.scenario.ego;
  auto const note = [&] {
    if (film != nullptr) film->record(world);
    if (world.roster().slot_of(ego)) outcome.ego.push_back(world.state(ego));
  };
  if (world.roster().slot_of(ego)) outcome.ego.push_back(world.state(ego));
  std::size_t entered = 0;
  auto const is_solved = [&] {
    auto const at = world.situation(ego);
    double const time = recorded.begin + world.time();
    return std::ranges::any_of(problem->goals, [&](auto const& goal) { return goal.holds(at, time); });
  };
  while (outcome.collision.empty() && !outcome.solved && world.time() + settings.step <= recorded.duration() + 1e-9) {
    entered = recorded.enter(world, entered);
    (void)world.step(settings.step);  // who finds no way on stands
    if (auto const pair = cb::AnyCollision{}.pair(world))
      outcome.collision = to_string(pair->first) + " and " +
                          (is_valid(pair->second) ? to_string(pair->second) : std::string("an obstacle"));
    outcome.displacements.observe(world, settings.step);
    note();
    if (problem != nullptr && outcome.collision.empty() && world.roster().slot_of(ego)) outcome.solved = is_solved();
  }
  return outcome;
}

void replay(cb::RecordedTraffic const& traffic, Settings settings) {
  auto const all = windows(traffic, settings);
  if (settings.lists) return list(traffic, all);
  if (settings.window >= all.size())
    throw cb::Error("--window " + std::to_string(settings.window), "there is no such window",
                    "give a number below " + std::to_string(all.size()) + "; --list names them");
  auto window = all[settings.window];
  window.ego = settings.ego;
  for (auto const id : settings.replaced) (void)traffic.track(id);  // throws for others
  auto const is_replaced = [&](cb::Track const& track) {
    return settings.replaces_all ||
           std::find(settings.replaced.begin(), settings.replaced.end(), track.id) != settings.replaced.end();
  };
  auto const behavior_of = [&](cb::Track const& track) {
    return is_replaced(track) && track.type != cb::TrackType::pedestrian ? std::optional(driver(settings.driver))
                                                                         : std::nullopt;
  };
  bool const solves = !settings.solution.empty();
  if (solves && traffic.problems.empty())
    throw cb::Error("--solution", "the file has no planning problem", "give a CommonRoad scenario that has one");
  if (solves) settings.step = traffic.time_step;  // a solution has a state for each of the file's
  auto const recorded =
      solves ? problem_scenario<Sim>(traffic, traffic.problems.front(), driver(settings.driver), behavior_of)
             : recorded_scenario<Sim>(traffic, window, behavior_of);
  for (auto const& found : recorded.diagnostics) std::cerr << to_string(found) << "\n";

  auto world = recorded.make_world();
  cb::WorldRecorder film(world, std::filesystem::path(settings.tracks).filename().string());
  if (is_valid(recorded.scenario.ego)) film.show_as(recorded.scenario.ego, cb::RecordedAgentKind::ego, "ego");
  Outcome outcome;
  std::size_t replaced = 0;
  for (auto const& track : traffic.tracks) {
    if (track.stands || !is_replaced(track)) continue;
    auto way = cb::way_of(*traffic.map, track, recorded.begin, recorded.end);
    if (!way) continue;
    ++replaced;
    for (auto& state : way->states) state.time -= recorded.begin;
    outcome.displacements.add(static_cast<cb::AgentId>(track.id),
                              cb::Displacement(cb::StaticTrajectory(std::move(way->states))));
  }
  outcome = run(recorded, settings, solves ? &traffic.problems.front() : nullptr, std::move(outcome), &film, world);

  auto const users = recorded.scenario.agents.size() + recorded.later.size();
  std::printf("  %.1f s from %.1f s of the recording, %zu road user%s, %zu of them driven by %s\n", world.time(),
              recorded.begin, users, users == 1 ? "" : "s", replaced + (solves ? 1 : 0), settings.driver.c_str());
  std::printf("  collision: %s\n", outcome.collision.empty() ? "none" : outcome.collision.c_str());
  double sum = 0.0;
  for (auto const& [id, displacement] : outcome.displacements.each()) sum += displacement.mean();
  if (replaced > 0) std::printf("  mean distance from the recording: %.1f m\n", sum / static_cast<double>(replaced));
  std::filesystem::create_directories(settings.out);
  auto const page = std::filesystem::path(settings.out) / "replay.html";
  write_html_replay(page, film.recording());
  std::printf("  %s plays it in a browser\n", page.string().c_str());
  if (!solves) return;
  if (!outcome.solved) {
    std::printf("  no solution: the goal was not reached in time and without a collision\n");
    return;
  }
  auto const shape = cb::geometry::car();
  cb::CommonRoadSolution solution{.benchmark_id = traffic.name,
                                  .problem = traffic.problems.front().id,
                                  .time_step = settings.step,
                                  .states = std::move(outcome.ego)};
  for (auto& state : solution.states) {
    state = middle_state(state, shape);
    state.time += recorded.begin;
  }
  cb::write_file(settings.solution, common_road_solution_text(solution));
  std::printf("  %s is the solution of planning problem %lld\n", settings.solution.c_str(),
              static_cast<long long>(solution.problem));
}

}  // namespace
}  // namespace replay_dataset

int main(int argc, char** argv) {
  replay_dataset::Settings settings;
  CLI::App program("Replays recorded traffic, and lets behaviour models drive in it.", "replay_dataset");
  program.add_option("--tracks", settings.tracks, "table of tracks (.csv), or a CommonRoad scenario (.xml)")
      ->type_name("FILE")
      ->required();
  program.add_option("--map", settings.map, "its map: Lanelet2 (.osm), OpenDRIVE (.xodr) or CommonRoad (.xml)")
      ->type_name("FILE");
  program
      .add_option(
          "--origin", settings.origin,
          "place on Earth where the tracks have (0, 0) [degrees], for a Lanelet2 map; default: the map's middle")
      ->type_name("LAT,LON")
      ->delimiter(',')
      ->expected(2);
  program.add_option("--format", settings.format, "of the table: interaction, highd or ngsim")
      ->check(CLI::IsMember({"interaction", "highd", "ngsim"}))
      ->capture_default_str();
  program.add_flag("--list", settings.lists, "list the windows of the recording");
  program.add_option("--length", settings.length, "of a window [s]")
      ->check(examples::number(0.1, 1e6))
      ->capture_default_str();
  program
      .add_option("--every", settings.every, "from the begin of a window to that of the next [s]; default: its length")
      ->check(examples::number(0.1, 1e6));
  program.add_option("--window", settings.window, "the window to replay")
      ->check(examples::whole_number(0, 1'000'000))
      ->capture_default_str();
  program.add_option("--ego", settings.ego, "the track that the replay shows as the ego")->type_name("ID");
  program.add_option("--replace", settings.replaced, "tracks that --driver drives, instead of being replayed")
      ->type_name("ID,...")
      ->delimiter(',');
  program.add_flag("--replace-all", settings.replaces_all, "all of them");
  program.add_option("--driver", settings.driver, "idm, mobil or urban")
      ->check(CLI::IsMember({"idm", "mobil", "urban"}))
      ->capture_default_str();
  program.add_option("--step", settings.step, "time step [s]; with --solution that of the file")
      ->check(examples::number(0.01, 1.0))
      ->capture_default_str();
  program
      .add_option("--solution", settings.solution,
                  "let --driver drive the ego of the first planning problem, and write a CommonRoad solution")
      ->type_name("OUT.xml");
  program.add_option("--out", settings.out, "folder for replay.html")->type_name("DIR")->capture_default_str();
  return examples::run_program(program, argc, argv,
                               [&] { replay_dataset::replay(replay_dataset::read(settings), settings); });
}
