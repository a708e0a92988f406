// Traffic merges: samples dense situations at the on-ramp or lane drop of an OpenDRIVE map, rolls them forward with the
// Intelligent Driver Model, judges each, and writes figures, trajectories and a replay that plays in a browser.

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/drivable_area.hpp"
#include "cambium/evaluation/evaluators.hpp"
#include "cambium/evaluation/goal_reached.hpp"
#include "cambium/viewer/html_replay.hpp"
#include "cambium/viewer/record_world.hpp"

#include "../common/map_file.hpp"
#include "../common/options.hpp"
#include "scenario.hpp"

namespace cb = cambium;

namespace {

constexpr double dt = 0.2;            // [s]
constexpr double hard_braking = -4.0;  // [m/s^2]; one hard braking lasts while an agent brakes harder than this

struct Settings {
  std::string map_file = CAMBIUM_SOURCE_DIR "/maps/merging.xodr";
  std::string out = "out/merging";
  std::uint64_t scenarios = 100, seed = 1, threads = std::max(1u, std::thread::hardware_concurrency()), steps = 300, trajectories = 10;
};

/// What came of one scenario.
struct Outcome {
  enum class Kind { success, collision, time_out } kind = Kind::time_out;
  bool off_road = false;
  std::uint32_t agents = 0, collided_agents = 0;
  std::uint64_t steps = 0, agent_steps = 0, hard_brakings = 0;
  double speed_sum = 0.0;
  std::string trajectory;  // CSV rows, where asked for

  /// How much there is to see.
  [[nodiscard]] double interest() const {
    return (kind == Kind::collision ? 1e6 : 0.0) + (off_road ? 1e5 : 0.0) + static_cast<double>(hard_brakings) + 0.01 * agents;
  }
};

void append_rows(std::string& rows, std::uint64_t scenario, merging::Simulation const& world) {
  char line[200];
  for (std::size_t i = 0; i < world.size(); ++i) {
    auto const& r = world.frame().agents[i];
    if (r.status != cb::AgentStatus::driving) continue;
    auto const& shape = world.roster().agents[i].shape;
    std::snprintf(line, sizeof line, "%llu,%.1f,%s,%.4f,%.4f,%.6f,%.4f,%.4f,%.2f,%.2f\n", static_cast<unsigned long long>(scenario), world.time(),
                  cb::to_string(world.roster().agents[i].id).c_str(), r.state.x, r.state.y, std::remainder(r.state.heading, 2 * cb::geometry::pi),
                  r.state.speed, r.action.acceleration, shape.length(), shape.width());
    rows += line;
  }
}

/// Rolls one scenario forward until its ego is at its goal, something collides, or time is up.
Outcome run_scenario(merging::Site const& site, Settings const& settings, std::uint64_t number, cb::Recording* recording) {
  auto [world, ego, merging_agents] = merging::sample_scenario(site, settings.seed, static_cast<std::uint32_t>(number));
  Outcome outcome;
  outcome.agents = static_cast<std::uint32_t>(world.size());
  bool const keep = number < settings.trajectories || recording != nullptr;
  cb::Evaluators const judge(cb::CollisionAny{}, cb::GoalReached{ego}, cb::DrivableArea{ego}, cb::StepCount{settings.steps});
  cb::WorldRecorder recorder(world, "Scenario " + std::to_string(number));
  for (auto const id : merging_agents) recorder.show_as(id, cb::RecordedAgentKind::merging);
  recorder.show_as(ego, cb::RecordedAgentKind::ego, "ego");
  std::vector<bool> braking(world.size(), false);
  if (keep) append_rows(outcome.trajectory, number, world);
  while (true) {
    auto const result = world.step(dt);
    if (!result) throw cb::WorldError("scenario " + std::to_string(number) + ", agent " + to_string(result.agent), to_string(result.problem));
    for (std::size_t i = 0; i < world.size(); ++i) {
      auto const& r = world.frame().agents[i];
      if (r.status != cb::AgentStatus::driving) continue;
      ++outcome.agent_steps;
      outcome.speed_sum += r.state.speed;
      bool const hard = r.action.acceleration < hard_braking;
      outcome.hard_brakings += hard && !braking[i];
      braking[i] = hard;
    }
    if (keep) append_rows(outcome.trajectory, number, world);
    if (recording != nullptr) recorder.record(world);
    auto const verdict = judge.evaluate(world);
    outcome.steps = verdict.steps;
    outcome.off_road = outcome.off_road || verdict.off_road;
    if (verdict.any_collision) outcome.kind = Outcome::Kind::collision;
    else if (verdict.goal_reached) outcome.kind = Outcome::Kind::success;
    else if (!verdict.timed_out) continue;
    break;
  }
  if (recording != nullptr) *recording = std::move(recorder.recording());
  return outcome;
}

/// Draws a bar on a terminal; silent elsewhere.
class Progress {
 public:
  explicit Progress(std::uint64_t total) : total_(total), shown_(isatty(STDERR_FILENO) == 1) {}
  void advance() {
    auto const done = ++done_;
    std::unique_lock lock(mutex_, std::defer_lock);
    if (!shown_ || (done == total_ ? (lock.lock(), false) : !lock.try_lock())) return;
    constexpr std::uint64_t width = 40;
    auto const filled = done * width / total_;
    std::fprintf(stderr, "\r[%s%s] %llu/%llu%s", std::string(filled, '#').c_str(), std::string(width - filled, ' ').c_str(),
                 static_cast<unsigned long long>(done), static_cast<unsigned long long>(total_), done == total_ ? "\r\033[K" : "");
    std::fflush(stderr);
  }

