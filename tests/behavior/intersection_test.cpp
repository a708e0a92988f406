#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../support/allocations.hpp"
#include "cambium/map/building/build_map.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/map/opendrive/document.hpp"
#include "lane_traffic_fixtures.hpp"

using namespace cambium;
using lane_traffic::enter;

namespace {

using Set = BehaviorSet<Intersection, IdmClassic, ConstantAcceleration>;
using Sim = World<Set, InterpolateExecution, SingleTrack>;

/// The four-way crossing. Arms 1 (east), 2 (north), 3 (west), 4 (south) lead in against their road's direction; the
/// ways through are roads 100 + 10 arm, plus 0 straight on, 1 right, 2 left.
struct Crossing {
  std::shared_ptr<Map const> map = support::own_map("intersection_4way.xodr");

  [[nodiscard]] map::Route route(int arm, int turn) const {
    auto const way = std::to_string(100 + 10 * arm + turn);
    auto const in = map->find_lane(std::to_string(arm), 50.0, turn == 2 ? -1 : -2);
    map::Route route{{in}, map->lane(in).length()};
    for (int i = 0; i < 8; ++i) {
      auto const& ahead = map->lane(route.lanes.back()).successors;
      auto const next = std::find_if(ahead.begin(), ahead.end(), [&](LaneId lane) {
        auto const& name = map->road(map->lane(lane).road).name;
        return i > 0 || name == way;
      });
      if (next == ahead.end()) break;
      route.lanes.push_back(*next);
      route.length += map->lane(*next).length();
    }
    REQUIRE(route.lanes.size() > 2);
    return route;
  }
};

bool is_in_junction(Map const& map, LaneId lane) { return is_valid(map.road(map.lane(lane).road).junction); }

/// Adds a car `distance` [m] before the first junction of the route.
AgentId add_before(Sim& world, map::Route const& route, double distance, double speed,
                   std::optional<AgentId> id = std::nullopt) {
  auto const& map = world.map();
  std::size_t last = 0;
  while (!is_in_junction(map, route.lanes[last + 1])) ++last;
  double s = map.lane(route.lanes[last]).length() - distance;
  while (s < 0.0 && last > 0) s += map.lane(route.lanes[--last]).length();
  return enter(world, map.lane(route.lanes[last]), s,
               {.speed = speed, .behavior = Intersection{.law = {.desired_speed = 10.0}}, .route = route, .id = id});
}

/// Time [s] at which each agent of `ids` leaves the junction's lanes; none if it never does. Requires that nobody
/// collides.
std::vector<std::optional<double>> times_through(Sim& world, std::vector<AgentId> const& ids, double seconds = 90.0) {
  std::vector<std::optional<double>> times(ids.size());
  AnyCollision const collision;
  while (world.time() < seconds) {
    REQUIRE(world.step(0.2));
    REQUIRE(!collision(world));
    for (std::size_t i = 0; i < ids.size(); ++i) {
      auto const lane = world.lane_of(ids[i]);
      auto const& road = world.roster().agents[world.slot_of(ids[i])].road->route;
      bool const through = std::find(road.begin() + 2, road.end(), lane) != road.end();
      if (through && !times[i]) times[i] = world.time();
    }
  }
  return times;
}

/// The crossing with a signal of `type` at the end of each named arm.
std::shared_ptr<Map const> crossing_with(std::vector<std::pair<std::string, std::string>> const& signals) {
  std::vector<Diagnostic> diagnostics;
  auto document = cambium::map::load_opendrive_document(CAMBIUM_SOURCE_DIR "/maps/intersection_4way.xodr", diagnostics);
  for (auto& road : document.roads) {
    road.signals.clear();
    for (auto const& [arm, type] : signals)
      if (road.id == arm) {
        map::opendrive::Signal signal;
        signal.id = "s" + arm + type;
        signal.s = 95.0;
        signal.orientation = map::opendrive::Orientation::along;
        signal.type = type;
        road.signals.push_back(signal);
      }
  }
  return cambium::map::build_map(document, {}, "text", diagnostics);
}

}  // namespace

