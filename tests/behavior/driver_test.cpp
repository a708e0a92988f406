// Drivers composed of a law, a lateral part and heeds drive as those that are written as a whole, to the last bit.
#include "cambium/behavior/drivers.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "cambium/behavior.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/world/world.hpp"

#include "../support/maps.hpp"

using namespace cambium;

namespace {

/// Vehicles anywhere on the lanes of the map, some of them close together, one in five long, and two cyclists beside.
template <class World, class Behavior>
void fill(World& world, Behavior const& behavior, std::uint64_t seed) {
  auto const& map = world.map();
  std::vector<LaneId> lanes;
  for (auto const& lane : map.lanes())
    if (lane.drivable() && lane.length() > 12.0) lanes.push_back(lane.id);
  RandomStream random(seed, 0, 0);
  auto const any = [&] { return lanes[uniform_index(random, static_cast<std::uint32_t>(lanes.size()))]; };
  auto cluster = any();
  for (int i = 0; i < 60 && world.size() < 24; ++i) {
    if (i % 4 == 0) cluster = any();
    auto const& lane = map.lane(cluster);
    auto pose = lane.path.pose(5.0 + uniform01(random) * (lane.length() - 10.0));
    typename World::AgentSpec spec{
        .position = pose.position(), .heading = pose.heading, .speed = 16.0 * uniform01(random), .behavior = behavior};
    if (i % 5 == 4) spec.shape = geometry::truck();
    if (i % 13 == 12) {
      spec.shape = geometry::bicycle();
      spec.speed *= 0.3;
      spec.position = geometry::to_map(pose, {0.0, -1.2});
    }
    world.add(spec);
  }
}

/// A queue in each lane that leads to the map; `behavior` makes one for each vehicle.
template <class World, class Make>
void fill_in_queues(World& world, Make const& behavior) {
  for (auto const& lane : world.map().lanes())
    for (double s = 10.0; lane.drivable() && lane.predecessors.empty() && s < lane.length() - 30.0; s += 25.0) {
      auto const pose = lane.path.pose(s);
      world.add({.position = pose.position(), .heading = pose.heading, .speed = 6.0, .behavior = behavior()});
    }
}

template <class Whole, class Composed>
void check_equal(Whole const& whole, Composed const& composed, std::initializer_list<double> steps = {0.1, 0.2, 0.5}) {
  using Sim = World<BehaviorSet<Whole, Composed>, InterpolateExecution, SingleTrack>;
  for (auto const* const name : {"merging.xodr", "roundabout.xodr", "intersection_4way.xodr", "highway_exit.xodr"})
    for (double const dt : steps) {
      CAPTURE(name);
      CAPTURE(dt);
      auto const map = support::own_map(name);
      Sim one(map, {.seed = 7}), other(map, {.seed = 7});
      bool const in_queues = dt == 0.2;
      if (in_queues) fill_in_queues(one, [&] { return whole; });
      if (in_queues) fill_in_queues(other, [&] { return composed; });
      if (!in_queues) fill(one, whole, 3);
      if (!in_queues) fill(other, composed, 3);
      for (int step = 0; step < (in_queues ? 200 : 60); ++step) {
        (void)one.step(dt);
        (void)other.step(dt);
        for (std::size_t i = 0; i < one.frame().agents.size(); ++i) {
          CAPTURE(step);
          CAPTURE(i);
          auto const &a = one.frame().agents[Slot{static_cast<std::uint32_t>(i)}],
                     &b = other.frame().agents[Slot{static_cast<std::uint32_t>(i)}];
          REQUIRE(a.status == b.status);
          REQUIRE(a.state == b.state);
          REQUIRE(a.action == b.action);
        }
      }
    }
}

/// Gipps 1981, "A behavioural car-following model for computer simulation", eq. 11, as a law of a user's own.
struct Gipps {
  double desired_speed = 15.0, time_headway = 1.0, minimum_gap = 2.0;
  double maximum_acceleration = 1.7, comfortable_deceleration = 3.0, lowest_acceleration = -8.0;

  static constexpr char const* name = "gipps";
  static constexpr auto parameters() {
    using P = Gipps;
    return parameter_list(parameter("desired_speed", &P::desired_speed, "m/s", Range{0.1, 100}, "speed on a free road"),
                          parameter("time_headway", &P::time_headway, "s", Range{0.1, 10}, "reaction time"));
  }
  [[nodiscard]] double acceleration(double v, double desired, Constraint const& leader) const {
    double const t = time_headway, b = comfortable_deceleration, u = v / desired;
    double const free = 2.5 * maximum_acceleration * (1.0 - u) * std::sqrt(0.025 + u);
    if (std::isinf(leader.gap)) return free;
    double const root = b * (2.0 * (leader.gap - minimum_gap) - v * t) + leader.speed * leader.speed + b * b * t * t;
    return std::min(free, (-b * t + std::sqrt(std::max(0.0, root)) - v) / t);
  }
};
static_assert(CarFollowing<Gipps>);
static_assert(BehaviorModel<UrbanDriver>);

}  // namespace

