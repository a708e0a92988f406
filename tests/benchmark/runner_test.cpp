#include <cambium/cambium.hpp>
#include <cambium/benchmark/runner.hpp>
#include <cambium/map/opendrive.hpp>
#include <cambium/scenario/merging_site.hpp>
#include <cambium/core/write_file.hpp>
#include <doctest/doctest.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

using namespace cambium;

namespace {

using Traffic = World<BehaviorSet<IdmClassic, Mobil>, InterpolateExecution, SingleTrack>;

ScenarioSet<Traffic> merging_set(std::uint32_t count) {
  static auto const site = find_merging_site(load_opendrive(CAMBIUM_SOURCE_DIR "/maps/merging.xodr").map);
  ScenarioSet<Traffic> set{.title = "merging"};
  for (std::uint32_t i = 0; i < count; ++i) {
    set.scenarios.push_back(with_behaviors<Traffic>(
        site.sample(4, i), [](auto const& spec) -> Traffic::Behavior { return std::get<IdmClassic>(spec.behavior); }));
    set.scenarios.back().map_file = "merging.xodr";
  }
  return set;
}

/// Throws in every plan.
struct Throws {
  static constexpr char const* name = "throws";
  static constexpr auto parameters() { return parameter_list(); }
  template <class View>
  Plan<View> plan(View const&, NoMemory&, double) const {
    throw std::runtime_error("out of ideas");
  }
};
/// Returns no plan.
struct GivesUp {
  static constexpr char const* name = "gives_up";
  static constexpr auto parameters() { return parameter_list(); }
  template <class View>
  Plan<View> plan(View const&, NoMemory&, double) const {
    Plan<View> plan;
    plan.status = PlanStatus::failed;
    return plan;
  }
};

std::vector<Contender<Traffic>> contenders() {
  return {contender<Traffic>(IdmClassic{.desired_speed = 22.0}), contender<Traffic>(Mobil{}),
          contender<Traffic>(ConstantAcceleration{}, "keep_speed"), contender<Traffic>(Throws{}),
          contender<Traffic>(GivesUp{})};
}

/// A folder that is removed at the end.
struct Folder {
  std::filesystem::path path = std::filesystem::path(CAMBIUM_BUILD_DIR) / "benchmark_test";
  Folder() {
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path);
  }
  ~Folder() { std::filesystem::remove_all(path); }
};

std::vector<ResultRow> rows_of(ResultStore& store) {
  std::vector<ResultRow> rows;
  store.for_each([&](ResultRow const& row) { rows.push_back(row); });
  return rows;
}

/// The rows but for their times, as text.
std::string results_of(ResultStore& store) {
  std::string text;
  for (auto const& row : rows_of(store))
    text += row.key.behavior + " " + std::to_string(row.key.scenario) + " " + std::to_string(row.seed) + " " +
            to_string(row.result) + "\n";
  return text;
}

}  // namespace

TEST_CASE("results do not depend on threads, shards or interruptions") {
  Folder folder;
  auto const set = merging_set(12);
  ResultStore one(folder.path / "one.db"), four(folder.path / "four.db"), first(folder.path / "first.db"),
      second(folder.path / "second.db");
  CHECK(run_benchmark(set, contenders(), one, {.threads = 1}) == 60);
  CHECK(run_benchmark(set, contenders(), four, {.threads = 4}) == 60);
  CHECK(results_of(one) == results_of(four));
  CHECK(run_benchmark(set, contenders(), one, {.threads = 1}) == 0);
  CHECK(run_benchmark(set, contenders(), one, {.threads = 1, .again = true}) == 60);
  CHECK(results_of(one) == results_of(four));
  auto const half = run_benchmark(set, contenders(), first, {.threads = 2, .shard = 0, .shards = 2});
  CHECK(half == 30);
  CHECK(half + run_benchmark(set, contenders(), second, {.threads = 2, .shard = 1, .shards = 2}) == 60);
  first.merge(second);
  CHECK(results_of(first) == results_of(four));
  CHECK(run_benchmark(set, contenders(), second) == 30);  // goes on where it was
  CHECK(results_of(second) == results_of(four));
}

TEST_CASE("a run that throws or fails is a result") {
  Folder folder;
  auto set = merging_set(2);
  set.scenarios[1].ego = AgentId{999};
  ResultStore store(folder.path / "r.db");
  CHECK(run_benchmark(set, contenders(), store) == 10);
  std::map<std::string, int> errors;
  for (auto const& row : rows_of(store)) {
    CHECK_FALSE((row.result.success && !row.result.error.empty()));
    ++errors[row.key.behavior + ": " + row.result.error];
  }
  CHECK(errors["throws: out of ideas"] == 1);
  CHECK(errors["idm_classic: "] == 1);
  for (auto const& [text, count] : errors)
    if (text.find("999") != std::string::npos) CHECK(text.find("is not among its agents") != std::string::npos);
  CHECK(std::any_of(errors.begin(), errors.end(), [](auto const& entry) {
    return entry.first.find("gives_up: ") == 0 && entry.first.find("the behaviour found no plan") != std::string::npos;
  }));
}

TEST_CASE("a result is what an own loop finds") {
  auto const set = merging_set(6);
  auto const idm = contender<Traffic>(IdmClassic{.desired_speed = 22.0});
  for (auto const& scenario : set.scenarios) {
    auto const run = idm.run(scenario, {}, true);
    CHECK(run.result.error == "");
    auto const mine = with_behaviors<Traffic>(scenario, [&](auto const& spec) -> Traffic::Behavior {
      if (*spec.id == scenario.ego) return IdmClassic{.desired_speed = 22.0};
      return spec.behavior.given();
    });
    auto world = mine.make_world();
    auto const slot = world.slot_of(scenario.ego);
    while (!world.reached_goal(slot) && !Collision{}(world, slot) && world.time() < 59.9) REQUIRE(world.step(0.2));
    CHECK(run.result.success == (world.reached_goal(slot) && !Collision{}(world, slot)));
    CHECK(run.result.steps == static_cast<std::int64_t>(world.frame().step));
    CHECK(run.times.decisions == run.result.steps);
    REQUIRE(run.recording);
    CHECK(run.recording->frames.size() == world.frame().step + 1);
  }
}

TEST_CASE("a store refuses what it cannot use") {
  Folder folder;
  CHECK_THROWS_AS(ResultStore(folder.path / "no" / "where.db"), StoreError);
  write_file(folder.path / "text.db",
             "this is no database, but long enough to be mistaken for one: " + std::string(5000, 'x'));
  CHECK_THROWS_AS(ResultStore(folder.path / "text.db"), StoreError);
  ResultStore store(folder.path / "good.db");
  auto twice = contenders();
  twice.push_back(twice[0]);
  CHECK_THROWS_AS(run_benchmark(merging_set(1), twice, store), ParameterError);
  auto still = merging_set(1);
  still.time_step = 0.0;
  CHECK_THROWS_AS(run_benchmark(still, contenders(), store), ParameterError);
}
