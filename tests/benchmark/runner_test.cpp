#include <cambium/cambium.hpp>
#include <cambium/benchmark/run_on_processes.hpp>
#include <cambium/benchmark/runner.hpp>
#include <cambium/core/write_file.hpp>
#include <doctest/doctest.h>
#include <sqlite3.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "../examples/program.hpp"
#include "../support/merging_set.hpp"
#include "../support/skipped.hpp"
#include "stored.hpp"

using namespace cambium;
using stored::files_in, stored::results_of, stored::rows_of;

namespace {

using Traffic = World<BehaviorSet<IdmClassic, Mobil>, InterpolateExecution, SingleTrack>;

enum class Fault : std::uint8_t { none, throws, throws_number, no_plan, crash, endless };

/// Keeps its speed, but for a fault in every plan.
struct Faulty {
  Fault fault = Fault::none;
  static constexpr auto parameters() {
    return parameter_list(
        choice("fault", &Faulty::fault, "none|throws|throws_number|no_plan|crash|endless", "in every plan"));
  }
  template <class View>
  Plan<View> plan(View const& view, NoMemory& memory, double dt) const {
    auto plan = ConstantAcceleration{}.plan(view, memory, dt);
    if (fault == Fault::throws) throw std::runtime_error("out of ideas");
    if (fault == Fault::throws_number) throw 42;
    if (fault == Fault::no_plan) plan.status = PlanStatus::failed;
    if (fault == Fault::crash) std::raise(SIGSEGV);
    while (fault == Fault::endless) std::this_thread::sleep_for(std::chrono::seconds(1));
    return plan;
  }
};

std::vector<Contender<Traffic>> contenders() {
  return {contender<Traffic>(IdmClassic{.law = {.desired_speed = 22.0}}), contender<Traffic>(Mobil{}),
          contender<Traffic>(ConstantAcceleration{}, "keep_speed"), contender<Traffic>(Faulty{Fault::throws}, "throws"),
          contender<Traffic>(Faulty{Fault::no_plan}, "gives_up")};
}

/// Does to a database what only its files allow. The first value that it gives.
std::string execute(std::filesystem::path const& file, char const* sql) {
  sqlite3* db = nullptr;
  std::string text;
  REQUIRE(sqlite3_open(file.c_str(), &db) == SQLITE_OK);
  auto const keep = [](void* to, int, char** values, char**) {
    if (values[0] != nullptr) *static_cast<std::string*>(to) = values[0];
    return 0;
  };
  CHECK(sqlite3_exec(db, sql, keep, &text, nullptr) == SQLITE_OK);
  sqlite3_close(db);
  return text;
}

using Predicted = Traffic::WithBehaviors<BehaviorSet<MacroActions, IdmProposal, ConstantAcceleration>>;

/// Believes that others, who drive at 10 m/s from x = their id on, rather stop; but not those who began beyond 290 m.
struct Doubting : ProposalPlanner<Predicted> {
  template <class View>
  [[nodiscard]] std::vector<Alternative> alternatives(View const& view, Memory const&, Workspace& workspace,
                                                      double duration) const {
    std::vector<Alternative> all;
    for (auto const& agent : workspace.predicted().roster().agents) {
      double const begin = static_cast<double>(index_of(agent.id)), x = begin + 10.0 * view.time(),
                   stops = begin < 290.0 ? 0.7 : 0.1;
      auto const add = [&](double probability, double way) {
        all.push_back({agent.id, probability, {.time = view.time() + duration, .x = x + way, .y = -5.25}});
      };
      add(1.0 - stops, 10.0 * duration);
      add(stops, 0.0);
    }
    return all;
  }
};

}  // namespace

