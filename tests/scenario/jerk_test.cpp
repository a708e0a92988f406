// How smoothly drivers drive where nothing unusual happens.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "../support/maps.hpp"
#include "cambium/cambium.hpp"
#include "cambium/scenario/junction_site.hpp"

using namespace cambium;

namespace {

template <class D>
using Sim = World<BehaviorSet<D, ConstantAcceleration>, InterpolateExecution, SingleTrack>;

/// The magnitudes of the jerk that drivers drive: second differences of the states' speeds [m/s^3].
class Jerks {
 public:
  template <class World>
  void note(World& world, double dt) {
    if (world.time() < 1.5 * dt) before_.clear();  // another world
    for (Slot i{}; index_of(i) < world.size(); ++i) {
      auto const& agent = world.frame().agents[i];
      if (agent.status != AgentStatus::driving || agent.memory.index() != 0) continue;
      auto const view = world.observe(world.roster().agents[i].id);
      if (view.corridor().length_until_end(view.place().s) < 30.0) continue;  // it leaves
      auto& last = before_[view.id()];
      double const speed = agent.state.speed, acceleration = (speed - last.speed) / dt;
      if (last.count > 1) all_.push_back(std::abs(acceleration - last.acceleration) / dt);
      last = {speed, acceleration, last.count + 1};
    }
  }
  void add(Jerks const& other) { all_.insert(all_.end(), other.all_.begin(), other.all_.end()); }
  [[nodiscard]] double largest() const { return all_.empty() ? 0.0 : *std::max_element(all_.begin(), all_.end()); }
  [[nodiscard]] double share_above(double jerk) const {
    auto const above = std::count_if(all_.begin(), all_.end(), [&](double j) { return j > jerk; });
    return static_cast<double>(above) / static_cast<double>(std::max<std::size_t>(1, all_.size()));
  }

