#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

#include "cambium/evaluation/collision.hpp"
#include "cambium/map/corridor/build_corridor.hpp"

#include "junction.hpp"
#include "row.hpp"

namespace field {
namespace {

/// Headways of followers on a street.
std::vector<Row> following(std::uint64_t seed) {
  constexpr double warm_up = 300.0, duration = 5400.0, longest = 4.0;  // [s]
  std::vector<double> headways;
  for (double const demand : {500.0, 800.0, 1100.0}) {
    Observed street(straight_road(2000.0, 1, town_limit), town_people(), demand, ++seed, 1500.0);
    street.drive(warm_up);
    street.clear();
    street.drive(duration);
    for (double const headway : follower_headways(street.passages(), longest)) headways.push_back(headway);
  }
  auto const close = std::count_if(headways.begin(), headways.end(), [](double t) { return t < 1.0; });
  return {{"headway of followers in town, mean", 1.9, 2.3, "s", "Michael et al. 2000", moments(headways).mean},
          {"of these below 1 s", 0.04, 0.1, "-", "Michael et al. 2000",
           static_cast<double>(close) / static_cast<double>(headways.size())}};
}

/// An approach whose light is green for `green` of each `cycle` [s], and what comes to it.
struct Approach {
  cb::map::LightPlan plan;
  Junction junction;