TEST_CASE("results do not depend on threads, shards or interruptions") {
  browser::TemporaryFolder const folder;
  auto const set = support::merging_set<Traffic>(12);
  ResultStore one(folder.path() / "one.db"), four(folder.path() / "four.db"), first(folder.path() / "first.db"),
      second(folder.path() / "second.db");
  CHECK(run_benchmark(set, contenders(), one, {.executor = on_threads(1)}) == 60);
  CHECK(run_benchmark(set, contenders(), four, {.executor = on_threads(4)}) == 60);
  CHECK(results_of(one) == results_of(four));
  CHECK(run_benchmark(set, contenders(), one, {.executor = on_threads(1)}) == 0);
  CHECK(run_benchmark(set, contenders(), one, {.executor = on_threads(1), .again = true}) == 60);
  CHECK(results_of(one) == results_of(four));
  auto const half = run_benchmark(set, contenders(), first, {.executor = on_threads(2), .shard = 0, .shards = 2});
  CHECK(half == 30);
  for (std::size_t const shards : {0u, 2u})
    CHECK_THROWS_AS(run_benchmark(set, contenders(), first, {.shard = 2, .shards = shards}), ParameterError);
  CHECK(half + run_benchmark(set, contenders(), second, {.executor = on_threads(2), .shard = 1, .shards = 2}) == 60);
  first.begin_run("now", "the first");
  second.begin_run("now", "the second");
  CHECK(run_benchmark(set, contenders(), second, {.shard = 1, .shards = 2, .again = true}) == 30);
  first.merge(second);
  CHECK(results_of(first) == results_of(four));
  CHECK(execute(folder.path() / "first.db",
                "SELECT command FROM results JOIN runs USING(run) WHERE scenario = 1 LIMIT 1") == "the second");
  CHECK(run_benchmark(set, contenders(), second) == 30);  // goes on where it was
  CHECK(results_of(second) == results_of(four));
}

TEST_CASE("in processes, a behaviour that crashes or never returns costs its own runs only") {
  browser::TemporaryFolder const folder;
  auto set = support::merging_set<Traffic>(6);
  set.time_limit = 0.4;  // which also bounds the time of a job
  for (std::size_t i = 0; i < set.scenarios.size(); ++i) set.scenarios[i].seed = i + 1;
  auto const choose = [](auto const&, auto const& scenario) {
    return Faulty{scenario.seed % 2 == 1 ? Fault::crash : scenario.seed % 4 == 0 ? Fault::endless : Fault::none};
  };
  auto all = contenders();
  all.push_back(contender_by<Traffic>("hostile", "", 0, choose));
  ResultStore store(folder.path() / "r.db"), peaceful(folder.path() / "peaceful.db");
  CHECK(run_benchmark(set, all, store, {.executor = on_processes(2), .plan_limit = 1e-9}) == 36);
  int crashed = 0, endless = 0, other = 0;
  for (auto const& row : rows_of(store)) {
    if (row.key.behavior != "hostile") continue;
    bool const died = row.result.error_kind == RunErrorKind::process_died;
    crashed += died && row.result.error.find("died, twice: signal 11") != std::string::npos;
    endless += died && row.result.error.find("in which it gave no result") != std::string::npos;
    other += row.result.error_kind == RunErrorKind::plans_too_long && row.result.steps == 1;
  }
  CHECK(crashed == 3);
  CHECK(endless == 1);
  CHECK(other == 2);
  all.pop_back();
  CHECK(run_benchmark(set, all, store, {.executor = on_processes(3)}) == 18);  // a slow machine is no verdict for good
  CHECK(run_benchmark(set, all, peaceful, {.executor = on_threads(1)}) == 30);
  auto rows = rows_of(store);
  std::erase_if(rows, [](auto const& row) { return row.key.behavior == "hostile"; });
  auto const expected = rows_of(peaceful);
  REQUIRE(rows.size() == expected.size());
  for (std::size_t i = 0; i < rows.size(); ++i) CHECK(to_string(rows[i].result) == to_string(expected[i].result));
}

TEST_CASE("results of a process that has read other scenarios are refused") {
  browser::TemporaryFolder const folder;
  auto const set = support::merging_set<Traffic>(2), other = support::merging_set<Traffic>(1);
  ResultStore store(folder.path() / "r.db");
  auto const all = contenders();
  BenchmarkOptions const options;
  auto stranger = on_threads(1);
  stranger.execute = [&](auto const& jobs, auto const&, auto const& take, double limit) {
    on_threads(1).execute(jobs, detail::job_runner(other, other.hash(), all, options), take, limit);
  };
  CHECK_THROWS_WITH_AS(run_benchmark(set, all, store, {.executor = stranger}),
                       doctest::Contains("has read other scenarios"), Error);
  CHECK(rows_of(store).empty());
}