 private:
  std::uint64_t total_;
  std::atomic<std::uint64_t> done_{0};
  std::mutex mutex_;
  bool shown_;
};

/// Runs all scenarios; each thread takes the next one that nobody has. The outcomes do not depend on the threads.
std::vector<Outcome> run_all(merging::Site const& site, Settings const& settings) {
  std::vector<Outcome> outcomes(settings.scenarios);
  std::atomic<std::uint64_t> next{0};
  std::exception_ptr problem;
  std::mutex mutex;
  Progress progress(settings.scenarios);
  auto const work = [&] {
    try {
      for (auto i = next++; i < settings.scenarios; i = next++) {
        outcomes[i] = run_scenario(site, settings, i, nullptr);
        progress.advance();
      }
    } catch (...) {
      std::lock_guard const lock(mutex);
      if (!problem) problem = std::current_exception();
      next = settings.scenarios;
    }
  };
  std::vector<std::jthread> threads;
  for (std::uint64_t t = 1; t < settings.threads; ++t) threads.emplace_back(work);
  work();
  for (auto& thread : threads) thread.join();
  if (problem) std::rethrow_exception(problem);
  return outcomes;
}

struct Totals {
  std::uint64_t success = 0, collision = 0, time_out = 0, off_road = 0, agents = 0, agent_steps = 0, hard_brakings = 0, steps = 0;
  double speed_sum = 0.0;
  std::uint64_t most_interesting = 0;
};

Totals total(std::vector<Outcome> const& outcomes) {
  Totals t;
  for (std::uint64_t i = 0; i < outcomes.size(); ++i) {
    auto const& o = outcomes[i];
    t.success += o.kind == Outcome::Kind::success;
    t.collision += o.kind == Outcome::Kind::collision;
    t.time_out += o.kind == Outcome::Kind::time_out;
    t.off_road += o.off_road;
    t.agents += o.agents;
    t.agent_steps += o.agent_steps;
    t.hard_brakings += o.hard_brakings;
    t.steps += o.steps;
    t.speed_sum += o.speed_sum;
    if (o.interest() > outcomes[t.most_interesting].interest()) t.most_interesting = i;
  }
  return t;
}

void write_file(std::filesystem::path const& path, std::string const& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.flush();
  if (!file) throw cb::Error(path.string(), "the file cannot be written", "choose another --out");
}

nlohmann::ordered_json summary(Settings const& settings, merging::Site const& site, std::vector<Outcome> const& outcomes, Totals const& t) {
  auto const n = static_cast<double>(settings.scenarios);
  nlohmann::ordered_json json;
  json["map"] = std::filesystem::path(settings.map_file).filename().string();
  json["scenarios"] = settings.scenarios;
  json["seed"] = settings.seed;
  json["steps"] = settings.steps;
  json["dt"] = dt;
  json["entrances"] = site.entrances.size();
  json["success"] = static_cast<double>(t.success) / n;
  json["collision"] = static_cast<double>(t.collision) / n;
  json["time_out"] = static_cast<double>(t.time_out) / n;
  json["off_road"] = static_cast<double>(t.off_road) / n;
  json["mean_speed"] = t.agent_steps > 0 ? t.speed_sum / static_cast<double>(t.agent_steps) : 0.0;
  json["mean_steps"] = static_cast<double>(t.steps) / n;
  json["hard_brakings"] = t.hard_brakings;
  json["agents"] = t.agents;
  json["agent_steps"] = t.agent_steps;
  json["replayed_scenario"] = t.most_interesting;
  char const* const names[] = {"success", "collision", "time_out"};
  for (auto const& o : outcomes)
    json["outcomes"].push_back({{"outcome", names[static_cast<int>(o.kind)]}, {"off_road", o.off_road}, {"agents", o.agents}, {"steps", o.steps}, {"hard_brakings", o.hard_brakings}});
  return json;
}

void print_table(Settings const& settings, Totals const& t, double seconds) {
  auto const n = static_cast<double>(settings.scenarios);
  auto const percent = [n](std::uint64_t count) { return 100.0 * static_cast<double>(count) / n; };
  auto const steps = static_cast<double>(t.agent_steps);
  std::printf("\n  %llu scenarios on %s, %.1f agents each, seed %llu\n\n", static_cast<unsigned long long>(settings.scenarios),
              std::filesystem::path(settings.map_file).filename().c_str(), static_cast<double>(t.agents) / n, static_cast<unsigned long long>(settings.seed));
  std::printf("  success          %6.1f %%\n  collision        %6.1f %%\n  time-out         %6.1f %%\n  off-road         %6.1f %%\n", percent(t.success),
              percent(t.collision), percent(t.time_out), percent(t.off_road));
  std::printf("  mean speed       %6.2f m/s\n  hard brakings    %6.2f per scenario (harder than %.0f m/s^2)\n", t.speed_sum / std::max(1.0, steps),
              static_cast<double>(t.hard_brakings) / n, -hard_braking);
  std::printf("  agent-steps      %.3g in %.2f s: %.3g per second on %llu thread%s, sampling and judging included\n\n", steps, seconds, steps / seconds,
              static_cast<unsigned long long>(settings.threads), settings.threads == 1 ? "" : "s");
}

int run(int argc, char** argv) {
  Settings settings;
  examples::Options options("merging", "samples dense merging situations, simulates and judges them");
  options.number("--scenarios", "N", settings.scenarios, 1, 10'000'000, "situations to sample");
  options.number("--seed", "S", settings.seed, 0, ~0ull, "of everything random");
  options.number("--threads", "T", settings.threads, 1, 1024, "to run them on; the results do not depend on it");
  options.number("--steps", "K", settings.steps, 1, 1'000'000, "of 0.2 s, after which a scenario is timed out");
  options.text("--map", "FILE", settings.map_file, "OpenDRIVE map with a merge");
  options.text("--out", "DIR", settings.out, "folder for summary.json, trajectories.csv and replay.html");
  options.number("--trajectories", "N", settings.trajectories, 0, 10'000'000, "scenarios whose trajectories are written, besides the replayed one");
  if (!options.parse(argc, argv)) return 0;

  auto const site = merging::find_site(examples::load_map(settings.map_file), settings.map_file);
  std::filesystem::path const out(settings.out);
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error) throw cb::Error(settings.out, "the folder cannot be made (" + error.message() + ")", "choose another --out");
  write_file(out / "summary.json", "");  // finds out now, not after the work, whether the folder takes files