 private:
  struct Before {
    double speed = 0.0, acceleration = 0.0;
    int count = 0;
  };
  std::map<AgentId, Before> before_;
  std::vector<double> all_;
};

/// A driver that desires `speed` [m/s].
template <class D>
D driver(double speed, double jerk) {
  D made;
  made.law.desired_speed = speed;
  made.jerk = jerk;
  return made;
}

template <class D>
typename Sim<D>::AgentSpec at(double x, double speed, D const& behavior, int lane = 1) {
  return {.position = {x, 1.75 - 3.5 * lane}, .speed = speed, .behavior = behavior};
}

template <class World>
void drive(World& world, double until, double dt, Jerks& jerks) {
  while (world.time() < until) {
    REQUIRE(world.step(dt));
    jerks.note(world, dt);
  }
  CHECK_FALSE(AnyCollision{}(world));
}

/// Follows one that brakes gently from 15 to 9 m/s and accelerates again.
template <class D>
void follow(double jerk, double dt, Jerks& jerks) {
  Sim<D> world(support::straight_road(1, 2000.0));
  auto const first = world.add({.position = {160, -1.75}, .speed = 15.0, .behavior = ConstantAcceleration{}});
  for (int i = 0; i < 4; ++i) world.add(at(130.0 - 30.0 * i, 15.0, driver<D>(20.0, jerk)));
  for (auto const& [acceleration, until] :
       {std::pair{0.0, 10.0}, {-1.5, 14.0}, {0.0, 25.0}, {1.2, 30.0}, {0.0, 40.0}}) {
    world.set_behavior(first, ConstantAcceleration{.acceleration = acceleration});
    drive(world, until, dt, jerks);
  }
}

/// Comes to the end of a queue; its first one starts, and all follow.
template <class D>
void queue(double jerk, double dt, Jerks& jerks) {
  Sim<D> world(support::straight_road(1, 1000.0));
  auto const first = world.add({.position = {300, -1.75}, .speed = 0.0, .behavior = ConstantAcceleration{}});
  for (int i = 0; i < 3; ++i) world.add(at(290.0 - 8.0 * i, 0.0, driver<D>(15.0, jerk)));
  world.add(at(60.0, 14.0, driver<D>(14.0, jerk)));
  drive(world, 30.0, dt, jerks);
  world.set_behavior(first, ConstantAcceleration{.acceleration = 1.2, .highest_speed = 12.0});
  drive(world, 50.0, dt, jerks);
}

/// One who is as fast cuts in, 1 s ahead.
template <class D>
void cut_in(double jerk, double dt, Jerks& jerks) {
  Sim<D> world(support::straight_road(1, 2000.0));
  auto const id = world.add(at(50.0, 20.0, driver<D>(20.0, jerk)));
  drive(world, 5.0, dt, jerks);
  double const length = geometry::car().length();
  world.add(
      {.position = {world.state(id).x + length + 20.0, -1.75}, .speed = 20.0, .behavior = ConstantAcceleration{}});
  drive(world, 30.0, dt, jerks);
}

/// Drivers of different speeds on three lanes.
template <class D>
void change_lanes(double jerk, double dt, Jerks& jerks) {
  Sim<D> world(support::straight_road(3, 2500.0));
  RandomStream random(7, 0, 0);
  for (int i = 0; i < 24; ++i) {
    auto one = driver<D>(17.0 + 12.0 * uniform01(random), jerk);
    if constexpr (requires { one.lateral.rule.keep_right; }) one.lateral.rule.keep_right = i % 2 == 1;
    world.add(at(50.0 + 40.0 * (i / 3) + 8.0 * uniform01(random), 18.0, one, 1 + i % 3));
  }
  drive(world, 50.0, dt, jerks);
}

/// Stops at a red light and goes at green; the second one comes when it turns yellow.
template <class D>
void light(double jerk, double dt, Jerks& jerks) {
  auto const map = support::road_with_signal("1000001");
  for (double const begin : {60.0, 100.0, 110.0, 120.0}) {
    Sim<D> world(map);
    world.set_light(map->lights().front().id, {.cycle = 60.0, .green_begin = 30.0, .green_end = 62.0, .yellow = 3.0});
    world.add(at(begin, 13.0, driver<D>(13.0, jerk)));
    world.add(at(begin - 40.0, 13.0, driver<D>(13.0, jerk)));
    drive(world, 45.0, dt, jerks);
  }
}

/// Stops at a stop sign, one after the other.
template <class D>
void stop_sign(double jerk, double dt, Jerks& jerks) {
  Sim<D> world(support::road_with_signal("206"));
  for (int i = 0; i < 3; ++i) world.add(at(100.0 - 30.0 * i, 13.0, driver<D>(13.0, jerk)));
  drive(world, 50.0, dt, jerks);
}

/// Crosses a junction, also turning, before which nobody else is.
template <class D>
void turn(double jerk, double dt, Jerks& jerks) {
  auto const site = find_junction_site(support::own_map("intersection_4way.xodr"));
  RandomStream random(3, 0, 0);
  for (auto const lane : site.entrances) {
    Sim<D> world(site.map);
    auto const route = site.random_route(lane, random);
    auto const pose = site.map->lane(lane).path.pose(10.0);
    auto spec = at(0.0, 10.0, driver<D>(13.0, jerk));
    spec.position = pose.position();
    spec.heading = pose.heading;
    spec.route = route;
    world.add(spec);
    drive(world, 25.0, dt, jerks);
  }
}

struct Situation {
  std::string name;
  void (*drive)(double jerk, double dt, Jerks& jerks);
};

template <class D>
std::vector<Situation> on_roads() {
  return {{"follow", follow<D>}, {"queue", queue<D>}, {"cut in", cut_in<D>}, {"change lanes", change_lanes<D>}};
}
template <class D>
std::vector<Situation> at_junctions() {
  auto all = on_roads<D>();
  for (auto const& one : {Situation{"light", light<D>}, {"stop sign", stop_sign<D>}, {"turn", turn<D>}})
    all.push_back(one);
  return all;
}

void check_smooth(std::vector<Situation> const& situations) {
  for (double const dt : {0.05, 0.1, 0.2}) {
    Jerks of_all;
    for (auto const& situation : situations) {
      Jerks jerks;
      situation.drive(2.5, dt, jerks);
      INFO(situation.name, ", dt ", dt, ": above 3 m/s^3 ", 100.0 * jerks.share_above(3.0), " %");
      CHECK(jerks.largest() <= 10.0);
      CHECK(jerks.share_above(3.0) < 0.03);
      of_all.add(jerks);
    }
    INFO("dt ", dt);
    CHECK(of_all.share_above(3.0) < 0.01);
  }
}

}  // namespace

TEST_CASE("drivers are smooth on roads") {
  check_smooth(on_roads<IdmClassic>());
  check_smooth(on_roads<AdaptiveCruiseControl>());
  check_smooth(on_roads<Mobil>());
}

TEST_CASE("drivers are smooth at junctions, lights and stop signs too") {
  check_smooth(at_junctions<Intersection>());
  check_smooth(at_junctions<UrbanDriver>());
  check_smooth(at_junctions<BasicUrbanDriver<Idm>>());
}

TEST_CASE("without the bound the same situations are not smooth") {
  int rough = 0;
  for (auto const& situation : at_junctions<UrbanDriver>()) {
    Jerks jerks;
    situation.drive(1e6, 0.1, jerks);
    rough += jerks.share_above(3.0) >= 0.01 || jerks.largest() > 10.0;
  }
  CHECK(rough >= 4);
}