TEST_CASE("a run that throws or fails is a result") {
  browser::TemporaryFolder const folder;
  auto set = support::merging_set<Traffic>(2);
  set.scenarios[1].ego = AgentId{999};
  ResultStore store(folder.path() / "r.db");
  CHECK(run_benchmark(set, contenders(), store) == 10);
  std::map<std::string, int> errors;
  for (auto const& row : rows_of(store)) {
    CHECK_FALSE((row.result.success && !row.result.error.empty()));
    ++errors[row.key.behavior + ": " + row.result.error];
  }
  CHECK(errors["throws: out of ideas"] == 1);
  auto const odd = contender<Traffic>(Faulty{Fault::throws_number}, "odd").run(set.scenarios[0], {}, false);
  CHECK(odd.result.error == "threw what is no std::exception");
  CHECK(errors["idm_classic: "] == 1);
  CHECK(std::ranges::count_if(errors, [](auto const& entry) {
          return entry.first.find("agent 999, is not among its agents") != std::string::npos;
        }) == 5);
  CHECK(std::any_of(errors.begin(), errors.end(), [](auto const& entry) {
    return entry.first.find("gives_up: ") == 0 && entry.first.find("the behaviour found no plan") != std::string::npos;
  }));
}

TEST_CASE("who chooses from several behaviours drives as by the one that is chosen") {
  auto const set = support::merging_set<Traffic>(3);
  auto const same = [](RunResult const& a, RunResult const& b) { return hash_parameters(a) == hash_parameters(b); };
  auto const choosing = [](bool changes_lanes) {
    return contender_by<Traffic>("either", "", 1,
                                 [changes_lanes](auto const&, auto const&) -> OneOf<IdmClassic, Mobil> {
                                   if (changes_lanes) return Mobil{};
                                   return IdmClassic{.law = {.desired_speed = 22.0}};
                                 });
  };
  for (auto const& scenario : set.scenarios) {
    auto const follower =
        contender<Traffic>(IdmClassic{.law = {.desired_speed = 22.0}}).run(scenario, {}, false).result;
    auto const changer = contender<Traffic>(Mobil{}).run(scenario, {}, false).result;
    CHECK(same(choosing(false).run(scenario, {}, false).result, follower));
    CHECK(same(choosing(true).run(scenario, {}, false).result, changer));
    CHECK_FALSE(same(follower, changer));
  }
}

TEST_CASE("a result is what an own loop finds") {
  auto const set = support::merging_set<Traffic>(6);
  auto const idm = contender<Traffic>(IdmClassic{.law = {.desired_speed = 22.0}});
  for (auto const& scenario : set.scenarios) {
    auto const run = idm.run(scenario, {}, true);
    CHECK(run.result.error == "");
    auto const mine = with_behaviors<Traffic>(scenario, [&](auto const& spec) -> Traffic::Behavior {
      if (*spec.id == scenario.ego) return IdmClassic{.law = {.desired_speed = 22.0}};
      return spec.behavior.given();
    });
    auto world = mine.make_world();
    auto const slot = world.slot_of(scenario.ego);
    double speeds = 0.0, hardest = 0.0, least_gap = std::numeric_limits<double>::infinity();
    auto const look = [&] {
      if (auto const ahead = world.observe(slot).ahead({.merging = Merging::ignored}))
        least_gap = std::min(least_gap, ahead->gap);
    };
    look();
    while (!world.reached_goal(slot) && !Collision{}(world, slot) && world.time() < 59.9) {
      REQUIRE(world.step(0.2));
      look();
      speeds += world.state(scenario.ego).speed;
      hardest = std::max(hardest, -Acceleration{}(world, slot));
    }
    CHECK(run.result.least_gap == doctest::Approx(least_gap));
    CHECK(run.result.mean_speed == doctest::Approx(speeds / static_cast<double>(run.result.steps)));
    CHECK(run.result.hardest_braking == doctest::Approx(hardest));
    CHECK(run.result.duration_s == world.time());
    CHECK(run.result.success == (world.reached_goal(slot) && !Collision{}(world, slot)));
    CHECK(run.result.steps == static_cast<std::int64_t>(world.frame().step));
    CHECK(run.times.decisions == run.result.steps);
    REQUIRE(run.recording);
    CHECK(run.recording->frames.size() == world.frame().step + 1);
  }
}

