// Traffic against what others have counted in the field: speed and density, headways, lane changes, gaps accepted.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../support/maps.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/presets.hpp"
#include "cambium/benchmark/statistics.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/scenario/junction_site.hpp"
#include "cambium/scenario/traffic_inflow.hpp"

using namespace cambium;

namespace {

using Highway = World<BehaviorSet<Mobil>, InterpolateExecution, SingleTrack>;

/// What is measured on the second half of a straight road of three lanes (Edie 1963 for speed and density).
struct Stream {
  double speed{}, density{}, flow{};  ///< [km/h], [1/km/lane], [1/h/lane]
  double lane_changes{};              ///< [1/(vehicle km)]
  std::vector<double> followers{};    ///< headways of those who follow [s]
};

/// Cars with the temperaments of `presets`: half of them normal, a quarter timid, a quarter aggressive.
Stream drive_highway(double per_hour, std::uint64_t seed) {
  constexpr double length = 3000.0, from = 1500.0, to = 2900.0, warm_up = 240.0, end = 840.0, dt = 0.25;
  auto const road = support::straight_road(3, length);
  Highway world(road, {.seed = seed});
  auto sources = find_sources(*road);
  for (auto& source : sources) source.per_hour = per_hour;
  TrafficInflow<Highway> inflow(*road, sources, seed);
  auto const next = [&](TrafficSource const& source, RandomStream& random) {
    double const kind = uniform01(random);
    auto const driver = kind < 0.25   ? presets::timid<Mobil>()
                        : kind < 0.75 ? presets::normal<Mobil>()
                                      : presets::aggressive<Mobil>();
    return Highway::AgentSpec{.speed = driver.law.desired_speed,
                              .shape = geometry::car(),
                              .behavior = driver,
                              .route = random_route(*road, source.lane, random, length)};
  };
  struct Last {
    CorridorId lane;
    double s;
  };
  std::map<AgentId, Last> before;
  std::map<CorridorId, double> passed;
  Stream stream;
  double time = 0.0, way = 0.0;
  int changes = 0;
  while (world.time() < end) {
    inflow.enter(world, next);
    REQUIRE(world.step(dt));
    for (Slot slot{}; index_of(slot) < world.size(); ++slot) {
      auto const& record = world.frame().agents[slot];
      auto const id = world.roster().agents[slot].id;
      Last const now{record.lane.corridor, record.lane.s};
      auto const last = before.find(id);
      if (world.time() > warm_up && last != before.end() && now.s > from && now.s < to) {
        time += dt;
        way += record.state.speed * dt;
        changes += last->second.lane != now.lane;
        constexpr double gate = 2200.0;
        if (last->second.s <= gate && now.s > gate) {
          double const at = world.time() - (now.s - gate) / record.state.speed;
          auto const ahead = world.observe(slot).ahead();
          // Who drives as fast as the next one, up to 5 s behind it, follows it.
          if (passed.count(now.lane) && ahead && std::abs(ahead->speed - record.state.speed) < 1.5 &&
              at - passed[now.lane] < 5.0)
            stream.followers.push_back(at - passed[now.lane]);
          passed[now.lane] = at;
        }
      }
      before[id] = now;
    }
    inflow.leave(world);
  }
  double const area = 3.0 * (to - from) * 1e-3 * (end - warm_up);  // [lane km s]
  stream.speed = 3.6 * way / time;
  stream.density = time / area;
  stream.flow = stream.density * stream.speed;
  stream.lane_changes = changes / (1e-3 * way);
  return stream;
}

/// The gaps between two vehicles of the main road, in seconds, of which drivers of the side road have made use or not.
struct Gaps {
  std::vector<double> accepted{}, rejected{};

