#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include "cambium/core/distributions.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/course_end.hpp"
#include "cambium/scenario/lane_traffic.hpp"
#include "../support/allocations.hpp"
#include "fixtures.hpp"

using namespace fixtures;

namespace {

/// Drifts about at random: so that numbers drawn, lane changes and straddling take part in what is compared.
struct Wanderer {
  struct Memory {
    double drift = 0.0;
    friend bool operator==(Memory const&, Memory const&) = default;
  };

  template <class View>
  [[nodiscard]] cb::Plan<View> plan(View const& view, Memory& memory, double dt) const {
    auto random = view.random(1);
    memory.drift = 0.95 * memory.drift + 0.8 * (cb::uniform01(random) - 0.5);
    auto next = cb::follow_lane(view, {view.state().speed * dt, view.state().speed}, dt);
    next.y += memory.drift * dt;
    cb::Plan<View> plan;
    plan.trajectory.push_back(next);
    return plan;
  }
};

using Mixed = cb::World<cb::BehaviorSet<cb::IdmClassic, Wanderer, cb::ConstantAcceleration>, cb::InterpolateExecution,
                        cb::SingleTrack>;

/// Traffic on all lanes of maps/merging.xodr, entered in the order of `order`.
Mixed busy_world(std::shared_ptr<cb::Map const> const& map, std::uint64_t seed, bool reversed = false) {
  Mixed world(map, {.seed = seed});
  cb::RandomStream random(seed, 1, 0);
  std::vector<Mixed::AgentSpec> specs;
  for (auto const& lane : map->lanes()) {
    if (!lane.drivable() || !lane.predecessors.empty()) continue;
    cb::LaneTraffic traffic;
    traffic.end = std::min(200.0, lane.length() - 5);
    for (auto const& v : traffic.sample(random)) {
      auto const pose = lane.path.pose(v.s);
      Mixed::AgentSpec spec{.position = pose.position(), .speed = v.speed, .shape = v.shape, .behavior = v.driver};
      if (specs.size() % 3 == 0) spec.behavior = Wanderer{};
      spec.id = static_cast<cb::AgentId>(specs.size());
      specs.push_back(spec);
    }
  }
  if (reversed) std::reverse(specs.begin(), specs.end());
  for (auto const& spec : specs) world.add(spec);
  return world;
}

/// What happened in a run, so that its comparison says something.
struct Events {
  int reaching = 0;  ///< agents that reached over the border to a neighbouring lane, counted in each frame
  int corridor_changes = 0;

  void add(Mixed::FrameType const& before, Mixed const& world) {
    for (std::size_t i = 0; i < world.size(); ++i) {
      auto const& now = world.frame().agents[i].lane;
      corridor_changes += now.corridor != before.agents[i].lane.corridor;
      auto const& agent = world.roster().agents[i];
      auto const& corridor = agent.road->corridors[now.corridor];
      auto const& lane = world.map().lane(corridor.pieces[now.piece].lane);
      auto const room = corridor.widths_at(now.s, now.segment);
      reaching += std::abs(now.lateral) > 0.3 &&
                  ((cb::is_valid(lane.left_neighbor) && now.lateral + agent.shape.left > room.left) ||
                   (cb::is_valid(lane.right_neighbor) && agent.shape.right - now.lateral > room.right));
    }
  }
};

void check_something_happened(Events const& events) {
  MESSAGE(events.reaching << " times an agent reached over, " << events.corridor_changes << " corridor changes");
  CHECK(events.reaching > 100);
  CHECK(events.corridor_changes > 10);
}

}  // namespace