TEST_CASE("what a planner expected of the others is compared with what they did") {
  // On a long road, others begin at `speed` and want to drive at 10 m/s. The planner expects them to keep their speed.
  auto const run = [](double speed, auto const& planner, std::vector<double> const& places = {180.0, 220.0, 300.0}) {
    Scenario<Traffic> scenario{.map = support::straight_road(2, 2000.0), .seed = 1};
    scenario.agents.push_back({.position = {200, -1.75}, .speed = 10.0, .id = AgentId{0}});
    for (double const x : places)  // more than 50 m away, it does not count
      scenario.agents.push_back({.position = {x, -5.25},
                                 .speed = speed,
                                 .behavior = IdmClassic{.law = {.desired_speed = 10.0}},
                                 .id = AgentId{static_cast<std::uint32_t>(x)}});
    scenario.ego = AgentId{0};
    return contender<Traffic>(planner).run(scenario, {.time_limit = 8.0}, false).result;
  };
  ProposalPlanner<Predicted> planner;
  planner.driver.law.desired_speed = 10.0;
  auto const right = run(10.0, planner), wrong = run(5.0, planner);
  for (char const* measure : {"prediction_error_1s", "prediction_error_3s", "prediction_error_5s", "prediction_brier"})
    CHECK(RunResult::better(measure) == Better::neither);  // they depend on where the ego drives, too
  CHECK(right.prediction_error_1s < 0.05);
  CHECK(right.prediction_error_5s < 0.5);
  CHECK(std::isnan(right.prediction_brier));  // it knows one course only
  // IDM accelerates by 1.7 (1 - (v / 10)^4) m/s^2.
  CHECK(wrong.prediction_error_1s > 0.1);
  CHECK(wrong.prediction_error_1s < 0.8);
  CHECK(wrong.prediction_error_3s > 4.0 * wrong.prediction_error_1s);
  CHECK(wrong.prediction_error_5s > wrong.prediction_error_3s);
  PolicyTreePlanner<Predicted> guessing;
  guessing.intentions.change = 0.45;  // else nobody seems to be about to change lanes
  auto const tree = run(10.0, guessing);
  CHECK(tree.prediction_brier > 0.0);
  CHECK(tree.prediction_brier < 2.0);
  CHECK(std::isnan(run(10.0, planner, {300.0}).prediction_error_1s));
  Doubting doubting;
  doubting.driver.law.desired_speed = 10.0;
  CHECK(run(10.0, doubting).prediction_brier == doctest::Approx(0.7 * 0.7 + 0.7 * 0.7));
  CHECK(std::isnan(run(10.0, IdmClassic{.law = {.desired_speed = 10.0}}).prediction_error_1s));
}

