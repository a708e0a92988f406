#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "cambium/behavior.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/corridor/free_corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/scenario/traffic_inflow.hpp"
#include "cambium/world/world.hpp"

#include "../common/parameter_file.hpp"

/// The long test of mixed traffic: see main.cpp.
namespace soak {

namespace cb = cambium;

using Driver = cb::UrbanDriver;
using Sim = cb::World<cb::BehaviorSet<Driver, cb::Pedestrian>, cb::InterpolateExecution, cb::SingleTrack>;

/// A map under test, and where its traffic comes from.
struct Site {
  std::string file;
  std::shared_ptr<cb::Map const> map;
  std::vector<cb::TrafficSource> sources{};  ///< of vehicles
  std::vector<cb::TrafficSource> paths{};    ///< of pedestrians
  bool has_conflicts = false;                ///< ways cross, or merge in a junction: all drive by its rules
  bool has_merges = false;

  [[nodiscard]] bool has_lights() const { return !map->lights().empty(); }
};

/// Whether a vehicle of `shape` can meet one of its width in all bends of the route: its front swings out there, and
/// traffic in the lane beside does not look out for it. With `people` beside the road, its front also has to stay on
/// the road where it turns in a junction.
[[nodiscard]] inline bool fits(cb::Map const& map, cb::map::Route const& route, cb::geometry::Shape const& shape,
                               bool people) {
  return std::all_of(route.lanes.begin(), route.lanes.end(), [&](cb::LaneId id) {
    auto const& lane = map.lane(id);
    bool const turns = is_valid(map.road(lane.road).junction);
    if (turns && !people) return true;
    auto const segments = lane.path.segments();
    for (std::size_t i = 0; i < segments.size(); ++i) {
      auto const pose = lane.path.pose(segments[i].s);
      auto const on_road = [&](double ahead, double aside) {
        return map.on_drivable_lane(cb::geometry::to_map(pose, {ahead, aside}));
      };
      if (turns && !(on_road(shape.front, shape.left) && on_road(shape.front, -shape.right))) return false;
      if (turns) continue;
      auto const& widths = lane.widths[i];
      double const swing = 0.5 * segments[i].curvature * shape.front * shape.front;  // to the right
      double const room = std::max(0.3, widths.left + widths.right - 2.0 * shape.right - 0.05);
      if (std::abs(swing) > room && on_road(0.0, swing > 0.0 ? -widths.right - 0.5 : widths.left + 0.5)) return false;
    }
    return true;
  });
}

/// Ways across the roads that have a sidewalk on either side, from one to the other, and along the sidewalks.
[[nodiscard]] inline std::vector<cb::TrafficSource> find_paths(cb::Map const& map) {
  std::vector<cb::TrafficSource> paths;
  auto const is_sidewalk = [&](cb::map::Lane const& lane) {
    return lane.type == cb::map::LaneType::sidewalk && !is_valid(map.road(lane.road).junction);
  };
  for (auto const& lane : map.lanes()) {
    if (!is_sidewalk(lane) || lane.length() < 15.0) continue;
    auto const on_road = [&](cb::geometry::Point const& p) { return map.on_drivable_lane(p); };
    auto const walk = [&](std::vector<cb::geometry::Point> const& points) {
      paths.push_back({.way = cb::map::build_free_corridor(map, points, {.width = 1.0}), .per_hour = 60.0});
    };
    std::vector<cb::geometry::Point> along;
    for (double s = 0.0; s < lane.length(); s += 3.0) along.push_back(lane.path.pose(s).position());
    if (std::none_of(along.begin(), along.end(), on_road)) walk(along);
    double const station = lane.station_at(0.5 * lane.length());
    for (auto const& other : map.lanes())
      if (is_sidewalk(other) && other.road == lane.road && other.section == lane.section &&
          (other.number > 0) != (lane.number > 0))
        walk({lane.path.pose(0.5 * lane.length()).position(), other.path.pose(other.position_at(station)).position()});
  }
  return paths;
}

[[nodiscard]] inline Site make_site(std::string file, std::shared_ptr<cb::Map const> map) {
  Site site{std::move(file), std::move(map)};
  site.sources = cb::find_sources(*site.map);
  site.paths = find_paths(*site.map);
  for (auto const& lane : site.map->lanes()) {
    bool const in_junction = is_valid(site.map->road(lane.road).junction);
    site.has_merges = site.has_merges || is_valid(lane.merges_into);
    for (auto const& overlap : lane.overlaps)
      if (lane.drivable() && overlap.kind != cb::map::OverlapKind::split) {
        site.has_conflicts = site.has_conflicts || in_junction || overlap.kind == cb::map::OverlapKind::crossing;
        site.has_merges = site.has_merges || overlap.kind == cb::map::OverlapKind::merge;
      }
  }
  return site;
}

/// What the traffic of one run consists of.
struct Mix {
  std::string name;
  double truck_share = 0.35, bus_share = 0.03, bicycle_share = 0.0;
  bool lights = false;
  bool is_saturated = true;
  double per_hour = cb::TrafficSource::saturated;
  double dt = 0.2;
};

/// The traffic of run `run`.
[[nodiscard]] inline Mix draw_mix(Site const& site, std::uint64_t seed, std::uint32_t run) {
  cb::RandomStream random(seed, run, 1);
  Mix mix;
  mix.dt = 0.01 * std::round(100.0 * cb::Uniform{0.05, 0.5}(random));
  mix.is_saturated = run % 3 != 2;
  double const share = cb::uniform01(random);
  if (!mix.is_saturated) mix.per_hour = site.has_conflicts ? 60.0 + 440.0 * share : 200.0 + 1400.0 * share;
  mix.lights = site.has_lights() && run % 2 == 0;
  if (site.has_conflicts) mix.bicycle_share = 0.07;
  mix.name = mix.lights ? "lights on" : site.has_conflicts ? "junctions" : "roads";
  return mix;
}

/// A person who drives where the limit is `limit` [m/s]. On motorways half of them keep to the outer lanes, and all
/// know of exits early.
[[nodiscard]] inline Driver draw_driver(double limit, bool is_heavy, bool is_motorway, cb::RandomStream& random) {
  auto const people = is_motorway ? (is_heavy ? cb::presets::motorway_trucks() : cb::presets::motorway_cars())
                                  : (is_heavy ? cb::presets::town_trucks() : cb::presets::town_cars());
  auto one = people.draw(random);
  if (!is_motorway && !std::isfinite(limit)) one.idm.desired_speed = 50.0 / 3.6 * one.speed_factor;
  auto driver = one.of(Driver{});
  if (!is_motorway) return driver;
  driver.lateral.rule.keep_right = cb::uniform01(random) < 0.5;
  driver.lateral.rule.route_horizon = 800.0;
  driver.lateral.rule.route_bias = 4.0;
  return driver;
}

/// One who rides a bicycle.
[[nodiscard]] inline Driver draw_cyclist() {
  Driver driver;
  cb::presets::follow_as(cb::presets::cyclist(), driver.law);
  return driver;
}

[[nodiscard]] inline cb::Pedestrian draw_walker(cb::RandomStream& random) {
  cb::Pedestrian walker;
  walker.social.desired_speed = cb::Uniform{1.0, 1.6}(random);
  return walker;
}

/// Someone who walks along a path.
[[nodiscard]] inline Sim::AgentSpec draw_pedestrian(cb::RandomStream& random) {
  return {.speed = 1.0, .shape = cb::geometry::pedestrian(), .behavior = draw_walker(random)};
}

/// The next vehicle of a source. Trucks and buses only where they fit.
[[nodiscard]] inline Sim::AgentSpec draw_vehicle(Site const& site, Mix const& mix, cb::TrafficSource const& source,
                                                 cb::RandomStream& random) {
  using namespace cb::geometry;
  auto const route = cb::random_route(*site.map, source.lane, random, site.has_conflicts ? 400.0 : 3000.0);
  double const share = cb::uniform01(random);
  Shape shape = share < mix.truck_share                                             ? truck()
                : share < mix.truck_share + mix.bus_share                           ? bus()
                : share < mix.truck_share + mix.bus_share + 0.1                     ? van()
                : share < mix.truck_share + mix.bus_share + 0.1 + mix.bicycle_share ? bicycle()
                                                                                    : car();
  bool const has_room = cb::fits_route(*site.map, route, shape) && fits(*site.map, route, shape, !site.paths.empty());
  if (!has_room && shape != bicycle()) shape = car();
  bool const is_heavy = shape == truck() || shape == bus(), cycles = shape == bicycle();
  double const limit = site.map->lane(source.lane).speed_limit_at(0.0);
  auto const driver = cycles ? draw_cyclist() : draw_driver(limit, is_heavy, !site.has_conflicts, random);
  return {.speed = std::min(driver.law.desired_speed, limit),
          .shape = shape,
          .behavior = driver,
          .route = route,
          .dynamics = cycles ? cb::presets::bicycle_dynamics() : cb::SingleTrack{}};
}

/// What the file of parameters says of a driver.
inline void set_parameters(Sim::AgentSpec& spec, examples::ParameterFile const& file) {
  std::visit([&](auto& driver) { file.set(driver); }, spec.behavior);
}

/// Checks the file's parameters; prints them if that is asked for, and returns whether.
[[nodiscard]] inline bool take_parameters(examples::ParameterFile& file) {
  cb::RandomStream random(1, 0, 0);
  for (int draw = 0; draw < 50; ++draw) {
    bool const is_heavy = draw % 2 == 0, is_motorway = draw % 3 != 0;
    auto driver =
        draw % 5 == 0 ? draw_cyclist() : draw_driver(is_motorway ? 30.0 : 14.0, is_heavy, is_motorway, random);
    auto walker = draw_walker(random);
    file.take(driver);
    file.take(walker);
  }
  return file.finish();
}

/// Phases of 20 s for each of the map's lights in turn: 15 s green, 3 s yellow, and 2 s to clear the junction.
[[nodiscard]] inline cb::map::LightPlan light_plan(std::size_t number, std::size_t count) {
  double const begin = 20.0 * static_cast<double>(number);
  return {.cycle = 20.0 * static_cast<double>(count), .green_begin = begin, .green_end = begin + 15.0};
}

}  // namespace soak