TEST_CASE("a composed driver that follows its lane by IDM is IdmClassic") {
  using Composed = Driver<Idm, KeepLane, Pedestrians>;
  check_equal(IdmClassic{}, Composed{});
  check_equal(
      IdmClassic{.desired_speed = 9.0, .rules = {.merging = Merging::gives_way, .keep_to_side = true}},
      Composed{.law = {.desired_speed = 9.0}, .lateral = {.merging = Merging::gives_way, .keep_to_side = true}});
}

TEST_CASE("a composed driver heeds the lane's end, limits, bends and signals as the rules of IdmClassic say") {
  using Composed = Driver<Idm, KeepLane, LaneEnd, SpeedLimit, Bends, Signals, Pedestrians>;
  check_equal(IdmClassic{.rules = {.lane_end = RoadRules::LaneEnd::before_destination,
                                   .obey_speed_limits = true,
                                   .slow_for_bends = true,
                                   .obey_signals = true}},
              Composed{});
}

TEST_CASE("a composed driver that changes lanes by MOBIL is Mobil") {
  using Composed = Driver<Idm, ChangeLanes<MobilRule<>>, Bends, Pedestrians>;
  check_equal(Mobil{}, Composed{}.with(Bends{.lateral_acceleration = 3.0}));
}

TEST_CASE(
    "composed drivers by the ACC model and the rule of free space are AdaptiveCruiseControl and LaneChangeRuleBased") {
  check_equal(AdaptiveCruiseControl{}, Driver<Acc, KeepLane, Pedestrians>{});
  using Composed = Driver<Idm, ChangeLanes<FreeSpaceRule>, Bends, Pedestrians>;
  check_equal(LaneChangeRuleBased{}, Composed{}.with(Bends{.lateral_acceleration = 3.0}));
}

TEST_CASE("a composed driver that zips is ZipMerge where all drive in the middle of their lanes") {
  // Beside it, ZipMerge returns to the middle, while KeepLane keeps its offset.
  check_equal(ZipMerge{}, Driver<Idm, KeepLane, Pedestrians, Zip>{}, {0.2});
}

TEST_CASE("a composed driver that steers to its line is IdmLaneTracking, in steps of one part") {
  using Composed = Driver<Idm, TrackLine, Bends, Pedestrians>;
  check_equal(IdmLaneTracking{}, Composed{}.with(Bends{.lateral_acceleration = 3.4}), {0.1, 0.2});
}

TEST_CASE("a composed driver that heeds conflicts is Intersection") {
  using Composed = Driver<Idm, KeepLane, SpeedLimit, Bends, Signals, Pedestrians, Conflicts>;
  check_equal(Intersection{}, Composed{});
  check_equal(Intersection{.idm = {.desired_speed = 9.0}}, Composed{.law = {.desired_speed = 9.0}});
}

TEST_CASE_TEMPLATE("drivers for town change lanes and give way, whatever their law", Law, Idm, Gipps) {
  using Urban = BasicUrbanDriver<Law>;
  using Sim = World<BehaviorSet<Urban>, InterpolateExecution, SingleTrack>;
  bool any_changes = false;
  for (auto const* const name : {"intersection_4way.xodr", "roundabout.xodr", "highway_exit.xodr"}) {
    CAPTURE(name);
    Sim world(support::own_map(name), {.seed = 7});
    RandomStream random(11, 0, 0);
    fill_in_queues(world, [&] { return Urban{.law = {.desired_speed = uniform01(random) < 0.3 ? 5.0 : 14.0}}; });
    bool changes = false;
    std::size_t left = 0;
    auto const agents = world.frame().agents.size();
    for (int step = 0; step < 600; ++step) {
      REQUIRE(world.step(0.2));
      left = 0;
      for (std::uint32_t i = 0; i < agents; ++i) {
        auto const& agent = world.frame().agents[Slot{i}];
        changes = changes || std::get<0>(agent.memory).lateral.change.active();
        left += agent.status == AgentStatus::driving ? 0 : 1;
        CHECK_FALSE((agent.status == AgentStatus::driving && Collision{}(world, Slot{i})));
      }
    }
    CAPTURE(agents);
    CHECK(left > agents / 2);  // the map
    any_changes = any_changes || changes;
  }
  CHECK(any_changes);
}