TEST_CASE("a Brier score is that of the alternatives, of which the nearest comes true") {
  Traffic world(support::straight_road(2, 900.0));
  auto const add = [&](double x, double y) {
    return world.add({.position = {x, y}, .speed = 10.0, .behavior = IdmClassic{.law = {.desired_speed = 10.0}}});
  };
  auto const ego = add(100.0, -5.25), id = add(100.0, -1.75), far = add(49.0, -1.75);
  auto const at = [&](double x, double probability, double time = 3.0) {
    return Alternative{id, probability, {.time = time, .x = x, .y = -1.75, .speed = 10.0}};
  };
  auto const brier_of = [&](std::vector<Alternative> const& all) {
    detail::PredictionJudge judge;
    auto copy = world;
    judge.note(all, copy.time(), judge.nearby(copy.roster(), ego, copy.frame()));
    RunResult result;
    for (int i = 0; i < 20; ++i) {
      REQUIRE(copy.step(0.2));
      judge.compare(copy);
      judge.write(result);
      if (i < 14) CHECK(std::isnan(result.prediction_brier));
    }
    return result.prediction_brier;
  };
  // Two ways end in one place.
  std::vector all{at(100.0, 0.2), at(131.0, 0.3), at(150.0, 0.1), at(130.5, 0.4)};
  double const expected = 0.2 * 0.2 + 0.3 * 0.3 + 0.1 * 0.1;
  CHECK(brier_of(all) == doctest::Approx(expected));
  for (double const probability : {0.1, 0.9}) {  // of one that is more than 50 m away
    all.push_back(at(50.0 + 40.0 * probability, probability));
    all.back().agent = far;
  }
  CHECK(brier_of(all) == doctest::Approx(expected));
  CHECK(std::isnan(brier_of({at(160.0, 0.2), at(160.5, 0.8)})));  // one way is no bet
  // Where it is counts when the ways end, 2 m further.
  CHECK(brier_of({at(130.8, 0.7, 3.2), at(132.2, 0.3, 3.2)}) == doctest::Approx(0.7 * 0.7 + 0.7 * 0.7));
  CHECK(brier_of({at(130.8, 0.7), at(132.2, 0.3)}) == doctest::Approx(0.3 * 0.3 + 0.3 * 0.3));
  CHECK(std::isnan(brier_of({at(120.0, 0.7, 2.0), at(130.0, 0.3, 2.0)})));  // it does not look as far ahead
  CHECK(std::isnan(brier_of({at(120.0, 0.7), at(130.0, 0.3, 3.2)})));       // nor as far in all ways
}

TEST_CASE("who leaves the map before its goal has left its way") {
  auto set = support::merging_set<Traffic>(1);
  auto& scenario = set.scenarios.front();
  auto const ego = std::ranges::find(scenario.agents, scenario.ego, [](auto const& spec) { return *spec.id; });
  auto const other = std::ranges::find_if(
      scenario.agents, [&](auto const& spec) { return std::holds_alternative<NoGoal>(spec.goal.given()); });
  REQUIRE(other != scenario.agents.end());
  REQUIRE(ego != scenario.agents.end());
  scenario.ego = *other->id;  // on the through road
  other->goal = Goal(StateLimits{.lowest_speed = 90.0});
  auto const run = contender<Traffic>(IdmClassic{.law = {.desired_speed = 22.0}}).run(scenario, {}, false);
  CHECK(run.result.error == "");
  CHECK_FALSE(run.result.success);
  CHECK_FALSE(run.result.timed_out);
  CHECK(run.result.off_route);
  CHECK_FALSE(run.result.off_road);
  CHECK(run.result.closed_loop_score == 0.0);
}

TEST_CASE("a store refuses files that are no databases of results, and leaves them as they are") {
  browser::TemporaryFolder const folder;
  CHECK_THROWS_AS(ResultStore(folder.path() / "no" / "where.db"), StoreError);
  CHECK_THROWS_AS(ResultStore::existing(folder.path() / "missing.db"), StoreError);
  CHECK(files_in(folder.path()).empty());
  auto const refused = [&](std::filesystem::path const& file, char const* words) {
    auto const before = program::content_of(file);
    CHECK_THROWS_WITH_AS(ResultStore{file}, doctest::Contains(words), StoreError);
    CHECK_THROWS_WITH_AS(ResultStore::existing(file), doctest::Contains("is no database of results"), StoreError);
    CHECK(program::content_of(file) == before);
  };
  write_file(folder.path() / "text.db", "this is no database, but may be mistaken for one: " + std::string(5000, 'x'));
  refused(folder.path() / "text.db", "text.db");
  execute(folder.path() / "people.db", "CREATE TABLE people(name TEXT)");
  refused(folder.path() / "people.db", "holds tables of another program");
  execute(folder.path() / "points.db", "CREATE TABLE results(points INTEGER)");
  refused(folder.path() / "points.db", "holds tables of another program");
}

TEST_CASE("a benchmark refuses contenders that are there twice, and steps without length") {
  browser::TemporaryFolder const folder;
  ResultStore store(folder.path() / "good.db");
  auto set = support::merging_set<Traffic>(1);
  auto twice = contenders();
  twice.push_back(twice[0]);
  CHECK_THROWS_AS(run_benchmark(set, twice, store), ParameterError);
  set.time_step = 0.0;
  CHECK_THROWS_AS(run_benchmark(set, contenders(), store), ParameterError);
}

