#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <string>
#include <variant>

#include "cambium/core/error.hpp"
#include "cambium/viewer/html_replay.hpp"

#include "options.hpp"
#include "part_file.hpp"
#include "report.hpp"
#include "roll_out.hpp"

namespace examples {

/// Why this scenario was chosen for the replay.
[[nodiscard]] inline char const* why_interesting(Settings const& settings, Outcome const& outcome) {
  if (settings.replay) return "as --replay says";
  if (outcome.kind == Outcome::Kind::collision) return "a collision";
  if (outcome.kind == Outcome::Kind::time_out) return "a time-out";
  if (outcome.off_road) return "the ego is off-road";
  return "the closest call";
}

[[nodiscard]] inline std::string in_words(Outcome const& outcome, Words const& words) {
  if (outcome.kind == Outcome::Kind::success) return words.success;
  if (outcome.kind == Outcome::Kind::time_out) return "time ran out";
  auto const name = [&](cambium::AgentId id) {
    return (id == outcome.ego ? "the ego, agent " : "agent ") + to_string(id);
  };
  return name(outcome.collided_first) + ", and " + name(outcome.collided_second) + " collide";
}

/// Simulates the chosen scenario again and writes its replay, and its trajectories unless they are written already.
template <class Task>
void write_replay(std::filesystem::path const& file, Task const& task, Settings const& settings, Words const& words,
                  std::uint64_t shown, PartFile& trajectories) {
  cambium::Recording recording;
  std::string rows;
  auto const replayed = run_scenario(task, settings, shown, &rows, &recording);
  if (shown >= settings.trajectories) trajectories.append(rows);
  recording.title = words.title + " on " + std::filesystem::path(settings.map_file).filename().string() +
                    ", scenario " + std::to_string(shown);
  recording.notes = {"Outcome: " + in_words(replayed, words) + "; " + counted(replayed.agents, "vehicle") + ", " +
                     counted(replayed.hard_brakings, "hard braking") + ", seed " + std::to_string(settings.seed)};
  cambium::write_html_replay(file, recording);
}

/// A task whose drivers have the parameters that the file says.
template <class Task>
struct WithParameters : Task {
  ParameterFile const* file;

  [[nodiscard]] auto sample(std::uint64_t seed, std::uint32_t number) const {
    auto scenario = Task::sample(seed, number);
    for (auto& agent : scenario.agents) std::visit([&](auto& driver) { file->set(driver); }, agent.behavior);
    return scenario;
  }
};

template <class... Drivers>
void allow_drivers(std::variant<Drivers...> const&, ParameterFile& file) {
  (file.allow<Drivers>(), ...);
}

/// Checks the file's parameters of drivers. Prints them if that is asked for, as the first scenarios' drivers have
/// them; returns whether.
template <class Task>
[[nodiscard]] bool take_parameters(WithParameters<Task> const& task, Settings& settings) {
  allow_drivers(typename decltype(task.sample(0, 0).make_world())::Behavior{}, settings.parameters);
  for (std::uint64_t i = 0; settings.parameters.prints() && i < std::min<std::uint64_t>(settings.scenarios, 50); ++i)
    for (auto const& agent : task.sample(settings.seed, static_cast<std::uint32_t>(i)).agents)
      std::visit([&](auto const& driver) { settings.parameters.show(driver); }, agent.behavior);
  return settings.parameters.finish();
}

/// Runs all scenarios of a task (see `run_scenario`), prints the table and writes the files. A scenario that fails is
/// reported as a `MapError`, because the map is the usual cause.
template <class Plain>
void sample_and_report(Plain const& plain, Settings& settings, Words const& words) {
  WithParameters<Plain> const task{plain, &settings.parameters};
  if (take_parameters(task, settings)) return;
  std::filesystem::path const folder(settings.out);
  if (settings.replay && *settings.replay >= settings.scenarios)
    throw cambium::Error("--replay " + std::to_string(*settings.replay),
                         "the last scenario is number " + std::to_string(settings.scenarios - 1),
                         "choose an earlier one, or give more --scenarios");
  prepare_folder(folder);
  PartFile trajectories(folder / "trajectories.csv");
  auto const begin = std::chrono::steady_clock::now();
  auto const outcomes = [&] {
    try {
      return run_all(task, settings, trajectories);
    } catch (cambium::WorldError const& problem) {
      throw cambium::MapError(settings.map_file, problem.what(), "look at it with examples/run map --picture");
    }
  }();
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  auto totals = total(outcomes);
  if (settings.replay) totals.replayed = *settings.replay;

  write_replay(folder / "replay.html", task, settings, words, totals.replayed, trajectories);
  trajectories.finish();
  write_summary(folder / "summary.json", settings, task.facts(), outcomes, totals, words);
  print_table(settings, totals, seconds, words);
  std::cout << "  " << (folder / "replay.html").string() << "       plays scenario " << totals.replayed << " ("
            << why_interesting(settings, outcomes[totals.replayed]) << ") in a browser\n  "
            << (folder / "summary.json").string()
            << "      these figures, each scenario's outcome, and the collisions\n  "
            << (folder / "trajectories.csv").string()
            << "  paths of the first scenarios' vehicles and of the replayed one's\n";
}

}  // namespace examples