TEST_CASE("braking for a line stops before it, for any step and speed, and not too early") {
  RandomStream random(3, 0, 0);
  for (int run = 0; run < 500; ++run) {
    double const dt = 0.05 + 0.45 * uniform01(random), braking = 1.0 + 3.0 * uniform01(random);
    double speed = 20.0 * uniform01(random), left = 1.0 + 80.0 * uniform01(random);
    if (speed * speed > 2.0 * 8.0 * left) continue;
    double hardest = std::max(braking, speed * speed / (2.0 * left));
    for (int k = 0; k < 2000 && left > 0.05; ++k) {
      auto const motion = motion_before_stop(speed, left, braking, 8.0, dt);
      double const end = std::min(motion.speed, speed + 2.0 * dt);  // it gains at most 2 m/s^2
      double const way = std::min(motion.distance, (speed + end) / 2.0 * dt);
      CHECK((speed - end) / dt < hardest + 1e-6);
      left -= way;
      speed = end;
      REQUIRE(left > -1e-9);
    }
    CHECK(left < 0.06);
  }
}

TEST_CASE("without signs, only lights that are on for both ways keep drivers from going in the order of arrival") {
  struct Lights {
    [[nodiscard]] map::LightColor light(LightId id) const {
      return id == LightId{0} ? map::LightColor::green : map::LightColor::off;
    }
  };
  map::Conflict conflict;
  conflict.right_of_way = map::RightOfWay::first;
  LightId const on{0}, off{1}, without = none<LightId>;
  for (auto const light : {on, off, without})
    for (auto const other : {on, off, without}) {
      conflict.light = light;
      conflict.other_light = other;
      CHECK(detail::is_by_arrival(Lights{}, conflict) == (light != on && other != on));
    }
}

TEST_CASE("of two drivers about to enter in the same step, one enters first: the nearer, the smaller id") {
  auto const enters_first = [&](double way, double other_way, bool is_smaller, double speed = 1.0) {
    RoadUser const user{.speed = speed};
    detail::ConflictUser const other{user, 10.0 - other_way, {}, false, 10.0};
    detail::ConflictAsker own;
    own.s = 10.0 - way;
    own.place = 10.0;
    own.dt = 0.2;
    return detail::enters_first(other, own, is_smaller);
  };
  for (bool const is_smaller : {true, false}) {  // they still stop within 0.17 m, but maybe no longer after the step
    CHECK(enters_first(0.3, 0.2, is_smaller));
    CHECK_FALSE(enters_first(0.2, 0.3, is_smaller));
    CHECK(enters_first(0.2, 0.2, is_smaller) == !is_smaller);
    CHECK_FALSE(enters_first(3.0, 2.0, is_smaller));       // it can stop after the step, too
    CHECK_FALSE(enters_first(0.3, 0.2, is_smaller, 0.0));  // it stands
  }
}

TEST_CASE("a driver remembers who came before it, rather those who have entered") {
  detail::AgentsBefore list;
  auto const key = [](std::uint32_t id) { return detail::section_key(AgentId{id}, 3, 1); };
  for (std::uint32_t id = 0; id < 9; ++id) list.add(key(id), false, id == 2);
  CHECK(list.arrival_of(key(1)) == detail::Arrival::earlier);
  CHECK(list.arrival_of(key(2)) == detail::Arrival::together);
  CHECK(list.arrival_of(key(8)) == detail::Arrival::earlier);  // full: it may be
  CHECK_FALSE(list.holds(key(8)));
  for (std::uint32_t id = 10; id < 17; ++id) {
    CHECK_FALSE(list.is_full_of_entered());
    list.add(key(id), true, id == 11);
    CHECK(list.holds_entered(key(id)));
    CHECK(list.holds_together(key(id)) == (id == 11));
  }
  CHECK(list.is_full_of_entered());
  CHECK_FALSE(list.holds(key(1)));
  list.add(key(20), true, false);
  CHECK_FALSE(list.holds(key(20)));
  CHECK_FALSE(list.holds(detail::section_key(AgentId{10}, 2, 1)));  // another section of the same vehicle
  CHECK(detail::AgentsBefore{}.arrival_of(key(1)) == detail::Arrival::later);
}

TEST_CASE("the vehicle from the right goes first, whatever the ids and the distances") {
  Crossing const crossing;
  for (bool const right_first_added : {true, false})
    for (double const ahead : {0.0, -6.0, -12.0}) {
      Sim world(crossing.map);
      auto const east = crossing.route(1, 0), north = crossing.route(2, 0);  // north is on the right of east
      auto const first =
          add_before(world, right_first_added ? north : east, right_first_added ? 40.0 : 40.0 + ahead, 8);
      auto const second =
          add_before(world, right_first_added ? east : north, right_first_added ? 40.0 + ahead : 40.0, 8);
      auto const times = times_through(world, {first, second}, 40.0);
      REQUIRE(times[0]);
      REQUIRE(times[1]);
      CHECK((*times[0] < *times[1]) == right_first_added);
    }
}