TEST_CASE("a database that may only be read is read") {
  browser::TemporaryFolder const folder;
  auto const set = support::merging_set<Traffic>(2);
  auto const file = folder.path() / "a #100%?.db";
  std::string expected;
  {
    ResultStore store(file);
    run_benchmark(set, contenders(), store);
    expected = results_of(store);
  }
  std::filesystem::permissions(file, std::filesystem::perms(0444));
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0555));
  auto const user = geteuid();
  if (user == 0) REQUIRE(seteuid(65534) == 0);  // root may write everywhere
  bool const is_reachable = faccessat(AT_FDCWD, file.c_str(), R_OK, AT_EACCESS) == 0;
  std::string found, refusal;
  try {
    auto store = ResultStore::existing(file);
    found = results_of(store);
    ResultStore refused(file);
  } catch (StoreError const& problem) {
    refusal = problem.what();
  }
  if (user == 0) REQUIRE(seteuid(0) == 0);
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
  if (!is_reachable) {
    CHECK(refusal.find("unable to open database file") != std::string::npos);
    return support::skip("the build is in a folder that only root may enter");
  }
  CHECK(found == expected);
  CHECK(refusal.find("may not be written") != std::string::npos);
}

TEST_CASE("the replay of a failure goes when it is a failure no more") {
  browser::TemporaryFolder const folder;
  auto const set = support::merging_set<Traffic>(1);
  bool throws = true;
  auto const choose = [&](auto const&, auto const&) -> OneOf<IdmClassic, Faulty> {
    if (throws) return Faulty{Fault::throws};
    return IdmClassic{.law = {.desired_speed = 22.0}};
  };
  ResultStore store(folder.path() / "r.db");
  BenchmarkOptions options{.replays = Replays::failures, .replay_folder = folder.path() / "replays"};
  std::vector const moody{contender_by<Traffic>("moody", "", 0, choose)};
  run_benchmark(set, moody, store, options);
  CHECK(files_in(options.replay_folder).size() == 1);
  throws = false;
  options.again = true;
  run_benchmark(set, moody, store, options);
  REQUIRE(rows_of(store).front().result.success);
  CHECK(files_in(options.replay_folder).empty());
}

TEST_CASE("failures leave replays, up to a number of each contender") {
  browser::TemporaryFolder const folder;
  auto const set = support::merging_set<Traffic>(4);
  ResultStore store(folder.path() / "r.db");
  BenchmarkOptions options{.executor = on_threads(2),
                           .replays = Replays::failures,
                           .replay_folder = folder.path() / "replays",
                           .most_replays = 3,
                           .warn = [](auto const& sentence) { FAIL_CHECK(sentence); }};
  run_benchmark(set, contenders(), store, options);
  auto const files = files_in(options.replay_folder);
  std::map<std::string, std::size_t> failures, replays;
  for (auto const& row : rows_of(store)) {
    auto const file =
        replay_file_name(set.title, row.key.behavior, row.key.set_hash, row.key.parameters_hash, row.key.scenario);
    bool const is_there = std::find(files.begin(), files.end(), file) != files.end();
    failures[row.key.behavior] += !row.result.success;
    replays[row.key.behavior] += is_there;
    CHECK_FALSE((is_there && row.result.success));
  }
  CHECK(failures["throws"] == 4);
  CHECK(failures["idm_classic"] == 0);
  for (auto const& [name, count] : failures) CHECK(replays[name] == std::min<std::size_t>(count, 3));
  CHECK(program::content_of(options.replay_folder /
                            *std::find_if(files.begin(), files.end(),
                                          [](auto const& file) { return file.find("throws") != file.npos; }))
            .find("error: out of ideas") != std::string::npos);

  options.replays = Replays::all;
  options.again = true;
  options.replay_folder = folder.path() / "all";
  run_benchmark(set, contenders(), store, options);
  CHECK(files_in(options.replay_folder).size() == 20);
  options.replays = Replays::none;
  options.replay_folder = folder.path() / "no";
  run_benchmark(set, contenders(), store, options);
  CHECK_FALSE(std::filesystem::exists(options.replay_folder));
}

