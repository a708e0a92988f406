// What snapshots cost: a world of 20 agents, one of which plans by tree search, saved and restored; and seven minutes
// at 5 Hz with each cycle on disk, beside a trace of the planner's inputs and outputs at 100 Hz.

#include <array>
#include <charconv>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cambium/behavior.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/road/curve_layout.hpp"
#include "cambium/planner/mcts/mcts.hpp"
#include "cambium/snapshot.hpp"
#include "cambium/world/world.hpp"

#include "yardstick/main.hpp"

namespace cb = cambium;

namespace {

using Prediction = cb::World<cb::BehaviorSet<cb::DriverActions<cb::UrbanDriver>, cb::UrbanDriver>,
                             cb::InterpolateExecution, cb::SingleTrack>;
using Planner = cb::Mcts<Prediction>;
using World = cb::World<cb::BehaviorSet<Planner, cb::IdmClassic, cb::Mobil, cb::UrbanDriver>, cb::InterpolateExecution,
                        cb::SingleTrack>;

/// A winding road of three lanes, long enough for seven minutes.
std::shared_ptr<cb::Map const> road() {
  std::vector<cb::map::CurvePiece> pieces;
  for (int i = 0; i < 40; ++i) {
    double const bend = i % 2 == 0 ? 1e-3 : -1e-3;
    pieces.push_back({300.0, bend, bend});
  }
  cb::MapBuilder builder;
  builder.add_road(
      {.id = "1", .line = cb::map::lay_from({}, pieces), .sections = {{.right = cb::map::equal_lanes(3)}}});
  return builder.build();
}

World traffic() {
  World world(road(), {.seed = 42});
  cb::RandomStream random(42, 0, 0);
  for (std::uint32_t i = 0; i < 20; ++i) {
    double const speed = cb::Uniform{15.0, 22.0}(random);
    cb::IdmClassic const idm{.law = {.desired_speed = speed, .time_headway = cb::Uniform{0.8, 2.0}(random)}};
    World::Behavior behavior = idm;
    if (i == 8) {
      behavior = Planner{};
    } else if (i % 3 == 1) {
      cb::Mobil mobil;
      mobil.law.desired_speed = speed;
      behavior = mobil;
    } else if (i % 3 == 2) {
      cb::UrbanDriver driver;
      driver.law.desired_speed = speed;
      behavior = driver;
    }
    auto const& lane = world.map().lanes()[i % 3];
    auto const pose = lane.path.pose(40.0 + 25.0 * (i / 3));
    world.add({.position = pose.position(), .heading = pose.heading, .speed = speed, .behavior = behavior});
  }
  for (int k = 0; k < 10; ++k) static_cast<void>(world.step(0.2));
  return world;
}

/// The planner of agent 8 with a tree that it has kept for the next cycle.
struct Kept {
  World world = traffic();
  Planner planner{.others_keep_speed = false, .options = {.hold = 1}};
  Planner::Workspace workspace{};
  Planner::Memory memory = planner.think(world.observe(cb::AgentId{8}), {}, workspace).memory;
  bool is_kept = workspace.keep();