TEST_CASE("four cars that arrive at a crossing together all get through") {
  Crossing const crossing;
  for (std::uint32_t const apart : {1u, 16u, 89u, 1000u})  // ids decide who loses patience first
    for (int const turn : {0, 2})
      for (double const nearer : {0.0, 3.0}) {
        Sim world(crossing.map);
        std::vector<AgentId> ids;
        for (int arm = 1; arm <= 4; ++arm)
          ids.push_back(add_before(world, crossing.route(arm, turn), 30.0 - nearer * arm, 6.0,
                                   AgentId{static_cast<std::uint32_t>(arm) * apart}));
        CAPTURE(apart);
        for (auto const& time : times_through(world, ids)) CHECK(time);
      }
}

TEST_CASE("a driver who insists does not let one through who has to let it go first, unless that one stands") {
  Crossing const crossing;
  auto const slowest = [&](bool insists, bool other_stands) {
    Sim world(crossing.map);
    auto const other = add_before(world, crossing.route(1, 2), -8.0, 5.0);  // turns left before oncoming traffic
    world.set_behavior(other, ConstantAcceleration{});
    while (other_stands && world.state(other).y > -3.5) REQUIRE(world.step(0.1));
    auto state = world.state(other);
    if (other_stands) state.speed = 0.0;
    world.set_state(other, state);
    auto const own = add_before(world, crossing.route(3, 0), 8.0, 10.0);
    Intersection driver{.law = {.desired_speed = 10.0}};
    driver.heed<Conflicts>().insists = insists;
    world.set_behavior(own, driver);
    double least = 10.0;
    for (int i = 0; i < 12; ++i) {
      REQUIRE(world.step(0.1));
      least = std::min(least, world.state(own).speed);
    }
    return least;
  };
  CHECK(slowest(false, false) < 8.0);
  CHECK(slowest(true, false) > 9.5);
  CHECK(slowest(true, true) < 8.0);
}

TEST_CASE("a junction's priorities override right before left") {
  auto const map = support::own_map("intersection_3way.xodr");
  Sim world(map);
  auto const route = [&](char const* road, char const* way) {
    map::Route found;
    for (auto const& lane : map->lanes())
      if (lane.drivable() && lane.predecessors.empty() && map->road(lane.road).name == road)
        for (auto const& option : map->routes(lane.id, map->find_lane(way, 5.0, -1), {.max_routes = 1})) found = option;
    REQUIRE(!found.lanes.empty());
    auto const& ahead = map->lane(found.lanes.back()).successors;
    if (!ahead.empty()) found.lanes.push_back(ahead.front());
    return found;
  };
  // A vehicle that turns left from the side road waits for both directions of the main road.
  auto const side = route("3", "31"), main = route("2", "20");
  auto const left = add_before(world, side, 20.0, 6.0);
  auto const straight = add_before(world, main, 30.0, 10.0);
  auto const view = world.observe(left);
  bool waits = false;
  for (auto const& conflict : view.corridor().conflicts)
    waits = waits || conflict.right_of_way == map::RightOfWay::yields;
  CHECK(waits);
  double left_in = 0.0, straight_in = 0.0;
  AnyCollision const collision;
  for (int k = 0; k < 200; ++k) {
    REQUIRE(world.step(0.2));
    REQUIRE(!collision(world));
    if (left_in == 0.0 && is_in_junction(*map, world.lane_of(left))) left_in = world.time();
    if (straight_in == 0.0 && is_in_junction(*map, world.lane_of(straight))) straight_in = world.time();
  }
  CHECK(straight_in > 0.0);
  CHECK(left_in > straight_in);
}

