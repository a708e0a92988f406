#include "cambium/tracking/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "../../bench/yardstick/driven.hpp"
#include "../support/maps.hpp"
#include "../support/scale.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/random.hpp"
#include "objects.hpp"

namespace cb = cambium;
using objects::cycle, objects::not_a_number, objects::object, objects::system_clock;

namespace {

/// The world `seconds` later.
cb::TrackedWorld later(cb::TrackedWorld world, double seconds) {
  for (int i = 0; i < std::lround(10.0 * seconds); ++i) {
    auto const result = world.step(0.1);
    CAPTURE(to_string(result.problem));
    CHECK(result);
  }
  return world;
}

/// What becomes of one object on a map, tracked for a second of constant motion.
struct Followed {
  std::shared_ptr<cb::Map const> map;
  cb::Tracker<> tracker{map};
  cb::Verdict verdict;

  Followed(std::shared_ptr<cb::Map const> on, cb::TrackedObject seen) : map(std::move(on)) {
    for (int i = 0; i < 10; ++i) {
      verdict = tracker.update(system_clock + i * cycle, std::vector{seen}).front();
      seen.x += 0.1 * seen.vx;
      seen.y += 0.1 * seen.vy;
    }
  }

  [[nodiscard]] cb::State now() { return tracker.world().state(verdict.agent); }
  [[nodiscard]] cb::State after(double seconds) { return later(tracker.world(), seconds).state(verdict.agent); }
};

}  // namespace

TEST_CASE("odd objects have verdicts, and those beside them are tracked all the same") {
  auto const map = support::own_map("intersection_4way.xodr");
  cb::Tracker<> tracker(map);
  auto const good = object(0, -60.0, -1.75, 0.0, 10.0);
  auto missing = object(2, not_a_number, 0.0, 0.0, 5.0), fast = object(3, -40.0, -1.75, 0.0, 400.0),
       far = object(4, 1e9, 0.0, 0.0, 5.0);
  auto late = object(5, -40.0, -5.25, 0.0, 5.0), ghost = object(6, -40.0, -5.25, 0.0, 5.0);
  late.stamp = system_clock - 5'000'000'000;
  ghost.existence = 0.01;
  auto sizeless = object(7, -30.0, -5.25, 0.0, 8.0), reverses = object(8, -50.0, -12.0, 0.0, -0.5);
  sizeless.length = not_a_number;
  sizeless.width = -1.0;
  std::vector const list{good,  missing,  fast,     far,  late,
                         ghost, sizeless, reverses, good, object(9, -80.0, 1.75, 0.0, 8.0)};
  auto const verdicts = tracker.update(system_clock, list);
  std::vector<cb::Refusal> refusals;
  for (auto const& verdict : verdicts) refusals.push_back(verdict.refusal);
  using R = cb::Refusal;
  CHECK(refusals == std::vector{R::none, R::not_finite, R::out_of_range, R::out_of_range, R::too_old, R::unlikely,
                                R::none, R::none, R::duplicate, R::none});
  CHECK(tracker.world().size() == 4);
  CHECK(verdicts[0].motion == cb::ObjectMotion::follows_lane);
  CHECK(verdicts[6].assumed_size);
  CHECK(verdicts[9].motion == cb::ObjectMotion::wrong_way);
  CHECK(tracker.agent_of({0, 0}) == verdicts[0].agent);
  CHECK_FALSE(tracker.agent_of({0, 2}));
  for (auto const& verdict : verdicts) CHECK(std::string(to_string(verdict.refusal)).size() > 10);
  later(tracker.world(), 3.0);
}

TEST_CASE("a list that is not newer than the last one changes nothing") {
  cb::Tracker<> tracker(support::own_map("highway.xodr"));
  tracker.update(system_clock, std::vector{object(1, 100.0, -1.75, 0.0, 20.0)});
  auto const before = tracker.world().frame();
  for (auto const stamp : {system_clock, system_clock - cycle, std::int64_t{-5}})
    CHECK(tracker.update(stamp, std::vector{object(1, 300.0, -1.75, 0.0, 20.0)}).front().refusal ==
          cb::Refusal::too_old);
  CHECK(tracker.world().frame() == before);
}