  void count(benchmark::State& state, std::string const& bytes) const {
    state.counters["bytes"] = static_cast<double>(bytes.size());
    state.counters["nodes"] = static_cast<double>(cb::detail::archived_trees(*workspace.kept()).trees[0].nodes.size());
  }
};

/// Appends numbers as a line of CSV, with all their digits, as those who want to repeat a run record them.
class Trace {
 public:
  void number(double value) {
    std::array<char, 32> text{};
    bytes_ +=
        static_cast<std::size_t>(std::to_chars(text.data(), text.data() + text.size(), value).ptr - text.data()) + 1;
  }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  std::size_t bytes_ = 0;
};

/// What the planner reads and says, every 10 ms of a cycle of 200 ms.
void trace_cycle(Trace& trace, World const& before, World const& after) {
  for (int k = 0; k < 20; ++k) {
    double const share = k / 20.0;
    trace.number(before.time() + 0.2 * share);
    for (cb::Slot slot{}; cb::index_of(slot) < before.size(); ++slot) {
      auto const& a = before.frame().agents[slot];
      auto const& b = after.frame().agents[slot];
      trace.number(static_cast<double>(cb::index_of(before.roster().agents[slot].id)));
      trace.number(a.state.x + share * (b.state.x - a.state.x));
      trace.number(a.state.y + share * (b.state.y - a.state.y));
      trace.number(a.state.heading + share * (b.state.heading - a.state.heading));
      trace.number(a.state.speed + share * (b.state.speed - a.state.speed));
      trace.number(b.action.acceleration);
      for (double const size :
           {before.roster().agents[slot].shape.length(), before.roster().agents[slot].shape.width()})
        trace.number(size);
    }
    auto const& ego = after.record(cb::AgentId{8});
    trace.number(ego.action.acceleration);
    trace.number(ego.action.steering);
  }
}

struct SevenMinutes {
  double bytes = 0.0, trace_bytes = 0.0, share_of_run = 0.0, seconds = 0.0;
};

/// Drives for seven minutes and keeps each cycle.
SevenMinutes record_seven_minutes() {
  auto const folder = std::filesystem::temp_directory_path() / "cambium_snapshot_bench";
  constexpr int cycles = 7 * 60 * 5;
  auto world = traffic();
  std::filesystem::remove_all(folder);
  std::chrono::duration<double> all{}, snapshots{};
  Trace trace;
  {
    cb::SnapshotRecorder recorder({.folder = folder, .each_cycle = true, .in_background = true});
    for (int i = 0; i < cycles; ++i) {
      auto const before = world;
      auto const start = std::chrono::steady_clock::now();
      recorder.begin(world);
      auto const planning = std::chrono::steady_clock::now();
      static_cast<void>(world.step(0.2));
      auto const planned = std::chrono::steady_clock::now();
      recorder.end(world);
      auto const end = std::chrono::steady_clock::now();
      all += end - start;
      snapshots += (planning - start) + (end - planned);
      trace_cycle(trace, before, world);
    }
    recorder.flush();
    if (recorder.written() != cycles) throw cb::SnapshotError("snapshot bench", recorder.problem());
  }
  double bytes = 0.0;
  for (auto const& entry : std::filesystem::directory_iterator(folder)) bytes += static_cast<double>(entry.file_size());
  std::filesystem::remove_all(folder);
  return {bytes, static_cast<double>(trace.bytes()), snapshots / all, all.count()};
}

/// One run, which takes a minute; all repetitions report it.
void measure_seven_minutes(benchmark::State& state) {
  static SevenMinutes const run = record_seven_minutes();
  yardstick::measure_duration(state, [] {});
  state.counters[yardstick::milliseconds] = 1e3 * run.seconds;
  state.counters["bytes"] = run.bytes;
  state.counters["share_of_run"] = run.share_of_run;
  state.counters["trace_bytes"] = run.trace_bytes;
  state.counters["trace_ratio"] = run.trace_bytes / run.bytes;
  static bool const is_told = [&] {
    std::printf(
        "seven minutes: %.2f MB in snapshots (target 10), %.2f %% of the run's time (target 1); trace %.1f MB, "
        "%.1f times as much (81 in Minnerup et al. 2016)\n",
        1e-6 * run.bytes, 100.0 * run.share_of_run, 1e-6 * run.trace_bytes, run.trace_bytes / run.bytes);
    return true;
  }();
  static_cast<void>(is_told);
}

void print_sizes(yardstick::Results const& results) {
  std::printf("\none snapshot: %zu bytes\n", cb::to_snapshot({}, traffic()).size());
  yardstick::print_targets(results, {{"snapshot/save/20", 20'000.0}, {"snapshot/restore/20", 50'000.0}});
}

}  // namespace

int main(int argc, char** argv) {
  yardstick::add("snapshot/save/20", [](benchmark::State& state) {
    auto const world = traffic();
    std::string bytes;
    yardstick::measure_queries(state, 1, [&] { bytes = cb::to_snapshot({}, world); });
    state.counters["bytes"] = static_cast<double>(bytes.size());
  });
  yardstick::add("snapshot/restore/20", [](benchmark::State& state) {
    auto world = traffic();
    auto const bytes = cb::to_snapshot({}, world);
    yardstick::measure_queries(state, 1, [&] { cb::from_snapshot(bytes, "snapshot", world); });
    state.counters["bytes"] = static_cast<double>(bytes.size());
  });
  yardstick::add("snapshot/save_kept_tree/20", [](benchmark::State& state) {
    Kept const kept;
    std::string bytes;
    yardstick::measure_queries(state, 1, [&] { bytes = cb::to_snapshot({}, kept.world, kept.memory, kept.workspace); });
    kept.count(state, bytes);
  });
  yardstick::add("snapshot/restore_kept_tree/20", [](benchmark::State& state) {
    Kept kept;
    auto const bytes = cb::to_snapshot({}, kept.world, kept.memory, kept.workspace);
    yardstick::measure_queries(state, 1,
                               [&] { cb::from_snapshot(bytes, "snapshot", kept.world, kept.memory, kept.workspace); });
    kept.count(state, bytes);
  });
  yardstick::add("snapshot/copy_of_frame/20", [](benchmark::State& state) {
    auto const world = traffic();
    auto frame = world.frame();
    yardstick::measure_queries(state, 1, [&] { frame = world.frame(); });
  });
  yardstick::add("snapshot/each_cycle_7min", measure_seven_minutes);
  return yardstick::run_benchmarks(argc, argv,
                                   "What snapshots cost: saving and restoring a world of 20 agents with a tree search, "
                                   "and seven minutes with each cycle on disk.",
                                   print_sizes);
}