TEST_CASE("signs override right before left, and a driver stops at a stop sign before it goes on") {
  // East is on the left of north, but these signs let it go first.
  for (char const* type : {"205", "206"}) {
    CAPTURE(type);
    Crossing crossing{crossing_with({{"1", "306"}, {"2", type}, {"3", "306"}, {"4", type}})};
    Sim world(crossing.map);
    auto const east = add_before(world, crossing.route(1, 0), 40.0, 8.0);
    auto const north = add_before(world, crossing.route(2, 0), 40.0, 8.0);
    auto const times = times_through(world, {east, north}, 40.0);
    REQUIRE(times[0]);
    REQUIRE(times[1]);
    CHECK(*times[0] < *times[1]);

    Sim empty(crossing.map);
    auto const alone = add_before(empty, crossing.route(2, 0), 40.0, 8.0);
    double slowest = 8.0;
    for (int k = 0; k < 100 && empty.status(alone) == AgentStatus::driving; ++k) {
      REQUIRE(empty.step(0.2));
      slowest = std::min(slowest, empty.state(alone).speed);
    }
    CHECK((slowest < 0.1) == (std::string(type) == "206"));
    CHECK(empty.state(alone).y < -30.0);  // it has passed the junction
  }
}

TEST_CASE("drivers stop at red and go at green; without a plan for the light the signs decide") {
  Crossing crossing{crossing_with({{"1", "1000001"}, {"2", "1000001"}})};
  REQUIRE(crossing.map->lights().size() == 2);
  auto const east_light = crossing.map->find_light("signal s11000001"),
             north_light = crossing.map->find_light("signal s21000001");
  auto const run = [&](bool has_plan) {
    Sim world(crossing.map);
    if (has_plan) {  // green for the east at once, for the north after 20 s
      world.set_light(east_light, {.cycle = 40.0, .green_begin = 0.0, .green_end = 15.0});
      world.set_light(north_light, {.cycle = 40.0, .green_begin = 20.0, .green_end = 35.0});
    }
    auto const east = add_before(world, crossing.route(1, 0), 40.0, 8.0);
    auto const north = add_before(world, crossing.route(2, 0), 40.0, 8.0);
    auto const future = world.observe(east).predict(predict_all_as<Set>(Intersection{}));
    CHECK(future.roster().lights == world.roster().lights);
    return times_through(world, {east, north}, 60.0);
  };
  auto const off = run(false), on = run(true);
  CHECK(*off[1] < *off[0]);  // right before left
  CHECK(*on[0] < *off[0]);   // the east does not slow down
  CHECK(*on[1] > 20.0);
}

TEST_CASE(
    "a driver that turns left at green waits for oncoming traffic within the junction, as far as it blocks nobody") {
  constexpr double margin = 1.0;  // [m] before the place to wait
  Crossing const crossing;
  for (int arm = 1; arm <= 4; ++arm) {
    CAPTURE(arm);
    Sim world(crossing.map);
    auto const turner = add_before(world, crossing.route(arm, 2), 25.0, 8.0);
    for (int i = 0; i < 6; ++i) add_before(world, crossing.route((arm + 1) % 4 + 1, 0), 20.0 + 13.0 * i, 5.0);
    auto const& corridor = world.observe(turner).corridor();
    auto const own_light = corridor.signals.front().light;
    REQUIRE(is_valid(own_light));
    for (auto const& light : crossing.map->lights()) {
      bool const is_green = light.id == own_light;
      world.set_light(light.id,
                      {.cycle = 60.0, .green_begin = is_green ? 0.0 : 57.0, .green_end = is_green ? 55.0 : 58.0});
    }
    // The zones of those who go before it: ways of oncoming traffic across its own.
    std::vector<map::ConflictZone> zones;
    for (auto const& c : corridor.conflicts)
      if (c.right_of_way == map::RightOfWay::yields && !c.zones[0][0].empty() && c.light == own_light &&
          c.other_light == own_light)
        zones.push_back(c.zones[0][0]);
    REQUIRE(!zones.empty());
    // Tried out in steps of 1 mm: the farthest place outside of them, before each.
    double farthest = 1e9;
    for (auto const& zone : zones) {
      double place = zone.begin;
      while (std::ranges::any_of(zones, [&](auto const& z) { return z.begin < place && place <= z.end; }))
        place -= 1e-3;
      farthest = std::min(farthest, place);
    }
    double waits_at = 0.0;
    while (world.time() < 60.0) {
      REQUIRE(world.step(0.1));
      REQUIRE_FALSE(AnyCollision{}(world));
      if (world.status(turner) != AgentStatus::driving) break;
      if (world.state(turner).speed < 0.05) waits_at = world.record(turner).lane.s;
    }
    CHECK(waits_at + geometry::car().front > zones.front().line + 1.0);
    CHECK(waits_at == doctest::Approx(farthest - margin).epsilon(1e-3));
  }
}

