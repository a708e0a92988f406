// How smoothly drivers drive where nothing unusual happens.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "../support/maps.hpp"
#include "../support/scale.hpp"
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

/// Who drives.
struct Who {
  double jerk = 2.5;                   ///< the bound of drivers with default parameters [m/s^3]
  Population const* people = nullptr;  ///< from whom drivers are drawn instead, each with its own bound
  geometry::Shape shape = geometry::car();
  RandomStream random{5, 0, 0};

  /// A driver that desires `speed` [m/s].
  template <class D>
  [[nodiscard]] D driver(double speed) {
    D made;
    made.jerk = jerk;
    if constexpr (requires(presets::Temperament one) { one.of(made); })
      if (people != nullptr) made = people->draw(random).of(made);
    made.law.desired_speed = speed;
    return made;
  }

  /// Such a driver on a road, with its front end where that of a car at `x` is.
  template <class D>
  [[nodiscard]] typename Sim<D>::AgentSpec at(double x, double speed, double desired, int lane = 1) {
    return {.position = {x + geometry::car().front - shape.front, 1.75 - 3.5 * lane},
            .speed = speed,
            .shape = shape,
            .behavior = driver<D>(desired)};
  }
};

template <class World>
void drive(World& world, double until, double dt, Jerks& jerks) {
  while (world.time() < until) {
    REQUIRE(world.step(dt));
    jerks.note(world, dt);
    REQUIRE_FALSE(AnyCollision{}(world));
  }
}

/// Follows one that brakes gently from 15 to 9 m/s and accelerates again.
template <class D>
void follow(Who who, double dt, Jerks& jerks) {
  Sim<D> world(support::straight_road(1, 2000.0));
  auto const first = world.add({.position = {160, -1.75}, .speed = 15.0, .behavior = ConstantAcceleration{}});
  for (int i = 0; i < 4; ++i) world.add(who.at<D>(130.0 - 30.0 * i, 15.0, 20.0));
  for (auto const& [acceleration, until] :
       {std::pair{0.0, 10.0}, {-1.5, 14.0}, {0.0, 25.0}, {1.2, 30.0}, {0.0, 40.0}}) {
    world.set_behavior(first, ConstantAcceleration{.acceleration = acceleration});
    drive(world, until, dt, jerks);
  }
}

/// Comes to the end of a queue; its first one starts, and all follow.
template <class D>
void queue(Who who, double dt, Jerks& jerks) {
  Sim<D> world(support::straight_road(1, 1000.0));
  auto const first = world.add({.position = {300, -1.75}, .speed = 0.0, .behavior = ConstantAcceleration{}});
  for (int i = 0; i < 3; ++i) world.add(who.at<D>(292.0 - (who.shape.length() + 3.5) * i, 0.0, 15.0));
  world.add(who.at<D>(60.0, 14.0, 14.0));
  drive(world, 30.0, dt, jerks);
  world.set_behavior(first, ConstantAcceleration{.acceleration = 1.2, .highest_speed = 12.0});
  drive(world, 50.0, dt, jerks);
}

/// One cuts in who is as fast, 1 s ahead; then one who is faster, 15 m ahead.
template <class D>
void cut_in(Who who, double dt, Jerks& jerks) {
  for (auto const& [ahead, speed] : {std::pair{20.0, 20.0}, {15.0, 23.0}}) {
    Sim<D> world(support::straight_road(1, 2000.0));
    auto const id = world.add(who.at<D>(50.0, 20.0, 20.0));
    drive(world, 5.0, dt, jerks);
    world.add({.position = {world.state(id).x + who.shape.front + geometry::car().rear + ahead, -1.75},
               .speed = speed,
               .behavior = ConstantAcceleration{}});
    drive(world, 30.0, dt, jerks);
  }
}