TEST_CASE("an object keeps its agent while its list lacks it, goes on as predicted, and is forgotten then") {
  cb::Tracker<> tracker(support::own_map("highway.xodr"), {.keep_unseen = 0.5});
  auto const agent = tracker.update(system_clock, std::vector{object(1, 100.0, -1.75, 0.0, 20.0)}).front().agent;
  double const x = tracker.world().state(agent).x;
  for (int i = 1; i <= 5; ++i) tracker.update(system_clock + i * cycle, {});
  CHECK(tracker.world().state(agent).x == doctest::Approx(x + 10.0).epsilon(0.01));
  CHECK(tracker.update(system_clock + 6 * cycle, std::vector{object(1, 112.0, -1.75, 0.0, 20.0)}).front().agent ==
        agent);
  for (int i = 7; i <= 12; ++i) tracker.update(system_clock + i * cycle, {});
  CHECK(tracker.world().size() == 0);
  CHECK_FALSE(tracker.agent_of({0, 1}));
  CHECK(tracker.update(system_clock + 13 * cycle, std::vector{object(1, 112.0, -1.75, 0.0, 20.0)}).front().agent !=
        agent);
}

TEST_CASE("motion goes on as it was measured") {
  auto const highway = support::own_map("highway.xodr"), crossing = support::own_map("intersection_4way.xodr");
  {
    INFO("a free driver keeps its speed, though it is higher than others desire");
    CHECK(Followed(highway, object(1, 100.0, -1.75, 0.0, 27.0)).after(3.0).speed ==
          doctest::Approx(27.0).epsilon(0.02));
  }
  {
    INFO("one that stands for no reason stays");
    CHECK(Followed(highway, object(1, 100.0, -1.75, 0.0, 0.0)).after(5.0).speed == 0.0);
  }
  {
    INFO("one that brakes goes on braking, and less with time");
    auto brakes = object(1, 100.0, -1.75, 0.0, 20.0);
    brakes.acceleration = -4.0;
    cb::Tracker<> tracker(highway);
    auto const agent = tracker.update(system_clock, std::vector{brakes}).front().agent;
    CHECK(later(tracker.world(), 0.5).state(agent).speed < 18.8);
    CHECK(later(tracker.world(), 3.0).state(agent).speed > 10.0);
  }
  {
    INFO("a pedestrian walks straight across, one that stands stays");
    auto walks = object(1, -40.0, -9.0, 1.6, 1.2), stands = object(2, -40.0, -9.0, 1.6, 0.0);
    walks.kind = stands.kind = cb::ObjectClass::pedestrian;
    Followed on_foot(crossing, walks);
    auto const now = on_foot.now(), then = on_foot.after(3.0);
    CHECK(on_foot.verdict.motion == cb::ObjectMotion::walks);
    CHECK(then.y - now.y == doctest::Approx(3.6).epsilon(0.05));
    CHECK(then.heading == doctest::Approx(now.heading).epsilon(0.01));
    CHECK(Followed(crossing, stands).after(5.0).y == doctest::Approx(-9.0));
  }
  {
    INFO("a car aslant to its lane does not jump into its direction");
    Followed aslant(highway, object(1, 100.0, -4.0, 1.4, 3.0));
    CHECK(std::abs(aslant.after(0.1).heading - aslant.now().heading) < 0.1);
  }
  {
    INFO("one that reverses goes on backwards");
    Followed reverses(highway, object(1, 100.0, -1.75, 0.0, -2.0));
    CHECK(reverses.verdict.motion == cb::ObjectMotion::reverses);
    CHECK(reverses.after(1.0).x == doctest::Approx(reverses.now().x - 2.0).epsilon(0.01));
    CHECK(std::abs(cb::geometry::angle_difference(reverses.now().heading, cb::geometry::pi)) < 1e-6);
  }
  {
    INFO("the box is where it was");
    auto const box = object(1, 100.0, -1.75, 0.0, 20.0);
    cb::Tracker<> tracker(highway);
    auto const agent = tracker.update(system_clock, std::vector{box}).front().agent;
    auto const& shape = tracker.world().roster().agents[cb::Slot{}].shape;
    CHECK(tracker.world().state(agent).x + shape.center_offset() == doctest::Approx(100.0));
  }
}