TEST_CASE("replays that cannot be written are reported once, and the results are there") {
  browser::TemporaryFolder const folder;
  write_file(folder.path() / "replays", "a file in the way");
  std::vector<std::string> warnings;
  ResultStore store(folder.path() / "r.db");
  run_benchmark(support::merging_set<Traffic>(3), contenders(), store,
                {.replays = Replays::all,
                 .replay_folder = folder.path() / "replays",
                 .warn = [&](auto const& sentence) { warnings.push_back(sentence); }});
  CHECK(rows_of(store).size() == 15);
  REQUIRE(warnings.size() == 1);
  CHECK(warnings.front().find("a replay or a snapshot is missing, and perhaps others: ") == 0);
  CHECK(warnings.front().find("replays") != std::string::npos);
}

TEST_CASE("a benchmark warns of steps longer than a driver's time headway, once and with the first such driver") {
  auto set = support::merging_set<Traffic>(2);
  std::vector<std::string> warnings;
  auto const run = [&](double time_step) {
    set.time_step = time_step;
    ResultStore store(":memory:");
    warnings.clear();
    run_benchmark(set, {contender<Traffic>(IdmClassic{})}, store,
                  {.warn = [&](auto const& sentence) { warnings.push_back(sentence); }});
  };
  run(0.2);
  CHECK(warnings.empty());
  run(5.0);
  REQUIRE(warnings.size() == 1);
  CHECK(warnings.front().find("scenario 0, agent ") != std::string::npos);
  CHECK(warnings.front().find("the step 5 s") != std::string::npos);
  CHECK(warnings.front().find("choose a shorter time_step") != std::string::npos);
}

TEST_CASE("a run whose plans take too long together ends with an error") {
  auto const set = support::merging_set<Traffic>(1);
  auto const idm = contender<Traffic>(IdmClassic{.law = {.desired_speed = 22.0}});
  auto const slow = idm.run(set.scenarios[0], {.plan_limit = 1e-12}, false);
  CHECK(slow.result.steps == 1);
  CHECK_FALSE(slow.result.success);
  CHECK(slow.result.error == "its plans took longer than 1e-12 s together");
  CHECK(slow.result.error_kind == RunErrorKind::plans_too_long);
  CHECK(idm.run(set.scenarios[0], {.plan_limit = 1e6}, false).result.error == "");

  browser::TemporaryFolder const folder;
  ResultStore store(folder.path() / "r.db");
  CHECK(run_benchmark(set, std::vector{idm}, store, {.plan_limit = 1e-12}) == 1);
  CHECK(run_benchmark(set, std::vector{idm}, store) == 1);  // a slow machine is no verdict for good
  CHECK(run_benchmark(set, std::vector{idm}, store) == 0);
  CHECK(rows_of(store).front().result.error == "");
}

TEST_CASE("an error names the agent that failed, and a failure of others is only counted") {
  using Mixed = World<BehaviorSet<IdmClassic, Faulty>, InterpolateExecution, SingleTrack>;
  Faulty const gives_up{Fault::no_plan};
  auto const plain = support::merging_set<Traffic>(1).scenarios[0];
  REQUIRE(plain.agents.size() >= 3);
  std::vector<AgentId> others;
  for (auto const& spec : plain.agents)
    if (*spec.id != plain.ego) others.push_back(*spec.id);
  auto scenario = with_behaviors<Mixed>(plain, [&](auto const& spec) -> Mixed::Behavior {
    if (*spec.id == others.front()) return gives_up;
    return std::get<IdmClassic>(spec.behavior.given());
  });
  auto const counted = contender<Mixed>(IdmClassic{.law = {.desired_speed = 22.0}}).run(scenario, {}, false).result;
  CHECK(counted.error == "");
  CHECK(counted.others_failed == 1);
  CHECK(counted.steps > 1);

  auto const both = contender<Mixed>(gives_up, "gives_up").run(scenario, {}, false).result;
  CHECK(both.error.find("agent " + to_string(plain.ego) + " (the ego)") == 0);
  CHECK(both.error.find("the behaviour found no plan") != std::string::npos);

  scenario.controlled = {others.back()};
  auto const choose = [&](auto const& spec, auto const&) { return *spec.id == others.back() ? gives_up : Faulty{}; };
  auto const controlled = contender_by<Mixed>("either", "", 0, choose).run(scenario, {}, false).result;
  CHECK(controlled.error.find("agent " + to_string(others.back()) + " (controlled)") == 0);
  CHECK(controlled.steps == 1);
}