TEST_CASE("a late runner passes in the first second of red, a driver that obeys does not, and cross traffic minds") {
  Crossing crossing;
  auto const& lights = crossing.map->lights();
  REQUIRE(!lights.empty());
  // The arm's light is yellow from 1 s and red from 4 s on; the others turn green when it turns red.
  auto const route = crossing.route(1, 0);
  int runners = 0;
  for (double const late : {0.0, 1.0})
    for (double distance = 30.0; distance <= 80.0; distance += 2.5) {
      CAPTURE(late);
      CAPTURE(distance);
      Sim world(crossing.map);
      auto const id = add_before(world, route, distance, 13.5);
      Intersection driver{.law = {.desired_speed = 13.9}};
      driver.heed<Signals>().late_at_red = late;
      driver.heed<SpeedLimit>().factor = 3.0;
      world.set_behavior(id, driver);
      auto const& signals = world.observe(id).corridor().signals;
      auto const signal = *std::ranges::find(signals, map::SignalKind::light, &map::CorridorSignal::kind);
      for (auto const& light : lights) {
        bool const is_own = light.id == signal.light;
        world.set_light(light.id, {.cycle = 60.0, .green_begin = is_own ? 0.0 : 4.0, .green_end = is_own ? 1.0 : 30.0});
      }
      auto const north = add_before(world, crossing.route(2, 0), 45.0, 8.0);
      CHECK(world.observe(id).red_for(signal.light) == doctest::Approx(-4.0));
      double passed = 1e9;
      while (world.time() < 25.0) {
        REQUIRE(world.step(0.1));
        CHECK_FALSE(AnyCollision{}.pair(world));
        auto const& place = world.record(id).lane;
        if (passed > 1e8 && place.s + world.roster().agents[0].shape.front > signal.line) passed = world.time();
      }
      CHECK(std::isfinite(world.state(north).x));
      CHECK((passed < 4.05 + late || passed > 60.0));  // in time, or not in this cycle
      runners += passed > 4.05 && passed < 1e8;
      if (late == 0.0) CHECK(runners == 0);
    }
  CHECK(runners >= 3);  // starts 13.5 m/s * 1 s wide
}

TEST_CASE("a light's plan repeats; invalid plans and lights are errors") {
  map::LightPlan const plan{.cycle = 60.0, .green_begin = 50.0, .green_end = 70.0, .yellow = 3.0};
  using map::LightColor;
  CHECK(plan.at(49.9) == LightColor::red);
  CHECK(plan.at(50.0) == LightColor::green);
  CHECK(plan.at(69.9) == LightColor::green);
  CHECK(plan.at(9.9) == LightColor::green);
  CHECK(plan.at(10.1) == LightColor::yellow);
  CHECK(plan.at(13.1) == LightColor::red);
  CHECK(plan.at(-50.1) == LightColor::green);  // same as 9.9
  CHECK(map::LightPlan{}.at(5.0) == LightColor::off);
  Crossing crossing{crossing_with({{"1", "1000001"}})};
  Sim world(crossing.map);
  CHECK_THROWS_AS(world.set_light(static_cast<LightId>(7), plan), WorldError);
  CHECK_THROWS_AS(world.set_light(static_cast<LightId>(0), {.cycle = -1.0}), WorldError);
  CHECK_THROWS_AS(world.set_light(static_cast<LightId>(0), {.cycle = 10.0, .green_end = std::nan("")}), WorldError);
}

TEST_CASE("a vehicle that has just split off and stands with its rear in the way is seen") {
  // A vehicle follows one that turns right and has stopped as soon as its reference point has left the lane.
  Crossing const crossing;
  auto const turning = crossing.route(1, 1), straight = crossing.route(1, 0);
  auto const& way = crossing.map->lane(turning.lanes[1]);
  for (double s = 1.0; s < 12.0; s += 1.0) {
    Sim at(crossing.map);
    enter(at, way, s,
          {.behavior =
               IdmClassic{.law = {.desired_speed = 0.1, .maximum_acceleration = 0.01, .highest_acceleration = 0.0}},
           .route = turning});
    add_before(at, straight, 30.0, 8.0);
    (void)times_through(at, {}, 20.0);
  }
}