TEST_CASE("others brake for what comes from beside the lanes") {
  cb::Tracker<> tracker(support::own_map("highway.xodr"));
  auto car = object(1, 100.0, -5.25, 0.0, 14.0), leaves = object(2, 135.0, -11.0, 1.5, 1.5);
  leaves.kind = cb::ObjectClass::car;
  auto const verdicts = tracker.update(system_clock, std::vector{car, leaves});
  CHECK(verdicts[1].motion == cb::ObjectMotion::off_lanes);
  auto const agent = verdicts[0].agent;
  CHECK(later(tracker.world(), 2.0).state(agent).speed < 13.0);
}

TEST_CASE("the same lists give the same bits, and the order of a list does not matter") {
  auto const map = support::own_map("roundabout.xodr");
  auto const run = [&](bool reversed) {
    cb::Tracker<> tracker(map);
    cb::RandomStream random(3, 0, 0);
    for (int i = 0; i < 20; ++i) {
      std::vector<cb::TrackedObject> list;
      for (std::uint64_t id = 0; id < 12; ++id)
        list.push_back(
            object(id, -60.0 + 10.0 * static_cast<double>(id) + i, -1.75 + cb::uniform01(random), 0.0, 10.0));
      if (reversed && i > 0) std::reverse(list.begin(), list.end());
      tracker.update(system_clock + i * cycle, list);
    }
    return later(tracker.world(), 2.0).frame();
  };
  auto const first = run(false);
  CHECK(first == run(false));
  CHECK(first == run(true));
}

