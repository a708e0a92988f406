#include "junction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cambium/core/portable_math.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/opendrive.hpp"

namespace field {
namespace {

/// Position of the first lane in a junction among those of a route.
std::size_t first_in_junction(cb::Map const& map, cb::map::Route const& route) {
  auto const at = std::find_if(route.lanes.begin(), route.lanes.end(), [&](auto id) { return map.in_junction(id); });
  return static_cast<std::size_t>(at - route.lanes.begin());
}

/// Where the lane begins on the route's corridor [m].
double begin_of(cb::Map const& map, cb::map::Route const& route, cb::LaneId lane) {
  auto const road = build_road_corridor(map, route);
  return road->corridors[road->main].position_of({lane, 0.0}).value();
}

}  // namespace

People town_people(double truck_share) {
  return {.cars = cb::presets::town_cars(), .trucks = cb::presets::town_trucks(), .truck_share = truck_share};
}

std::shared_ptr<cb::Map const> crossing(std::array<char const*, 4> const& signs, double limit) {
  using namespace cb::map;
  constexpr double distance = 12.0;  // [m] from the middle to where the arms end
  constexpr auto end = opendrive::ContactPoint::end;
  MapBuilder builder("crossing");
  for (std::size_t i = 0; i < 4; ++i) {
    double const angle = 0.5 * cb::geometry::pi * static_cast<double>(i), length = i % 2 == 0 ? 200.0 : 100.0;
    auto const along = cb::portable::sin_cos(angle);
    RoadPlan arm{.id = std::to_string(i + 1),
                 .line = lay_to({distance * along.cos, distance * along.sin, angle + cb::geometry::pi}, {{length}}),
                 .type = "town",
                 .speed_limit = limit};
    arm.sections = {{.left = equal_lanes(1), .right = equal_lanes(1)}};
    builder.add_road(std::move(arm));
    opendrive::Signal sign;
    sign.id = std::to_string(i + 1);
    sign.s = length;
    sign.orientation = opendrive::Orientation::along;
    sign.type = signs[i];
    sign.rest.attributes = {{"t", "-5"}, {"dynamic", sign.type == light ? "yes" : "no"}, {"country", "OpenDRIVE"}};
    builder.road(sign.id).signals.push_back(std::move(sign));
  }
  builder.add_junction("100", "crossing");
  for (char from = '1'; from <= '4'; ++from)
    for (char to = '1'; to <= '4'; ++to)
      if (from != to)
        builder.add_turn("100", {std::string(1, from), end}, {std::string(1, to), end},
                         {.id = {from, to}, .speed_limit = limit});
  return builder.build();
}

std::shared_ptr<cb::Map const> roundabout() {
  return cb::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/roundabout.xodr").map;
}

cb::map::Route route_through(cb::Map const& map, std::vector<std::string> const& roads) {
  cb::map::Route route;
  auto const take = [&](cb::LaneId id) {
    route.lanes.push_back(id);
    route.length += map.lane(id).length();
  };
  for (auto const& source : cb::find_sources(map))
    if (map.road(map.lane(source.lane).road).name == roads.front()) take(source.lane);
  for (std::size_t i = 0; !route.lanes.empty();) {
    auto const& next = map.lane(route.lanes.back()).successors;
    auto const leads_to = [&](std::string const& road) {
      return std::find_if(next.begin(), next.end(), [&](cb::LaneId id) {
        return map.lane(id).drivable() && map.road(map.lane(id).road).name == road;
      });
    };
    auto at = leads_to(roads[i]);
    if (at == next.end() && i + 1 < roads.size()) at = leads_to(roads[++i]);
    if (at == next.end()) break;
    take(*at);
  }
  if (route.lanes.empty() || map.road(map.lane(route.lanes.back()).road).name != roads.back())
    throw cb::Error("road " + roads.back(), "no lane leads to it through the roads before it",
                    "name each road between");
  return route;
}

Junction::Junction(std::shared_ptr<cb::Map const> map, People people, std::uint64_t seed, std::vector<Stream> streams)
    : world_(map, {.seed = seed}),
      people_(std::move(people)),
      ways_([&] {
        std::vector<Way> ways;
        for (auto const& stream : streams) {
          auto const route = route_through(*map, stream.roads);
          ways.push_back({route, {begin_of(*map, route, route.lanes[first_in_junction(*map, route)])}});
        }
        return ways;
      }()),
      inflow_(*map,
              [&] {
                std::vector<cb::TrafficSource> sources;
                for (std::size_t i = 0; i < streams.size(); ++i)
                  sources.push_back({.lane = ways_[i].route.lanes.front(), .per_hour = streams[i].per_hour});
                return sources;
              }(),
              seed, {.headway = 1.0, .deceleration = 2.0}),
      entered_(ways_.size()) {
  auto const road = build_road_corridor(*map, ways_[0].route);
  for (std::size_t i = 1; i < ways_.size(); ++i) {
    auto const& lanes = ways_[i].route.lanes;
    auto const& conflicts = road->corridors[road->main].conflicts;
    auto const conflict = std::find_if(conflicts.begin(), conflicts.end(), [&](cb::map::Conflict const& c) {
      return !c.zones[0][0].empty() && std::find(lanes.begin(), lanes.end(), c.other) != lanes.end();
    });
    if (conflict == conflicts.end()) continue;
    auto const& zone = conflict->zones[0][0];
    rivals_.push_back(i);
    ways_[0].meets.push_back({zone.begin});
    ways_[i].meets.push_back({begin_of(*map, ways_[i].route, conflict->other) + zone.other_begin});
  }
}

void Junction::drive(double duration) {
  for (double const end = world_.time() + duration - 0.5 * dt; world_.time() < end;) {
    auto const draw = [&](cb::TrafficSource const& source, cb::RandomStream& random) {
      auto spec = people_.draw(random);
      spec.route = std::find_if(ways_.begin(), ways_.end(), [&](Way const& way) {
                     return way.route.lanes.front() == source.lane;
                   })->route;
      return spec;
    };
    for (auto const& entered : inflow_.enter(world_, draw))
      seen_[entered.id] = {entered.source, entered_[entered.source]++, world_.record(entered.id).lane.s};
    if (!world_.step(dt)) throw cb::Error("a step of the simulation", "failed", "report this as a bug");
    look();
    for (auto const& left : inflow_.leave(world_)) seen_.erase(left.id);
  }
}

void Junction::look() {
  constexpr double overhang = 0.9;  // [m] of the front end before the wheels
  for (cb::Slot slot{}; index_of(slot) < world_.size(); ++slot) {
    auto const& agent = world_.roster().agents[slot];
    auto const& record = world_.frame().agents[slot];
    auto& before = seen_.at(agent.id);
    auto& way = ways_[before.way];
    double const s = record.lane.s, speed = record.state.speed;
    auto const pass = [&](Detector& detector, double place) {
      if (before.s < place && s >= place) detector.times.push_back(world_.time() - (s - place) / std::max(0.5, speed));
    };
    double const stop = way.line.place - agent.shape.front;
    bool const is_first = before.way == 0 && way.line.times.size() == before.number;
    if (is_first && became_first_.size() == before.number && (speed < 0.5 || stop - s < 3.0))
      became_first_.push_back(world_.time());
    pass(way.line, stop + overhang);
    for (auto& detector : way.meets) pass(detector, detector.place);
    before.s = s;
  }
}

std::vector<Junction::Rivalry> Junction::rivalries() const {
  std::vector<Rivalry> all;
  for (std::size_t i = 0; i < rivals_.size(); ++i)
    all.push_back({rivals_[i], ways_[0].meets[i].times, ways_[rivals_[i]].meets.front().times});
  return all;
}

namespace {

/// The gap into which vehicle `number` of stream 0 went: when the last rival before it and the first behind it passed.
std::pair<double, double> gap_of(std::vector<Junction::Rivalry> const& rivalries, std::size_t number) {
  double begin = -std::numeric_limits<double>::infinity(), end = -begin;
  for (auto const& [stream, own, others] : rivalries) {
    auto const next = std::upper_bound(others.begin(), others.end(), own[number]);
    if (next != others.begin()) begin = std::max(begin, *(next - 1));
    if (next != others.end()) end = std::min(end, *next);
  }
  return {begin, end};
}

/// How many vehicles of stream 0 have met all rivals.
std::size_t crossed(std::vector<Junction::Rivalry> const& rivalries) {
  std::size_t count = std::numeric_limits<std::size_t>::max();
  for (auto const& rivalry : rivalries) count = std::min(count, rivalry.own.size());
  return rivalries.empty() ? 0 : count;
}

}  // namespace

std::vector<Decision> decisions(Junction const& junction) {
  auto const rivalries = junction.rivalries();
  std::vector<double> passages;
  for (auto const& rivalry : rivalries) passages.insert(passages.end(), rivalry.others.begin(), rivalry.others.end());
  std::sort(passages.begin(), passages.end());
  std::vector<Decision> found;
  for (std::size_t i = 0; i < crossed(rivalries); ++i) {
    auto const [begin, end] = gap_of(rivalries, i);
    if (begin < junction.became_first()[i] || !std::isfinite(end)) continue;
    Decision decision{0.0, end - begin};
    auto at = std::lower_bound(passages.begin(), passages.end(), junction.became_first()[i]);
    for (; at + 1 != passages.end() && *(at + 1) <= begin; ++at)
      decision.rejected = std::max(decision.rejected, *(at + 1) - *at);
    found.push_back(decision);
  }
  return found;
}

std::vector<double> follow_ups(Junction const& junction) {
  auto const rivalries = junction.rivalries();
  std::vector<double> found;
  for (std::size_t i = 1; i < crossed(rivalries); ++i)
    if (gap_of(rivalries, i) == gap_of(rivalries, i - 1))
      found.push_back(junction.at_line(0)[i] - junction.at_line(0)[i - 1]);
  return found;
}

}  // namespace field