  /// Raff's critical gap [s]: as many accepted gaps are shorter as rejected ones are longer.
  [[nodiscard]] double critical() const {
    double gap = 0.0;
    auto const shorter = [&] { return std::ranges::count_if(accepted, [&](double a) { return a < gap; }); };
    auto const longer = [&] { return std::ranges::count_if(rejected, [&](double r) { return r > gap; }); };
    while (shorter() < longer()) gap += 0.05;
    return gap;
  }
};

/// Traffic on the main road of maps/intersection_3way.xodr goes straight on; from the side road it turns to `side` (1:
/// left, across both directions; -1: right, into one).
Gaps turn_in(double side, std::uint64_t seed) {
  constexpr double end = 7200.0, dt = 0.2;
  auto const site = find_junction_site(support::own_map("intersection_3way.xodr"));
  auto const& map = *site.map;
  JunctionSite::World world(site.map, {.seed = seed});
  auto const turn = [&](map::Route const& route) {
    auto const heading = [&](LaneId lane, double share) {
      return map.lane(lane).path.pose(share * map.lane(lane).path.length()).heading;
    };
    return geometry::angle_difference(heading(route.lanes.back(), 1.0), heading(route.lanes.front(), 0.0));
  };
  auto const find_route = [&](LaneId from, double lowest, double highest) -> std::optional<map::Route> {
    for (std::uint32_t i = 0; i < 40; ++i) {
      RandomStream random(1, i, 0, 7);
      auto const route = site.random_route(from, random);
      if (double const angle = turn(route); angle > lowest && angle < highest) return route;
    }
    return std::nullopt;
  };
  std::vector<TrafficSource> sources;
  std::vector<map::Route> routes;
  std::vector<double> turns;
  for (auto const lane : site.entrances) {
    auto const right = find_route(lane, -2.5, -0.5), left = find_route(lane, 0.5, 2.5);
    bool const is_main = !(right && left);
    auto const route = is_main ? find_route(lane, -0.3, 0.3) : side > 0.0 ? left : right;
    if (!route) continue;
    sources.push_back({.lane = lane, .per_hour = is_main ? 350.0 : 900.0});
    routes.push_back(*route);
    turns.push_back(is_main ? 0.0 : side);
  }
  REQUIRE(std::ranges::count(turns, side) == 1);
  TrafficInflow<JunctionSite::World> inflow(map, sources, seed);
  auto const next = [&](TrafficSource const& source, RandomStream& random) {
    auto const at = std::ranges::find_if(sources, [&](auto const& other) { return other.lane == source.lane; });
    return JunctionSite::World::AgentSpec{
        .speed = 10.0,
        .shape = geometry::car(),
        .behavior = UrbanDriver{.law = {.desired_speed = 12.0 + 3.0 * uniform01(random)}},
        .route = routes[static_cast<std::size_t>(at - sources.begin())]};
  };
  struct Driver {
    double turn{}, side{};
    LaneId into = none<LaneId>;
    bool is_in = false;
  };
  std::map<AgentId, Driver> drivers;
  std::optional<AgentId> waiting;
  bool has_entered = false;
  double begin = -1.0;
  Gaps gaps;
  while (world.time() < end) {
    for (auto const& entered : inflow.enter(world, next))
      drivers[entered.id] = {turns[entered.source], 0.0, routes[entered.source].lanes.back()};
    REQUIRE(world.step(dt));
    std::optional<AgentId> first;
    double nearest = 8.0;
    bool passes = false;
    auto const into = routes[static_cast<std::size_t>(std::ranges::find(turns, side) - turns.begin())].lanes.back();
    for (Slot slot{}; index_of(slot) < world.size(); ++slot) {
      auto const& record = world.frame().agents[slot];
      auto const& agent = world.roster().agents[slot];
      auto& driver = drivers[agent.id];
      auto const& corridor = agent.road->corridors[record.lane.corridor];
      auto const& piece = corridor.pieces[record.lane.piece];
      bool const in_junction = is_valid(map.road(map.lane(piece.lane).road).junction);
      double const front = record.lane.s + agent.shape.front;
      bool const conflicts = side > 0.0 || driver.into == into;
      if (driver.turn == 0.0) {
        if (in_junction && !driver.is_in && conflicts) passes = true;  // a driver may enter right behind it
        driver.is_in = driver.is_in || in_junction;
      } else {
        if (in_junction && !driver.is_in) {
          driver.is_in = true;
          has_entered = has_entered || waiting == agent.id;
        }
        double const to_line = piece.end - front;
        if (!driver.is_in && !in_junction && to_line < nearest && record.state.speed < 1.0) {
          nearest = to_line;
          first = agent.id;
        }
      }
    }
    if (passes) {
      if (waiting && begin >= 0.0) (has_entered ? gaps.accepted : gaps.rejected).push_back(world.time() - begin);
      waiting = first;
      has_entered = false;
      begin = world.time();
    }
    inflow.leave(world);
  }
  return gaps;
}

double deviation(std::vector<double> const& x) {
  return std::sqrt(detail::Moments(x).square / static_cast<double>(x.size()));
}

/// Speed [km/h] at a density [cars/km/lane] of a motorway with a free speed of 120 km/h, where the levels of service
/// end (Highway Capacity Manual 2000, exhibit 23-2), linear between them.
double manual_speed(double density) {
  constexpr double densities[] = {0.0, 11.0, 16.0, 22.0, 28.0}, speeds[] = {120.0, 120.0, 114.6, 99.6, 85.7};
  int i = 0;
  while (i < 3 && density > densities[i + 1]) ++i;
  return speeds[i] + (speeds[i + 1] - speeds[i]) * (density - densities[i]) / (densities[i + 1] - densities[i]);
}

}  // namespace

TEST_CASE(
    "on a motorway speed falls with density as in the manual, and cars follow and change lanes as often as counted") {
  double before = 130.0;
  for (double const per_hour : {500.0, 900.0, 1300.0, TrafficSource::saturated}) {
    auto const s = drive_highway(per_hour, 5);
    MESSAGE("demand ", per_hour, " 1/h/lane: flow ", s.flow, ", density ", s.density, " 1/km/lane, speed ", s.speed,
            " km/h (manual: ", manual_speed(s.density), "), lane changes ", s.lane_changes, " 1/km, ",
            s.followers.size(), " followers, headway ", mean_of(s.followers), " s, standard deviation ",
            deviation(s.followers), " s");
    CHECK(s.speed < before);
    CHECK(std::abs(s.speed / manual_speed(s.density) - 1.0) < 0.3);
    CHECK(s.lane_changes > 0.25);  // Knoop et al. 2012: 0.5
    CHECK(s.lane_changes < 1.0);
    CHECK(mean_of(s.followers) < 3.0);  // Wasielewski 1979: 1.32 s
    before = s.speed;
  }
}

TEST_CASE("drivers of a side road accept about the gaps that the manual gives") {
  for (double const side : {-1.0, 1.0}) {
    auto const gaps = turn_in(side, 3);
    double const manual = side > 0.0 ? 7.1 : 6.2;  // Highway Capacity Manual 2000, exhibit 17-5, two lanes
    MESSAGE("turn to the ", std::string(side > 0.0 ? "left" : "right"), ": ", gaps.accepted.size(), " gaps accepted, ",
            gaps.rejected.size(), " rejected, critical gap ", gaps.critical(), " s (manual: ", manual, ")");
    CHECK(gaps.accepted.size() > 30);
    CHECK(gaps.rejected.size() > 50);
    CHECK(std::abs(gaps.critical() / manual - 1.0) < 0.3);
  }
}