// Costs 2 s of CPU; a minute in `tests/run --all`.
TEST_CASE("whatever a sensor sends, the tracker answers, and all that it predicts are numbers") {
#ifdef CAMBIUM_QUICK_TESTS
  constexpr double share = 0.1;
#else
  constexpr double share = 1.0;
#endif
  std::uint32_t most = 5, lists = 0;
  SUBCASE("lists of up to 5") { lists = support::runs(1e6 * share); }
  SUBCASE("lists of up to 100") {
    most = 100;
    lists = support::runs(1e4 * share);
  }
  auto const map = support::own_map("intersection_4way.xodr");
  cb::RandomStream random(11, 0, 0);
  double const odd[] = {
      not_a_number, std::numeric_limits<double>::infinity(), -1e300, 1e300, 0.0, -0.0, 1e-310, 1e8, -1.0, 4e9};
  auto const number = [&](double low, double high) {
    return cb::uniform01(random) < 0.04 ? odd[cb::uniform_index(random, 10)]
                                        : low + cb::uniform01(random) * (high - low);
  };
  cb::Tracker<> tracker(map);
  std::vector<cb::PredictedState> states;
  std::int64_t stamp = system_clock;
  for (std::uint32_t i = 0; i < lists; ++i) {
    std::vector<cb::TrackedObject> list(cb::uniform_index(random, most + 1));
    for (auto& o : list) {
      o = object(cb::uniform_index(random, 2 * most + 2), number(-90.0, 90.0), number(-90.0, 90.0), number(-4.0, 4.0),
                 0.0);
      o.vx = number(-20.0, 20.0);
      o.vy = number(-20.0, 20.0);
      o.length = number(0.0, 20.0);
      o.width = number(0.0, 3.0);
      o.yaw_rate = number(-1.0, 1.0);
      o.acceleration = number(-9.0, 4.0);
      o.existence = number(0.0, 1.0);
      o.kind = static_cast<cb::ObjectClass>(cb::uniform_index(random, 10));
      o.point = static_cast<cb::ObjectPoint>(cb::uniform_index(random, 2));
      o.heading_known = static_cast<cb::HeadingKnown>(cb::uniform_index(random, 3));
      o.is_parked = cb::uniform01(random) < 0.1;
      auto const stamps = cb::uniform01(random);
      if (stamps < 0.2) o.stamp = stamp + static_cast<std::int64_t>(1.2e8 * (cb::uniform01(random) - 0.5));
      if (stamps < 0.01) o.stamp = std::numeric_limits<std::int64_t>::min();
    }
    stamp +=
        cb::uniform01(random) < 0.02 ? -cycle : static_cast<std::int64_t>(1e8 * (0.7 + 0.6 * cb::uniform01(random)));
    auto const verdicts = tracker.update(stamp, list);
    REQUIRE(verdicts.size() == list.size());
    if (i % 50 != 0) continue;
    std::vector<cb::PredictedState> course(cb::uniform_index(random, 12));
    for (auto& state : course)
      state = {number(-90.0, 90.0), number(-90.0, 90.0), number(-4.0, 4.0), number(-9.0, 30.0)};
    std::vector<cb::GivenTrajectory> const given{{{0, cb::uniform_index(random, 12)}, course, number(0.0, 1.0)},
                                                 {{0, 3}, course, number(0.0, 1.0)}};
    states.assign(3 * tracker.objects().size() * 10, {not_a_number, 0.0, 0.0, 0.0});
    auto const choose = [&](cb::ObjectKey const& key, cb::PredictedMode const&) {
      using Chosen = std::optional<cb::TrackedWorld::Behavior>;
      if (key.low % 3 == 0) return Chosen(cb::ConstantTurn{});
      auto const driver = tracker.driver_of(key);
      return driver && i % 4 == 0 ? Chosen(*driver) : Chosen();
    };
    auto const modes = tracker.predict(
        {.steps = 10, .step = 0.05 + 0.8 * cb::uniform01(random), .modes = 3, .joint = i % 3 == 0, .given = given},
        states, choose);
    for (auto const& [x, y, heading, speed] : states) REQUIRE(std::isfinite(x + y + heading + speed));
    for (std::size_t o = 0; o < modes.objects.size(); ++o) {
      double const sum = modes.mode(0, o).probability + modes.mode(1, o).probability + modes.mode(2, o).probability;
      REQUIRE(sum == doctest::Approx(1.0));
    }
  }
}