  Approach(double green, double cycle, double per_hour, std::uint64_t seed)
      : plan{.cycle = cycle, .green_begin = 0.0, .green_end = green},
        junction(crossing({light, light, light, light}), town_people(), seed, {{{"1", "13", "3"}, per_hour}}) {
    auto& world = junction.world();
    world.set_light(world.map().find_light("signal 1"), plan);
  }
};

/// Queues at a light: headways from the fifth vehicle on, and what the first four lose.
std::vector<Row> saturation(std::uint64_t seed) {
  constexpr double green = 40.0, cycle = 80.0;
  constexpr std::size_t cycles = 40;
  constexpr std::ptrdiff_t first = 4;
  Approach approach(green, cycle, cb::TrafficSource::saturated, seed);
  approach.junction.drive(cycle * static_cast<double>(cycles));
  std::vector<double> headways, starts;
  auto const& times = approach.junction.at_line(0);
  for (std::size_t i = 1; i < cycles; ++i) {
    double const begin = cycle * static_cast<double>(i);
    auto const from = std::lower_bound(times.begin(), times.end(), begin);
    auto const to = std::lower_bound(from, times.end(), begin + green);
    if (to - from <= first) continue;
    starts.push_back(*(from + first - 1) - begin);
    for (auto at = from + first; at != to; ++at) headways.push_back(*at - *(at - 1));
  }
  double const headway = moments(headways).mean;
  return {{"saturation flow of a lane at green", 1750, 1950, "1/h", "HCM 7th ed., ch. 19", 3600.0 / headway},
          {"start-up loss at green", 1.5, 2.5, "s", "HCM 7th ed., ch. 19",
           moments(starts).mean - static_cast<double>(first) * headway}};
}

std::vector<Row> red_running(std::uint64_t seed) {
  constexpr double green = 42.0, cycle = 90.0, hours = 50.0, demand = 700.0;
  Approach approach(green, cycle, demand, seed);
  approach.junction.drive(3600.0 * hours);
  auto const& times = approach.junction.at_line(0);
  auto const runners = static_cast<double>(std::count_if(
      times.begin(), times.end(), [&](double t) { return approach.plan.at(t) == cb::map::LightColor::red; }));
  return {
      {"red running on a busy approach, an hour", 0.5, 2.0, "1/h", "nine sites: 0.8 to 1.9; Hunter", runners / hours},
      {"red running on a busy approach, a cycle", 1.0 / 56.0, 1.0 / 24.0, "-", "nine sites: one per 24 to 56 cycles",
       runners / (3600.0 * hours / cycle)}};
}

/// A vehicle at the end of a step.
struct Moment {
  double time{}, to_line{}, speed{}, acceleration{}, lateral{};  ///< [s, m, m/s, m/s^2]; to_line: of its front end
};

/// Drives one vehicle along the roads, alone: from `distance` [m] before the junction until it stands or arrives.
std::vector<Moment> drive_alone(std::shared_ptr<cb::Map const> const& map, std::vector<std::string> const& roads,
                                Sim::AgentSpec spec, double distance, cb::map::LightPlan const& plan,
                                std::uint64_t seed) {
  constexpr double dt = 0.1, longest = 60.0;  // [s]
  Sim world(map, {.seed = seed});
  if (plan.cycle > 0.0) world.set_light(map->find_light("signal " + roads.front()), plan);
  spec.route = route_through(*map, roads);
  auto const road = build_road_corridor(*map, *spec.route);
  auto const& corridor = road->corridors[road->main];
  double const line = corridor.position_of({spec.route->lanes[1], 0.0}).value();
  spec.position = corridor.center.pose(line - distance - spec.shape.front).position();
  auto const id = world.add(spec);
  std::vector<Moment> moments;
  for (auto before = world.state(id); world.time() < longest; before = world.state(id)) {
    if (!world.step(dt)) throw cb::Error("a step of the simulation", "failed", "report this as a bug");
    auto const& now = world.state(id);
    double const turn = cb::geometry::angle_difference(now.heading, before.heading);
    moments.push_back({world.time(), line - world.record(id).lane.s - spec.shape.front, now.speed,
                       (now.speed - before.speed) / dt, std::abs(turn) / dt * 0.5 * (now.speed + before.speed)});
    if (world.status(id) != cb::AgentStatus::driving || now.speed < 0.05) break;
  }
  return moments;
}

/// The next driver of a car in town, at its speed on a free street.
Sim::AgentSpec free_driver(cb::RandomStream& random, double limit = town_limit) {
  auto spec = town_people().draw(random);
  spec.speed = std::min(spec.speed, limit * std::get<Driver>(spec.behavior).heed<cb::SpeedLimit>().factor);
  return spec;
}

/// Drivers alone on their way to a light that turns yellow when they are up to 6.5 s before it, on a fast road, as were
/// four of the six that Gates et al. observed.
std::vector<Row> yellow(std::uint64_t seed) {
  constexpr double limit = 70.0 / 3.6, distance = 180.0, nearest = 0.5, farthest = 6.5;
  constexpr double brakes = -0.5;            // [m/s^2]: its brake lights shine
  constexpr double early = 2.5, late = 5.5;  // [s] before the line: where Gates et al. looked
  auto const map = crossing({light, light, light, light}, limit);
  std::vector<double> ways, reactions, decelerations;
  std::vector<bool> stopped;
  for (std::uint32_t i = 0; i < 500; ++i) {
    cb::RandomStream random(seed, i, 0);
    auto const spec = free_driver(random, limit);
    double const way = cb::Uniform{nearest, farthest}(random), turns = distance / spec.speed - way;
    auto const moments =
        drive_alone(map, {"1", "13", "3"}, spec, distance, {.cycle = 600.0, .green_end = turns}, seed + i);
    ways.push_back(way);
    stopped.push_back(moments.back().to_line > 0.0);
    if (!stopped.back() || way < early || way > late) continue;
    auto const first = std::find_if(moments.begin(), moments.end(), [&](Moment const& moment) {
      return moment.time > turns && moment.acceleration < brakes;
    });
    if (first == moments.begin() || first == moments.end()) continue;
    auto const& onset = *(first - 1);
    reactions.push_back(onset.time - turns);
    decelerations.push_back(onset.speed * onset.speed / (2.0 * (onset.to_line - moments.back().to_line)));
  }
  Logistic const stops(ways, stopped);
  constexpr char const *gates = "Gates et al. 2007", *zone = "field test, 60 drivers";
  return {
      {"reaction of the first to stop at yellow, median", 0.8, 1.2, "s", gates, quantile(reactions, 0.5)},
      {"deceleration of the first to stop at yellow, median", 2.6, 3.4, "m/s^2", gates, quantile(decelerations, 0.5)},
      {"deceleration of the first to stop at yellow, 85 %", 2.6, 4.2, "m/s^2", gates, quantile(decelerations, 0.85)},
      {"time to the line at yellow where 10 % stop", 1.5, 5.0, "s", zone, stops.at(0.1)},
      {"time to the line at yellow where 90 % stop", 1.5, 5.0, "s", zone, stops.at(0.9)}};
}

std::vector<Row> stop_braking(std::uint64_t seed) {
  auto const map = crossing({stop_sign, stop_sign, stop_sign, stop_sign});
  std::vector<double> peaks;
  for (std::uint32_t i = 0; i < 200; ++i) {
    cb::RandomStream random(seed, i, 0);
    double hardest = 0.0;
    for (auto const& moment : drive_alone(map, {"1", "13", "3"}, free_driver(random), 180.0, {}, seed + i))
      hardest = std::max(hardest, -moment.acceleration);
    peaks.push_back(hardest);
  }
  return {{"hardest braking before a stop sign, median", 2.0, 3.0, "m/s^2", "Roenitz; Wang", quantile(peaks, 0.5)},
          {"hardest braking before a stop sign, 95 %", 2.0, 3.6, "m/s^2", "Roenitz; Wang", quantile(peaks, 0.95)}};
}

std::vector<Row> turns(std::uint64_t seed) {
  auto const map = crossing({priority, stop_sign, priority, stop_sign});
  std::vector<double> highest;
  for (std::uint32_t i = 0; i < 200; ++i) {
    cb::RandomStream random(seed, i, 0);
    auto const roads = i % 2 == 0 ? std::vector<std::string>{"1", "12", "2"} : std::vector<std::string>{"1", "14", "4"};
    double most = 0.0;
    for (auto const& moment : drive_alone(map, roads, free_driver(random), 180.0, {}, seed + i))
      most = std::max(most, moment.lateral);
    highest.push_back(most);
  }
  return {{"lateral acceleration in turns of 8 to 12 m, 85 %", 2.5, 3.5, "m/s^2", "unverified", quantile(highest, 0.85),
           true}};
}

/// Those who touched another in the last step, each with the largest speed relative to one that it touched [m/s].
std::map<cb::AgentId, double> impacts(Sim const& world) {
  std::map<cb::AgentId, double> hit;
  if (!cb::AnyCollision{}(world)) return hit;
  for (cb::Slot a{}; index_of(a) < world.size(); ++a)
    for (cb::Slot b{}; b < a; ++b) {
      if (!cb::in_traffic(world, a) || !cb::in_traffic(world, b)) continue;
      if (!cb::geometry::intersects(cb::motion_at(world, a), cb::motion_at(world, b))) continue;
      auto const &p = world.frame().agents[a].state, &q = world.frame().agents[b].state;
      double const along = p.speed * std::cos(p.heading) - q.speed * std::cos(q.heading),
                   across = p.speed * std::sin(p.heading) - q.speed * std::sin(q.heading);
      for (auto const slot : {a, b}) {
        auto& most = hit[world.roster().agents[slot].id];
        most = std::max(most, std::hypot(along, across));
      }
    }
  return hit;
}

/// Human drivers on three junctions: who touches another, who collides as the police would hear of it, and who brakes
/// by half of g.
std::vector<Row> errors(std::uint64_t seed) {
  constexpr double dt = 0.2, duration = 36'000.0, demand = 250.0, hard = 4.9, once = 10.0;  // [s, 1/h, m/s^2, s]
  constexpr double reported = 2.0;                                                          // [m/s]: impact speed
  double kilometres = 0.0, touched = 0.0, crashed = 0.0, near = 0.0;
  for (auto const& map :
       {crossing({light, light, light, light}), crossing({priority, stop_sign, priority, stop_sign}), roundabout()}) {
    Sim world(map, {.seed = ++seed});
    for (auto const& each : map->lights()) {
      double const begin = each.name.back() % 2 == 0 ? 0.0 : 30.0;
      world.set_light(each.id, {.cycle = 60.0, .green_begin = begin, .green_end = begin + 25.0});
    }
    auto sources = cb::find_sources(*map);
    for (auto& source : sources) source.per_hour = demand;
    cb::TrafficInflow<Sim> inflow(*map, sources, seed, {.headway = 1.0, .deceleration = 2.0});
    struct Seen {
      double speed{}, braked = -once;
    };
    std::unordered_map<cb::AgentId, Seen> seen;
    while (world.time() < duration) {
      for (auto const &entered : inflow.enter(world, [&](cb::TrafficSource const&source, cb::RandomStream&random) {
             auto spec = town_people().draw_erring(random);
             spec.route = cb::random_route(*map, source.lane, random);
             return spec;
           }))
        seen[entered.id] = {world.state(entered.id).speed};
      if (!world.step(dt)) throw cb::Error("a step of the simulation", "failed", "report this as a bug");
      for (cb::Slot slot{}; index_of(slot) < world.size(); ++slot) {
        auto const id = world.roster().agents[slot].id;
        double const speed = world.frame().agents[slot].state.speed;
        auto& before = seen[id];
        kilometres += 0.5e-3 * (before.speed + speed) * dt;
        if (before.speed - speed > hard * dt && world.time() - before.braked > once) {
          ++near;
          before.braked = world.time();
        }
        before.speed = speed;
      }
      auto const hit = impacts(world);
      touched += static_cast<double>(hit.size());
      for (auto const& [id, impact] : hit) {
        crashed += impact > reported;
        world.remove(id);
      }
      inflow.leave(world);
    }
  }
  auto const of = " of human drivers, in " + std::to_string(std::lround(kilometres)) + " km";
  std::string const source =
      "Kusano et al. 2024; ours: impact above 2 m/s (" + std::to_string(std::lround(touched)) + " touched)";
  double const millions = kilometres / 1e6;
  return {{"crashed vehicles" + of, 1.5, 5.0, "1/Mkm", source, crashed / millions, true},
          {"hard braking (0.5 g)" + of, 50, 100, "1/Mkm", "100-Car, SHRP2; unverified", near / millions, true}};
}

}  // namespace

std::vector<Experiment> town_experiments() {
  return {{"following", following}, {"saturation", saturation},     {"red running", red_running},
          {"yellow", yellow},       {"stop braking", stop_braking}, {"turns", turns},
          {"errors", errors}};
}

}  // namespace field