TEST_CASE("a copy goes the same way as its original, bit by bit, and neither disturbs the other") {
  auto const map = own_map("merging.xodr");
  Events events;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    auto world = busy_world(map, seed);
    REQUIRE(world.size() > 10);
    std::vector<Mixed::FrameType> frames;
    Mixed copy = world;
    for (int i = 0; i < 60; ++i) {
      REQUIRE(world.step(0.2));
      frames.push_back(world.frame());
      if (i == 20) copy = world;
    }
    for (std::size_t i = 21; i < frames.size(); ++i) {
      REQUIRE(copy.step(0.2));
      CHECK(copy.frame() == frames[i]);
      events.add(frames[i - 1], copy);
    }
    CHECK(world.frame() == frames.back());
  }
  check_something_happened(events);
}

TEST_CASE("the order in which agents enter does not matter") {
  auto const map = own_map("merging.xodr");
  Events events;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    auto forward = busy_world(map, seed), backward = busy_world(map, seed, true);
    for (int i = 0; i < 60; ++i) {
      auto const before = forward.frame();
      REQUIRE(forward.step(0.2));
      REQUIRE(backward.step(0.2));
      events.add(before, forward);
    }
    CHECK(forward.frame() == backward.frame());
  }
  check_something_happened(events);
}

TEST_CASE("worlds stepped on many threads end like those stepped on one") {
  auto const map = own_map("merging.xodr");
  constexpr std::size_t count = 16;
  auto const start = busy_world(map, 5);
  auto const run = [&](std::size_t i, Events* events = nullptr) {
    Mixed world = start;
    world.memory<Wanderer>(static_cast<cb::AgentId>(0)).drift = 0.05 * static_cast<double>(i);
    auto before = world.frame();
    for (int k = 0; k < 60; ++k) {
      REQUIRE(world.step(0.2));
      if (events == nullptr) continue;
      events->add(before, world);
      before = world.frame();
    }
    return world.frame();
  };
  std::vector<Mixed::FrameType> alone(count), together(count);
  Events events;
  for (std::size_t i = 0; i < count; ++i) alone[i] = run(i, &events);
  check_something_happened(events);
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (auto i = next++; i < count; i = next++) together[i] = run(i);
    });
  for (auto& thread : threads) thread.join();
  CHECK(alone == together);
  CHECK(alone[0] != alone[1]);
}

TEST_CASE("another seed gives another course") {
  auto const map = own_map("merging.xodr");
  auto a = busy_world(map, 5);
  auto other = std::make_shared<Mixed::RosterType>(a.roster());
  other->seed = 6;
  Mixed b(map, other, a.frame());
  for (int k = 0; k < 20; ++k) {
    REQUIRE(a.step(0.2));
    REQUIRE(b.step(0.2));
  }
  CHECK(a.frame() != b.frame());
}

TEST_CASE("a warm world steps, copies and is judged without allocating") {
  auto const map = own_map("merging.xodr");
  auto const at_first = support::allocations();
  auto start = busy_world(map, 3);
  Mixed world = start;
  if (CAMBIUM_COUNTS_ALLOCATIONS) CHECK(support::allocations() > at_first + start.size());  // they are counted
  auto const run = [&] {
    world = start;
    for (int k = 0; k < 100; ++k) {
      REQUIRE(world.step(0.2));
      (void)cb::AnyCollision{}(world);
      (void)course_end(world, cb::Slot{});
    }
  };
  run();
  auto const before = support::allocations();
  run();
  CHECK(support::allocations() == before);
}

TEST_CASE("frames of prediction worlds are copied as memory") {
  static_assert(std::is_trivially_copyable_v<Sim::Record>);
  static_assert(sizeof(Sim::Record) <= 128);
  using Lean =
      cb::World<cb::BehaviorSet<cb::IdmClassic, cb::ConstantAcceleration>, cb::InterpolateExecution, cb::SingleTrack>;
  static_assert(std::is_trivially_copyable_v<Lean::Record>);
  static_assert(sizeof(Lean::Record) <= 128);
  MESSAGE("an agent's record takes " << sizeof(Sim::Record) << " bytes, " << sizeof(Lean::Record)
                                     << " where no behaviour remembers anything");
}