/// Keeps right beside slower ones whom it must not pass, its own leader far ahead.
template <class D>
void keep_right(Who who, double dt, Jerks& jerks) {
  if constexpr (requires(D one) { one.lateral.rule.keep_right; }) {
    Sim<D> world(support::straight_road(2, 3000.0));
    auto one = who.at<D>(50.0, 20.0, 28.0, 2);
    std::get<D>(one.behavior).lateral.rule.keep_right = true;
    world.add(one);
    world.add({.position = {230.0, -5.25}, .speed = 20.0, .behavior = ConstantAcceleration{}});
    for (double const x : {90.0, 130.0, 170.0})
      world.add({.position = {x, -1.75}, .speed = 19.0, .behavior = ConstantAcceleration{}});
    drive(world, 40.0, dt, jerks);
  }
}

/// Drivers of different speeds on three lanes.
template <class D>
void change_lanes(Who who, double dt, Jerks& jerks) {
  Sim<D> world(support::straight_road(3, 2500.0));
  RandomStream random(7, 0, 0);
  for (int i = 0; i < 24; ++i) {
    double const desired = 17.0 + 12.0 * uniform01(random), x = 50.0 + 40.0 * (i / 3) + 8.0 * uniform01(random);
    auto one = who.at<D>(x, 18.0, desired, 1 + i % 3);
    if constexpr (requires(D one) { one.lateral.rule.keep_right; })
      std::get<D>(one.behavior).lateral.rule.keep_right = i % 2 == 1;
    world.add(one);
  }
  drive(world, 50.0, dt, jerks);
}

/// Stops at a red light and goes at green; the second one comes when it turns yellow.
template <class D>
void light(Who who, double dt, Jerks& jerks) {
  auto const map = support::road_with_signal("1000001");
  for (double const begin : {60.0, 100.0, 110.0, 120.0}) {
    Sim<D> world(map);
    world.set_light(map->lights().front().id, {.cycle = 60.0, .green_begin = 30.0, .green_end = 62.0, .yellow = 3.0});
    world.add(who.at<D>(begin, 13.0, 13.0));
    world.add(who.at<D>(begin - 40.0, 13.0, 13.0));
    drive(world, 45.0, dt, jerks);
  }
}

/// Stops at a stop sign, one after the other.
template <class D>
void stop_sign(Who who, double dt, Jerks& jerks) {
  Sim<D> world(support::road_with_signal("206"));
  for (int i = 0; i < 3; ++i) world.add(who.at<D>(100.0 - 30.0 * i, 13.0, 13.0));
  drive(world, 50.0, dt, jerks);
}

/// Crosses a junction, also turning, before which nobody else is.
template <class D>
void turn(Who who, double dt, Jerks& jerks) {
  auto const site = find_junction_site(support::own_map("intersection_4way.xodr"));
  int driven = 0;
  RandomStream random(3, 0, 0);
  for (auto const lane : site.entrances) {
    Sim<D> world(site.map);
    auto const route = site.random_route(lane, random);
    if (!fits_route(*site.map, route, who.shape)) continue;
    ++driven;
    auto const pose = site.map->lane(lane).path.pose(10.0);
    auto spec = who.at<D>(0.0, 10.0, 13.0);
    spec.position = pose.position();
    spec.heading = pose.heading;
    spec.route = route;
    world.add(spec);
    drive(world, 25.0, dt, jerks);
  }
  REQUIRE(driven > 0);
}

/// `vehicles` come to a junction of equal right at once, each from another side.
template <class D, std::size_t vehicles>
void meet(Who who, double dt, Jerks& jerks) {
  auto const site = find_junction_site(support::own_map("intersection_4way.xodr"));
  Sim<D> world(site.map);
  std::set<RoadId> taken;
  for (int draws = 0; taken.size() < vehicles; ++draws) {
    REQUIRE(draws < 1000);
    auto const lane = site.entrances[uniform_index(who.random, static_cast<std::uint32_t>(site.entrances.size()))];
    auto const route = site.random_route(lane, who.random);
    if (taken.contains(site.map->lane(lane).road) || !fits_route(*site.map, route, who.shape)) continue;
    taken.insert(site.map->lane(lane).road);
    auto const pose = site.map->lane(lane).path.pose(10.0 + 10.0 * uniform01(who.random));
    auto spec = who.at<D>(0.0, 8.0 + 3.0 * uniform01(who.random), 13.0);
    spec.position = pose.position();
    spec.heading = pose.heading;
    spec.route = route;
    world.add(spec);
  }
  drive(world, 25.0, dt, jerks);
}