TEST_CASE("crossing a junction allocates nothing and is repeatable, in the world and in a prediction") {
  Crossing const crossing;
  Sim world(crossing.map, {.seed = 4});
  for (int arm = 1; arm <= 4; ++arm)
    for (int turn : {0, 1, 2}) add_before(world, crossing.route(arm, turn), turn == 1 ? 39.0 : 30.0, 6.0);
  auto future = world.observe(static_cast<AgentId>(0)).predict(predict_all_as<Set>(Intersection{}));
  for (auto* each : {&world, &future}) {
    Sim copy = *each;
    for (int k = 0; k < 3; ++k) REQUIRE((each->step(0.2) && copy.step(0.2)));
    auto const before = support::allocations();
    for (int k = 0; k < 100; ++k) REQUIRE(each->step(0.2));
    CHECK(support::allocations() == before);
    for (int k = 0; k < 100; ++k) REQUIRE(copy.step(0.2));
    for (std::size_t i = 0; i < copy.size(); ++i)
      CHECK(copy.frame().agents[i].state.x == each->frame().agents[i].state.x);
  }
}

TEST_CASE("a driver keeps the junction clear if there is no room behind it, unless told not to") {
  Crossing const crossing;
  auto const route = crossing.route(1, 0);
  for (bool const keep_clear : {true, false}) {
    Sim world(crossing.map);
    auto const id = add_before(world, route, 30.0, 6.0);
    world.set_behavior(id, Intersection{.law = {.desired_speed = 10.0}}.with(Conflicts{.keep_clear = keep_clear}));
    // A queue that hardly moves begins right behind the junction.
    std::size_t behind = 1;
    while (!is_in_junction(*crossing.map, route.lanes[behind])) ++behind;
    while (is_in_junction(*crossing.map, route.lanes[behind])) ++behind;
    enter(world, crossing.map->lane(route.lanes[behind]), 2.0, {.behavior = IdmClassic{.law = {.desired_speed = 0.1}}});
    bool entered = false;
    for (int i = 0; i < 100; ++i) {
      REQUIRE(world.step(0.2));
      entered = entered || is_in_junction(*crossing.map, world.lane_of(id));
    }
    CAPTURE(keep_clear);
    CHECK(entered == !keep_clear);
  }
}

TEST_CASE("nobody who follows into a queue behind a junction stands in it, however long he has waited") {
  Crossing const crossing;
  auto const route = crossing.route(1, 0);
  std::size_t behind = 1;
  while (!is_in_junction(*crossing.map, route.lanes[behind])) ++behind;
  while (is_in_junction(*crossing.map, route.lanes[behind])) ++behind;
  auto const& exit = crossing.map->lane(route.lanes[behind]);
  for (bool const with_truck : {false, true}) {
    int far = 0;
    for (double s = 2.0; s < 20.0; s += 1.0) {
      Sim world(crossing.map);
      auto const stands = Intersection{.law = {.desired_speed = 0.1, .maximum_acceleration = 0.01}};
      enter(world, exit, s, {.behavior = stands});
      if (with_truck) enter(world, exit, 80.0, {.shape = geometry::truck(), .behavior = stands});
      std::vector<AgentId> const ids{add_before(world, route, 18.0, 6.0), add_before(world, route, 30.0, 6.0)};
      for (int step = 0; step < 300; ++step) REQUIRE(world.step(0.2));
      for (auto const id : ids) {
        auto const view = world.observe(id);
        if (view.state().speed > 1.0) continue;
        double const rear = view.place().s - view.shape().rear, front = view.place().s + view.shape().front;
        far += view.place().s > view.corridor().conflicts.front().hull().begin;
        CAPTURE(s);
        CAPTURE(with_truck);
        for (auto const& conflict : view.corridor().conflicts) {
          auto const& zone = conflict.zones[0][with_truck];
          if (conflict.kind != map::OverlapKind::split && !zone.empty())
            CHECK((front < zone.begin || rear > zone.end - 1.0));
        }
      }
    }
    CHECK(far > 3);
  }
}

TEST_CASE("a driver who has to yield goes before one who stands as long as it does, whatever the ids") {
  Crossing crossing{crossing_with({{"1", "306"}, {"2", "205"}, {"3", "306"}, {"4", "205"}})};
  for (std::uint32_t const id : {1, 9}) {
    Sim world(crossing.map);
    auto const broken_down = add_before(world, crossing.route(1, 0), 6.0, 0.0, AgentId{5});
    world.set_behavior(broken_down, Intersection{.law = {.desired_speed = 0.1, .maximum_acceleration = 0.01}});
    auto const north = add_before(world, crossing.route(2, 0), 30.0, 6.0, AgentId{id});
    auto const times = times_through(world, {north}, 40.0);
    REQUIRE(times[0]);
    CHECK(*times[0] < 25.0);
  }
}
