#include "road.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <variant>

#include "cambium/map/building/make_roads.hpp"
#include "cambium/map/building/map_builder.hpp"

namespace field {

namespace {

template <class Behavior>
Sim::AgentSpec draw_as(Behavior const& behavior, People const& people, cb::RandomStream& random) {
  bool const is_truck = cb::uniform01(random) < people.truck_share;
  auto const one = (is_truck ? people.trucks : people.cars).draw(random);
  return {.speed = one.idm.desired_speed,
          .shape = is_truck ? cb::geometry::truck() : cb::geometry::car(),
          .behavior = one.of(behavior)};
}

}  // namespace

Sim::AgentSpec People::draw(cb::RandomStream& random) const { return draw_as(Driver{}, *this, random); }

Sim::AgentSpec People::draw_erring(cb::RandomStream& random) const {
  // It looks away from the road for 17 % of the time; 5 % of these glances last longer than 2 s.
  return draw_as(Human{.attentive = 3.2, .looks_away = 0.65}, *this, random);
}

std::shared_ptr<cb::Map const> straight_road(double length, std::size_t lanes, double limit, double drop) {
  using namespace cb::map;
  RoadPlan road{.id = "1", .line = lay_from({}, {{length}}), .type = "motorway"};
  if (std::isfinite(limit)) road.speed_limit = limit;
  road.sections = {{0.0, {}, equal_lanes(lanes, 3.75)}};
  if (drop > 0.0) {
    constexpr double taper = 100.0;  // [m]
    road.sections.push_back({drop - taper, {}, equal_lanes(lanes, 3.75)});
    road.sections.push_back({drop, {}, equal_lanes(lanes - 1, 3.75)});
    road.sections[1].right.back().end_width = 0.0;
  }
  MapBuilder builder("straight road");
  builder.add_road(std::move(road));
  return builder.build();
}

Observed::Observed(std::shared_ptr<cb::Map const> map, People people, double per_hour, std::uint64_t seed,
                   double detector)
    : world_(map, {.seed = seed}),
      people_(std::move(people)),
      inflow_(*map,
              [&] {
                auto sources = cb::find_sources(*map);
                for (auto& source : sources) source.per_hour = per_hour;
                return sources;
              }(),
              seed, {.headway = 0.8, .deceleration = 2.0}),
      detector_(detector),
      lanes_(cb::find_sources(*map).size()) {
  cb::RandomStream random(seed, 0, 0);
  for (auto const& source : cb::find_sources(*map))
    routes_[source.lane] = cb::random_route(*map, source.lane, random, std::numeric_limits<double>::infinity());
}

void Observed::drive(double duration) {
  for (double const end = world_.time() + duration - 0.5 * dt; world_.time() < end;) {
    inflow_.enter(world_, [&](cb::TrafficSource const& source, cb::RandomStream& random) {
      auto spec = people_.draw(random);
      spec.route = routes_[source.lane];
      return spec;
    });
    if (!world_.step(dt)) throw cb::Error("a step of the simulation", "failed", "report this as a bug");
    look();
    for (auto const& left : inflow_.leave(world_)) seen_.erase(left.id);
  }
}

void Observed::clear() {
  passages_.clear();
  durations_.clear();
  kilometres_ = 0.0;
  lane_changes_ = 0;
}

void Observed::look() {
  constexpr double aside = 0.03;  // [m] from its lane's middle: a lane change has begun, or not ended yet
  for (cb::Slot slot{}; index_of(slot) < world_.size(); ++slot) {
    auto const& agent = world_.roster().agents[slot];
    auto const& record = world_.frame().agents[slot];
    double const front = record.state.x + agent.shape.front, speed = record.state.speed;
    auto const [known, is_new] = seen_.try_emplace(agent.id, Seen{front, -1.0, record.lane.corridor});
    if (is_new) continue;
    auto& before = known->second;
    kilometres_ += (front - before.front) / 1000.0;
    if (before.front < detector_ && front >= detector_)
      passages_.push_back({world_.time() - (front - detector_) / std::max(0.1, speed), speed,
                           static_cast<int>(record.state.y / -3.75), agent.shape == cb::geometry::car()});
    bool const is_aside = std::abs(record.lane.lateral) > aside, changed = record.lane.corridor != before.lane;
    lane_changes_ += changed;
    before.crossed = before.crossed || changed;
    if (is_aside && before.change_began < 0.0) before.change_began = world_.time();
    if (!is_aside) {
      if (before.change_began >= 0.0 && before.crossed) durations_.push_back(world_.time() - before.change_began);
      before.change_began = -1.0;
      before.crossed = false;
    }
    before.front = front;
    before.lane = record.lane.corridor;
  }
}

Moments moments(std::vector<double> const& values) {
  double const n = static_cast<double>(values.size()), mean = std::reduce(values.begin(), values.end()) / n;
  double const squares = std::transform_reduce(values.begin(), values.end(), 0.0, std::plus<>{},
                                               [&](double x) { return (x - mean) * (x - mean); });
  return {mean, std::sqrt(squares / n)};
}

std::vector<double> follower_headways(std::vector<Passage> const& passages, double longest) {
  constexpr double most = 2.0;  // [m/s]
  std::vector<double> found;
  std::array<std::optional<Passage>, 8> last{};
  for (auto const& passage : passages) {
    auto& before = last.at(static_cast<std::size_t>(passage.lane));
    if (before && passage.time - before->time < longest && std::abs(passage.speed - before->speed) < most)
      found.push_back(passage.time - before->time);
    before = passage;
  }
  return found;
}

double space_mean_speed(std::vector<Passage> const& passages) {
  double slowness = 0.0;
  for (auto const& passage : passages) slowness += 1.0 / std::max(0.1, passage.speed);
  return static_cast<double>(passages.size()) / slowness;
}

}  // namespace field