TEST_CASE("agents see what their observers let them see, and a lonely ego has no gap") {
  using Noisy = World<BehaviorSet<IdmClassic>, InterpolateExecution, SingleTrack, ParametricObserver>;
  auto scenario = with_behaviors<Noisy>(
      support::merging_set<Traffic>(1).scenarios[0],
      [](auto const& spec) -> Noisy::Behavior { return std::get<IdmClassic>(spec.behavior.given()); });
  auto const idm = contender<Noisy>(IdmClassic{.law = {.desired_speed = 22.0}});
  auto const clear = idm.run(scenario, {}, false).result;
  for (auto& spec : scenario.agents) spec.observer = ParametricObserver{.others = {.along = 3.0}};
  auto const blurred = idm.run(scenario, {}, false).result;
  CHECK(blurred.error == "");
  CHECK(to_string(blurred) != to_string(clear));

  std::erase_if(scenario.agents, [&](auto const& spec) { return *spec.id != scenario.ego; });
  auto const alone = idm.run(scenario, {}, false).result;
  CHECK(alone.success);
  CHECK(std::isnan(alone.least_gap));
  CHECK(std::isnan(alone.least_time_to_collision));
  CHECK(std::isnan(alone.least_clearance));
  CHECK(std::isnan(alone.post_encroachment_time));
}

TEST_CASE("a store that cannot be read says so, and merges all of another or nothing") {
  browser::TemporaryFolder const folder;
  auto const set = support::merging_set<Traffic>(2);
  ResultStore first(folder.path() / "first.db"), second(folder.path() / "second.db");
  run_benchmark(set, contenders(), first, {.shard = 0, .shards = 2});
  run_benchmark(set, contenders(), second, {.shard = 1, .shards = 2});
  auto const before = results_of(first);
  execute(folder.path() / "second.db", "DROP TABLE times");
  CHECK_THROWS_AS(first.merge(second), StoreError);
  CHECK(results_of(first) == before);
  execute(folder.path() / "first.db", "DROP TABLE results");
  CHECK_THROWS_AS(static_cast<void>(first.has({.behavior = "idm"})), StoreError);
}

TEST_CASE("a database of an older version is read, and gets the columns that it lacks") {
  browser::TemporaryFolder const folder;
  auto const file = folder.path() / "old.db";
  auto const set = support::merging_set<Traffic>(2);
  std::vector const idm{contender<Traffic>(IdmClassic{.law = {.desired_speed = 22.0}})};
  std::string before;
  {
    ResultStore store(file);
    run_benchmark(set, idm, store);
    before = results_of(store);
  }
  for (char const* column :
       {"results DROP COLUMN others_failed", "results DROP COLUMN error_kind", "results DROP COLUMN hit",
        "results DROP COLUMN post_encroachment_time", "times DROP COLUMN overruns", "sets DROP COLUMN source"})
    execute(file, (std::string("ALTER TABLE ") + column).c_str());
  auto store = ResultStore::existing(file);
  CHECK(results_of(store) == before);
  CHECK(store.source_of(set.hash()) == "");
  CHECK(run_benchmark(set, idm, store, {.source = "--set merging"}) == 0);
  CHECK(store.source_of(set.hash()) == "--set merging");
  execute(file, "UPDATE results SET error = 'its plans took longer than 3 s together' WHERE scenario = 0");
  execute(file, "UPDATE results SET error = 'the process that ran it died, twice: signal 9' WHERE scenario = 1");
  auto machine = ResultStore::existing(file);
  CHECK(rows_of(machine)[0].result.error_kind == RunErrorKind::plans_too_long);
  CHECK(rows_of(machine)[1].result.error_kind == RunErrorKind::process_died);
  CHECK(run_benchmark(set, idm, machine) == 2);
}