struct Situation {
  std::string name;
  void (*drive)(Who who, double dt, Jerks& jerks);
};

template <class D>
std::vector<Situation> on_roads() {
  return {{"follow", follow<D>},
          {"queue", queue<D>},
          {"cut in", cut_in<D>},
          {"change lanes", change_lanes<D>},
          {"keep right", keep_right<D>}};
}
template <class D>
std::vector<Situation> at_junctions() {
  auto all = on_roads<D>();
  for (auto const& one :
       {Situation{"light", light<D>}, {"stop sign", stop_sign<D>}, {"turn", turn<D>}, {"meet", meet<D, 2>}})
    all.push_back(one);
  return all;
}

void check_smooth(std::vector<Situation> const& situations, Who const& who = {}) {
  for (double const dt : {0.05, 0.1, 0.2}) {
    Jerks of_all;
    for (auto const& situation : situations) {
      Jerks jerks;
      situation.drive(who, dt, jerks);
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
  check_smooth(on_roads<LaneChangeRuleBased>());
  check_smooth(on_roads<ZipMerge>());
  check_smooth(on_roads<IdmLaneTracking>());
}

TEST_CASE("drivers are smooth at junctions, lights and stop signs too") {
  check_smooth(at_junctions<Intersection>());
  check_smooth(at_junctions<UrbanDriver>());
  check_smooth(at_junctions<BasicUrbanDriver<Idm>>());
}

TEST_CASE("so are people in cars and trucks") {
  auto const cars = presets::town_cars(), trucks = presets::town_trucks();
  auto const fast_cars = presets::motorway_cars(), fast_trucks = presets::motorway_trucks();
  for (std::uint64_t seed = 1; seed <= support::runs(20); ++seed) {
    CAPTURE(seed);
    check_smooth(at_junctions<UrbanDriver>(), {.people = &cars, .random = RandomStream(seed, 0, 0)});
    check_smooth(at_junctions<UrbanDriver>(),
                 {.people = &trucks, .shape = geometry::truck(), .random = RandomStream(seed, 1, 0)});
    check_smooth(on_roads<UrbanDriver>(), {.people = &fast_cars, .random = RandomStream(seed, 2, 0)});
    check_smooth(on_roads<UrbanDriver>(),
                 {.people = &fast_trucks, .shape = geometry::truck(), .random = RandomStream(seed, 3, 0)});
  }
}

TEST_CASE("of people who come from all four sides at once, hardly anyone jerks") {
  auto const cars = presets::town_cars(), trucks = presets::town_trucks();
  Jerks all;
  for (std::uint64_t seed = 1; seed <= support::runs(50); ++seed)
    for (double const dt : {0.05, 0.1, 0.2}) {
      meet<UrbanDriver, 4>({.people = &cars, .random = RandomStream(seed, 0, 0)}, dt, all);
      meet<UrbanDriver, 4>({.people = &trucks, .shape = geometry::truck(), .random = RandomStream(seed, 1, 0)}, dt,
                           all);
    }
  INFO("above 3 m/s^3 ", 100.0 * all.share_above(3.0), " %, above 10 ", 100.0 * all.share_above(10.0), " %");
  CHECK(all.share_above(3.0) < 0.01);
  CHECK(all.share_above(10.0) < 2e-4);
}

TEST_CASE("without the bound the same situations are not smooth") {
  int rough = 0;
  for (auto const& situation : at_junctions<UrbanDriver>()) {
    Jerks jerks;
    situation.drive({.jerk = 1e6}, 0.1, jerks);
    rough += jerks.share_above(3.0) >= 0.01 || jerks.largest() > 10.0;
  }
  CHECK(rough >= 4);
}
