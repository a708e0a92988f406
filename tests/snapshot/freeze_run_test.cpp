// The snapshot that a benchmark keeps with each failure.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "../viewer/browser.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/benchmark/run_on_processes.hpp"
#include "cambium/benchmark/runner.hpp"
#include "cambium/cambium.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/snapshot/freeze_run.hpp"
#include "support/maps.hpp"
#include "support/merging_set.hpp"

using namespace cambium;

namespace {

using Traffic = World<BehaviorSet<IdmClassic, Mobil>, InterpolateExecution, SingleTrack>;

/// Keeps its speed; after `until` [s] it gives up, or throws.
struct Tired {
  double until = 1.1;
  bool throws = false;

  static constexpr char const* name = "tired";
  static constexpr auto parameters() {
    return parameter_list(parameter("until", &Tired::until, "s", non_negative, "how long it drives"),
                          parameter("throws", &Tired::throws, "what then"));
  }
  template <class View>
  Plan<View> plan(View const& view, NoMemory& memory, double dt) const {
    if (view.time() < until) return ConstantAcceleration{}.plan(view, memory, dt);
    if (throws) throw std::runtime_error("out of ideas");
    Plan<View> plan;
    plan.status = PlanStatus::failed;
    return plan;
  }
};

/// What a contender keeps of the first scenario, as it thaws.
template <class Behavior>
struct Kept {
  ContenderWorld<Traffic, Behavior> world{support::own_map("merging.xodr")};
  RunPosition position{};
  SnapshotInfo info{};
};
template <class Behavior>
Kept<Behavior> kept(Behavior const& behavior) {
  auto const set = support::merging_set<Traffic>(1);
  auto const run =
      contender<Traffic>(behavior, "ours", freeze_run).run(set.scenarios[0], {.label = "merging, 0"}, true);
  CHECK_FALSE(run.result.success);
  CHECK(run.problem.empty());
  Kept<Behavior> kept;
  from_snapshot(run.snapshot, "kept", kept.world, kept.position);
  kept.info = snapshot_info(run.snapshot);
  CHECK(kept.info.component == "ours");
  CHECK(kept.info.map_file == "merging.xodr");
  CHECK(kept.info.parts == "world, run");
  CHECK(kept.position.ego == set.scenarios[0].ego);
  CHECK(kept.position.time_step == 0.2);
  return kept;
}

}  // namespace

TEST_CASE("a collision is kept from 3 s before it, and comes again") {
  auto [world, position, info] = kept(ConstantAcceleration{.acceleration = 3.0});
  CHECK(info.note == "merging, 0: 15 cycles before collision, at fault");
  auto const slot = world.slot_of(position.ego);
  for (int i = 0; i < 15; ++i) {
    CHECK_FALSE(Collision{}(world, slot));
    REQUIRE(world.step(position.time_step));
    if (i == 0) CHECK(snapshot_hash(world) == info.result);
  }
  CHECK(Collision{}(world, slot));
}

TEST_CASE("a run that ends with an error is kept from just before it") {
  {
    auto [world, position, info] = kept(Tired{});
    CHECK(info.note.find("merging, 0: 1 cycle before error: agent ") == 0);
    CHECK(world.time() == doctest::Approx(1.2));
    auto const again = world.step(position.time_step);
    CHECK_FALSE(again);
    CHECK(again.agent == position.ego);
    CHECK(snapshot_hash(world) == info.result);
  }
  auto [world, position, info] = kept(Tired{.throws = true});
  CHECK(info.note == "merging, 0: 1 cycle before error: out of ideas");
  CHECK(world.time() == doctest::Approx(1.2));
  CHECK_FALSE(info.result);
  CHECK_THROWS_WITH(static_cast<void>(world.step(position.time_step)), "out of ideas");
}

TEST_CASE("a benchmark writes snapshots beside the replays of failures, also from other processes") {
  auto const set = support::merging_set<Traffic>(3);
  std::vector const all{contender<Traffic>(Tired{}, "tired", freeze_run), contender<Traffic>(Tired{}, "plain"),
                        contender<Traffic>(IdmClassic{.law = {.desired_speed = 22.0}}, "idm", freeze_run)};
  std::vector<std::string> first;
  for (bool const in_processes : {false, true}) {
    browser::TemporaryFolder const folder;
    ResultStore store(folder.path() / "r.db");
    BenchmarkOptions options{.replays = Replays::failures,
                             .replay_folder = folder.path() / "replays",
                             .warn = [](auto const& sentence) { FAIL_CHECK(sentence); }};
#if CAMBIUM_HAS_PROCESSES
    if (in_processes) options.executor = on_processes(2);
#endif
    run_benchmark(set, all, store, options);
    std::vector<std::string> bytes, names;
    for (auto const& entry : std::filesystem::directory_iterator(options.replay_folder)) {
      if (entry.path().extension() != ".snapshot") continue;
      names.push_back(entry.path().string());
      CHECK(std::filesystem::exists(std::filesystem::path(entry.path()).replace_extension(".html")));
    }
    REQUIRE(names.size() == 3);
    std::sort(names.begin(), names.end());
    for (auto const& name : names) {
      CHECK(name.find("merging_tired_") != name.npos);
      bytes.push_back(read_snapshot_file(name));
    }
    if (in_processes) CHECK(bytes == first);
    first = bytes;
    options.again = true;
    options.replays = Replays::all;
    std::vector const forgetful{contender<Traffic>(Tired{}, "tired"), all[1], all[2]};
    run_benchmark(set, forgetful, store, options);
    for (auto const& name : names) CHECK_FALSE(std::filesystem::exists(name));  // of an earlier result
  }
}
