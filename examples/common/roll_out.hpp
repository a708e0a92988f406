#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/drivable_area.hpp"
#include "cambium/evaluation/evaluators.hpp"
#include "cambium/viewer/record_world.hpp"
#include "cambium/world/frame.hpp"

#include "on_threads.hpp"

namespace examples {

inline constexpr double dt = 0.2;             // [s]
inline constexpr double hard_braking = -4.0;  // [m/s^2]; one hard braking lasts while an agent brakes harder than this

/// What a user sets on the command line.
struct Settings {
  std::string map_file, out;
  std::uint64_t scenarios = 200, seed = 1, steps = 300, trajectories = 10;
  std::uint64_t threads = std::max(1u, std::thread::hardware_concurrency());
};

/// What came of one scenario.
struct Outcome {
  enum class Kind { success, collision, time_out } kind = Kind::time_out;
  bool off_road = false;
  std::uint32_t agents = 0;
  cambium::AgentId collided_first = cambium::none<cambium::AgentId>, collided_second = collided_first;
  std::uint64_t steps = 0, agent_steps = 0, hard_brakings = 0;
  double speed_sum = 0.0;
  std::vector<std::uint64_t> counts;  // what the scenario counts, see `Words::counts`
  std::string trajectory;             // CSV rows, where asked for

  /// How much there is to see; `why_interesting` says it in words.
  [[nodiscard]] double interest() const {
    return (kind == Kind::collision ? 1e6 : 0.0) + (off_road ? 1e5 : 0.0) + static_cast<double>(hard_brakings) +
           0.01 * agents;
  }
};

/// Columns of the trajectories: x, y [m] are of the reference point (centre of the rear axle), front and rear [m] how
/// far the vehicle reaches from there; ego is 1 for the ego, else 0.
inline constexpr char const* trajectory_columns =
    "scenario,time,agent,x,y,heading,speed,acceleration,front,rear,width,ego\n";

template <class World>
void append_rows(std::string& rows, std::uint64_t scenario, World const& world, cambium::AgentId ego) {
  char line[200];
  for (std::size_t i = 0; i < world.size(); ++i) {
    auto const& r = world.frame().agents[i];
    if (r.status != cambium::AgentStatus::driving) continue;
    auto const& shape = world.roster().agents[i].shape;
    std::snprintf(line, sizeof line, "%llu,%.1f,%s,%.4f,%.4f,%.6f,%.4f,%.4f,%.2f,%.2f,%.2f,%d\n",
                  static_cast<unsigned long long>(scenario), world.time(),
                  cambium::to_string(world.roster().agents[i].id).c_str(), r.state.x, r.state.y,
                  std::remainder(r.state.heading, 2 * cambium::geometry::pi), r.state.speed, r.action.acceleration,
                  shape.front, shape.rear, shape.width(), world.roster().agents[i].id == ego);
    rows += line;
  }
}

/// Adds the last step's agent-steps, speeds and hard brakings; `braking` remembers who brakes hard.
template <class World>
void count_agents(World const& world, std::vector<bool>& braking, Outcome& outcome) {
  for (std::size_t i = 0; i < world.size(); ++i) {
    auto const& r = world.frame().agents[i];
    if (r.status != cambium::AgentStatus::driving) continue;
    ++outcome.agent_steps;
    outcome.speed_sum += r.state.speed;
    bool const hard = r.action.acceleration < hard_braking;
    outcome.hard_brakings += hard && !braking[i];
    braking[i] = hard;
  }
}

/// What there was to see of a scenario, as a recording for the viewers.
class Film {
 public:
  template <class Scenario>
  explicit Film(Scenario const& scenario) : recorder_(scenario.world) {
    for (auto const id : scenario.marked) recorder_.show_as(id, cambium::RecordedAgentKind::merging);
    recorder_.show_as(scenario.ego, cambium::RecordedAgentKind::ego, "ego");
  }

  template <class World>
  void record(World const& world) {
    recorder_.record(world);
  }

  [[nodiscard]] cambium::Recording develop(Outcome const& outcome) {
    for (auto const id : {outcome.collided_first, outcome.collided_second})
      if (is_valid(id)) recorder_.show_as(id, cambium::RecordedAgentKind::collided);
    return std::move(recorder_.recording());
  }

 private:
  cambium::WorldRecorder recorder_;
};

/// Rolls one scenario forward until it is done, something collides, or time is up; fills `recording` if there is one.
///
/// A `Site` is what an example's scenarios have in common; beside it stand `sample_scenario(site, seed, number)`, whose
/// result has a `world`, an `ego` and `marked`, the agents that the replay shows in a colour of their own, and
/// `is_done(scenario)`, which says after each step whether what was to be done is done. A scenario may have `counts`,
/// which `is_done` keeps up to date.
template <class Site>
[[nodiscard]] Outcome run_scenario(Site const& site, Settings const& settings, std::uint64_t number,
                                   cambium::Recording* recording) {
  auto scenario = sample_scenario(site, settings.seed, static_cast<std::uint32_t>(number));
  auto& world = scenario.world;
  Outcome outcome;
  outcome.agents = static_cast<std::uint32_t>(world.size());
  bool const keep = number < settings.trajectories || recording != nullptr;
  cambium::Evaluators const judge(cambium::CollisionAny{}, cambium::DrivableArea{scenario.ego},
                                  cambium::StepCount{settings.steps});
  std::optional<Film> film;
  if (recording != nullptr) film.emplace(scenario);
  std::vector<bool> braking(world.size(), false);
  if (keep) append_rows(outcome.trajectory, number, world, scenario.ego);
  for (bool is_over = false; !is_over;) {
    auto const result = world.step(dt);
    if (!result)
      throw cambium::WorldError("scenario " + std::to_string(number) + ", agent " + to_string(result.agent),
                                to_string(result.problem));
    count_agents(world, braking, outcome);
    if (keep) append_rows(outcome.trajectory, number, world, scenario.ego);
    if (film) film->record(world);
    auto const verdict = judge.evaluate(world);
    outcome.steps = verdict.steps;
    outcome.off_road = outcome.off_road || verdict.off_road;
    outcome.collided_first = verdict.collision_first;
    outcome.collided_second = verdict.collision_second;
    bool const done = is_done(scenario);
    if (verdict.any_collision)
      outcome.kind = Outcome::Kind::collision;
    else if (done)
      outcome.kind = Outcome::Kind::success;
    is_over = verdict.any_collision || done || verdict.timed_out;
  }
  if constexpr (requires { scenario.counts; }) outcome.counts = scenario.counts;
  if (film) *recording = film->develop(outcome);
  return outcome;
}

/// Runs all scenarios. The outcomes do not depend on the threads.
template <class Site>
[[nodiscard]] std::vector<Outcome> run_all(Site const& site, Settings const& settings) {
  std::vector<Outcome> outcomes(settings.scenarios);
  run_on_threads(settings.scenarios, settings.threads,
                 [&](std::uint64_t i) { outcomes[i] = run_scenario(site, settings, i, nullptr); });
  return outcomes;
}

}  // namespace examples