// Costs 2 s of CPU.
TEST_CASE("predictions of the tracker's world beat constant turn rate and velocity where drivers differ from its own") {
  struct Errors {
    double tracker = 0.0, ctrv = 0.0;
    int count = 0;
  };
  std::map<std::string, Errors> errors;
  using Truth = cb::World<cb::BehaviorSet<cb::UrbanDriver, cb::Mobil>, cb::InterpolateExecution, cb::SingleTrack>;
  struct Predicted {
    int step;
    cb::AgentId agent;
    cb::State tracker, ctrv;
  };
  for (auto const* name : {"intersection_4way", "roundabout", "merging"}) {
    auto const map = support::own_map(std::string(name) + ".xodr");
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      Truth world(map, {.seed = seed});
      yardstick::fill(world, seed);
      cb::RandomStream random(seed, 1, 1);
      for (auto const& agent : world.roster().agents) {
        cb::UrbanDriver driver;
        driver.law.desired_speed = 8.0 + 10.0 * cb::uniform01(random);
        driver.law.time_headway = 0.8 + cb::uniform01(random);
        driver.heed<cb::SpeedLimit>().factor = 0.8 + 0.4 * cb::uniform01(random);
        if (agent.shape == cb::geometry::car()) world.set_behavior(agent.id, driver);
      }
      cb::Tracker<> tracker(map);
      std::vector<Truth::FrameType> frames;
      std::vector<Predicted> predicted;
      for (int step = 0; step < 200; ++step) {
        std::vector<cb::TrackedObject> list;
        for (cb::Slot slot{}; index_of(slot) < world.size(); ++slot) {
          auto const& record = world.frame().agents[slot];
          if (record.status != cb::AgentStatus::driving) continue;
          auto const& [id, shape, road, behavior, execution, dynamics, observer] = world.roster().agents[slot];
          auto const noise = [&](double deviation) { return cb::Normal{0.0, deviation}(random); };
          auto const center = cb::geometry::to_map({record.state.x, record.state.y, record.state.heading},
                                                   {shape.center_offset(), 0.0});
          auto seen = object(index_of(id), center.x() + noise(0.05), center.y() + noise(0.05),
                             record.state.heading + noise(0.01), record.state.speed + noise(0.1));
          seen.length = shape.length();
          seen.width = shape.width();
          list.push_back(seen);
        }
        auto const verdicts = tracker.update(system_clock + step * cycle, list);
        if (step >= 10 && step % 10 == 0 && step < 170) {
          auto const future = later(tracker.world(), 3.0);
          for (std::size_t i = 0; i < list.size(); ++i) {
            auto at = tracker.world().state(verdicts[i].agent);
            double const rate = tracker.yaw_rate(verdicts[i].agent);
            for (int k = 0; k < 300; ++k) {
              at.x += 0.01 * at.speed * std::cos(at.heading);
              at.y += 0.01 * at.speed * std::sin(at.heading);
              at.heading += 0.01 * rate;
            }
            predicted.push_back({step, static_cast<cb::AgentId>(list[i].key.low), future.state(verdicts[i].agent), at});
          }
        }
        frames.push_back(world.frame());
        CHECK(world.step(0.1));
      }
      for (auto const& p : predicted) {
        auto const slot = world.slot_of(p.agent);
        auto const &now = frames[static_cast<std::size_t>(p.step)].agents[slot],
                   &then = frames[static_cast<std::size_t>(p.step) + 30].agents[slot];
        if (then.status != cb::AgentStatus::driving) continue;
        double const turned = std::abs(cb::geometry::angle_difference(now.state.heading, then.state.heading));
        bool const stands = now.state.speed < 0.3, stood = then.state.speed < 0.3;
        auto& sums = errors[turned > 0.35                                        ? "turns"
                            : stands                                             ? (stood ? "stands" : "starts")
                            : std::abs(then.state.speed - now.state.speed) > 3.0 ? "changes speed"
                                                                                 : "follows"];
        auto const distance = [&](cb::State const& s) { return std::hypot(s.x - then.state.x, s.y - then.state.y); };
        sums.tracker += distance(p.tracker);
        sums.ctrv += distance(p.ctrv);
        ++sums.count;
      }
    }
  }
  for (auto const* kind : {"turns", "starts", "changes speed", "follows"}) {
    auto const& sums = errors[kind];
    CAPTURE(kind);
    CAPTURE(sums.tracker / sums.count);
    CAPTURE(sums.ctrv / sums.count);
    CHECK(sums.count > 30);
    CHECK(sums.tracker < 0.7 * sums.ctrv);
  }
  CHECK(errors["stands"].tracker / errors["stands"].count < 1.5);
}

TEST_CASE("a tracker says what is wrong with its parameters") {
  CHECK_THROWS_AS(cb::Tracker<>(nullptr), cb::WorldError);
  CHECK_THROWS_AS(cb::Tracker<>(support::own_map("highway.xodr"), {.keep_unseen = not_a_number}), cb::ParameterError);
  cb::UrbanDriver driver;
  driver.law.time_headway = -1.0;
  CHECK_THROWS_AS(cb::Tracker<>(support::own_map("highway.xodr"), {}, driver), cb::ParameterError);
}