  auto const begin = std::chrono::steady_clock::now();
  auto const outcomes = run_all(site, settings);
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  auto const totals = total(outcomes);

  cb::Recording recording;
  auto const replayed = run_scenario(site, settings, totals.most_interesting, &recording);
  std::string rows = "scenario,time,agent,x,y,heading,speed,acceleration,length,width\n";
  for (std::uint64_t i = 0; i < outcomes.size(); ++i) rows += i == totals.most_interesting ? replayed.trajectory : outcomes[i].trajectory;
  write_file(out / "trajectories.csv", rows);
  write_file(out / "summary.json", summary(settings, site, outcomes, totals).dump(1) + "\n");
  char const* const words[] = {"the ego merged", "a collision", "time ran out"};
  recording.title = "Merging on " + std::filesystem::path(settings.map_file).filename().string() + ", scenario " + std::to_string(totals.most_interesting);
  recording.notes = {"Outcome: " + std::string(words[static_cast<int>(replayed.kind)]) + "; " + std::to_string(replayed.agents) + " vehicles, " +
                     std::to_string(replayed.hard_brakings) + " hard brakings, seed " + std::to_string(settings.seed)};
  cb::write_html_replay(out / "replay.html", recording);
  print_table(settings, totals, seconds);
  std::cout << "  " << (out / "replay.html").string() << "       plays scenario " << totals.most_interesting << " in a browser\n  "
            << (out / "summary.json").string() << "      these figures and each scenario's outcome\n  " << (out / "trajectories.csv").string()
            << "  paths of the first scenarios' vehicles and of the replayed one's\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return examples::run_program("merging", [&] { return run(argc, argv); });
}
