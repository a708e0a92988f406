#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/evaluation/off_road.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/viewer/record_world.hpp"
#include "cambium/world/frame.hpp"

#include "on_threads.hpp"
#include "options.hpp"
#include "trajectories.hpp"

namespace examples {

inline constexpr double dt = 0.2;                                         // [s]
inline constexpr cambium::HardBraking hard_braking{.deceleration = 4.0};  // each braking counts once

/// The outcome of one scenario.
struct Outcome {
  enum class Kind { success, collision, time_out } kind = Kind::time_out;
  bool off_road = false;
  std::uint32_t agents = 0;
  cambium::AgentId ego = cambium::none<cambium::AgentId>;
  cambium::AgentId collided_first = cambium::none<cambium::AgentId>, collided_second = collided_first;
  std::uint64_t steps = 0, agent_steps = 0, hard_brakings = 0;
  double speed_sum = 0.0;
  double lowest_acceleration = 0.0;   // of all agents [m/s^2]
  std::vector<std::uint64_t> counts;  // events counted, see `Words::counts`

  /// Ranks outcomes for the replay: a collision before a time-out before the ego off-road; then the hardest braking,
  /// then the most hard brakings. `why_interesting` says it in words.
  [[nodiscard]] std::tuple<int, double, std::uint64_t> interest() const {
    int const rank = kind == Kind::collision ? 3 : kind == Kind::time_out ? 2 : off_road ? 1 : 0;
    return {rank, -lowest_acceleration, hard_brakings};
  }
};

/// Appends a line for each vehicle of the world at its current time.
template <class World>
void append_rows(std::string& rows, std::uint64_t scenario, World const& world, cambium::AgentId ego) {
  auto const& map = world.map();
  for (std::size_t i = 0; i < world.size(); ++i) {
    auto const& r = world.frame().agents[i];
    if (r.status != cambium::AgentStatus::driving) continue;
    auto const& agent = world.roster().agents[i];
    auto const lane = is_valid(r.lane.corridor) ? agent.road->corridors[r.lane.corridor].lane_at(r.lane.s).lane
                                                : cambium::none<cambium::LaneId>;
    append_row(rows, map,
               {scenario, world.time(), agent.id, r.state.x, r.state.y, r.state.heading, r.state.speed,
                double{r.acceleration}, agent.shape, is_valid(lane) ? &map.lane(lane) : nullptr,
                std::visit([](auto const& behavior) { return behavior.name; }, agent.behavior), agent.id == ego});
  }
}

/// Adds the last step's agent-steps, speeds and hard brakings. `braking` remembers by slot which agents brake hard.
template <class World>
void count_agents(World const& world, std::vector<bool>& braking, Outcome& outcome) {
  for (cambium::Slot slot{}; index_of(slot) < world.size(); ++slot) {
    auto const& r = world.frame().agents[slot];
    if (r.status != cambium::AgentStatus::driving) continue;
    ++outcome.agent_steps;
    outcome.speed_sum += r.state.speed;
    outcome.lowest_acceleration = std::min(outcome.lowest_acceleration, cambium::Acceleration{}(world, slot));
    bool const is_hard = hard_braking(world, slot);
    outcome.hard_brakings += is_hard && !braking[index_of(slot)];
    braking[index_of(slot)] = is_hard;
  }
}

/// Records a run for the viewers. The ego, agents with a goal and agents that collided get colours of their own.
class Film {
 public:
  template <class World>
  Film(World const& world, cambium::AgentId ego) : recorder_(world) {
    for (cambium::Slot slot{}; index_of(slot) < world.size(); ++slot)
      if (!std::holds_alternative<cambium::NoGoal>(world.roster().goals[slot]))
        recorder_.show_as(world.roster().agents[slot].id, cambium::RecordedAgentKind::merging);
    recorder_.show_as(ego, cambium::RecordedAgentKind::ego, "ego");
  }

  template <class World>
  void record(World const& world) {
    recorder_.record(world);
  }

  [[nodiscard]] cambium::Recording develop(Outcome const& outcome) {
    for (auto const id : {outcome.collided_first, outcome.collided_second})
      if (is_valid(id) && id != outcome.ego) recorder_.show_as(id, cambium::RecordedAgentKind::collided);
    return std::move(recorder_.recording());
  }

 private:
  cambium::WorldRecorder recorder_;
};

/// Simulates one scenario until its task is done, two agents collide or time is up. Fills `recording` and appends the
/// trajectories to `rows`, unless these are null.
///
/// A `Task` defines an example's scenarios and what has to be done in them:
///   `sample(seed, number)`   returns a `cambium::Scenario`
///   `watch(world, ego)`      returns a function object that judges a run: called with the world after each step, it
///                            returns whether the task is done; its `counts`, if any, add up over the steps
///   `facts()`                returns facts about the site for the summary
template <class Task>
[[nodiscard]] Outcome run_scenario(Task const& task, Settings const& settings, std::uint64_t number,
                                   std::string* rows = nullptr, cambium::Recording* recording = nullptr) {
  auto const scenario = task.sample(settings.seed, static_cast<std::uint32_t>(number));
  auto world = scenario.make_world();
  Outcome outcome;
  outcome.agents = static_cast<std::uint32_t>(world.size());
  outcome.ego = scenario.ego;
  auto const ego = world.slot_of(scenario.ego);
  auto watch = task.watch(world, ego);
  std::optional<Film> film;
  if (recording != nullptr) film.emplace(world, scenario.ego);
  std::vector<bool> braking(world.size(), false);
  if (rows != nullptr) append_rows(*rows, number, world, scenario.ego);
  for (bool is_over = false; !is_over;) {
    auto const result = world.step(dt);
    if (!result)
      throw cambium::WorldError("scenario " + std::to_string(number) + ", agent " + to_string(result.agent),
                                to_string(result.problem));
    count_agents(world, braking, outcome);
    if (rows != nullptr) append_rows(*rows, number, world, scenario.ego);
    if (film) film->record(world);
    auto const collision = cambium::AnyCollision{}.pair(world);
    outcome.steps = world.frame().step;
    outcome.off_road = outcome.off_road || cambium::OffRoad{}(world, ego);
    if (collision)
      std::tie(outcome.collided_first, outcome.collided_second) = std::tie(collision->first, collision->second);
    bool const done = watch(world);
    if (collision)
      outcome.kind = Outcome::Kind::collision;
    else if (done)
      outcome.kind = Outcome::Kind::success;
    is_over = collision || done || outcome.steps >= settings.steps;
  }
  if constexpr (requires { watch.counts; }) outcome.counts.assign(watch.counts.begin(), watch.counts.end());
  if (film) *recording = film->develop(outcome);
  return outcome;
}

/// Runs all scenarios and writes the trajectories of the first ones to `file`. The results do not depend on the number
/// of threads.
template <class Task>
[[nodiscard]] std::vector<Outcome> run_all(Task const& task, Settings const& settings, PartFile& file) {
  std::vector<Outcome> outcomes(settings.scenarios);
  file.append(trajectory_columns);
  RowsInOrder in_order(file, 4 * settings.threads);
  run_on_threads(settings.scenarios, settings.threads, [&](std::uint64_t i) {
    try {
      std::string rows;
      bool const is_written = i < settings.trajectories;
      outcomes[i] = run_scenario(task, settings, i, is_written ? &rows : nullptr);
      if (is_written) in_order.put(i, std::move(rows));
    } catch (...) {
      in_order.give_up();
      throw;
    }
  });
  return outcomes;
}

}  // namespace examples
