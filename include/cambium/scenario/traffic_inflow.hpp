#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cambium/behavior/view.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/one_of.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/random.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/route.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

/// A place where traffic comes into the map, and how much of it.
struct TrafficSource {
  static constexpr double saturated = std::numeric_limits<double>::infinity();

  LaneId lane = none<LaneId>;  ///< vehicles enter at its begin
  std::shared_ptr<map::RoadCorridor const>
      way{};                    ///< instead of a lane: where pedestrians walk (`build_free_corridor`)
  double per_hour = saturated;  ///< demand, with exponential headways; `saturated`: as many as there is room for
};

/// The lanes where traffic can enter a map, saturated: drivable ones outside of junctions that continue no other lane,
/// are at least 2.5 m wide at their begin, and lead on for 30 m. Empty on a closed map. O(lanes).
[[nodiscard]] std::vector<TrafficSource> find_sources(Map const& map);

/// A random route that begins in lane `from`. It ends where the map ends or after `longest` [m] outside of junctions;
/// if 20 draws came round, before it does, where nobody crosses or merges. Throws `WorldError` if the map has no such
/// lane. O(lanes of the routes).
[[nodiscard]] map::Route random_route(Map const& map, LaneId from, RandomStream& random, double longest = 400.0);

/// Whether a vehicle of `shape` on the route stays out of the lanes beside it, outside of junctions. Traffic in those
/// lanes does not look out for a vehicle that swings into them in a bend. O(segments of the lanes).
[[nodiscard]] bool fits_route(Map const& map, map::Route const& route, geometry::Shape const& shape);

/// How vehicles enter.
struct InflowRules {
  double headway = 1.5;
  double minimum_gap = 2.0;
  double deceleration = 1.5;
  double lateral_acceleration = 2.5;

  static constexpr char const* name = "inflow_rules";
  static constexpr auto parameters() {
    using P = InflowRules;
    return parameter_list(
        parameter("headway", &P::headway, "s", Range{0, 60}, "time gap to the next vehicle, ahead and behind"),
        parameter("minimum_gap", &P::minimum_gap, "m", Range{0.1, 100}, "gap to a vehicle that stands"),
        parameter("deceleration", &P::deceleration, "m/s^2", Range{0.1, 20},
                  "suffices to stop behind the next vehicle, and before a junction, line or zone of conflict"),
        parameter("lateral_acceleration", &P::lateral_acceleration, "m/s^2", Range{0.1, 50}, "highest in bends ahead"));
  }

  /// Highest speed [m/s] at `gap` [m] behind a vehicle of speed `leader` [m/s] from which one stops behind it after a
  /// reaction time of `headway`, where both brake by `deceleration`: the safe speed of Krauss 1998. Negative if the gap
  /// is below `minimum_gap`.
  [[nodiscard]] double safe_speed(double gap, double leader) const {
    double const room = gap - minimum_gap, lag = deceleration * headway;
    return room < 0.0 ? -1.0 : std::sqrt(lag * lag + 2.0 * deceleration * room + leader * leader) - lag;
  }
};

namespace detail {

/// Highest speed [m/s] at place `s` [m] of a corridor from which a vehicle can obey the speed limit and take the bends
/// ahead, and stop before signals and zones of conflict; negative where it is in one already.
[[nodiscard]] double entering_speed(Map const& map, map::LaneCorridor const& corridor, double s,
                                    geometry::Shape const& shape, InflowRules const& rules);

/// Throws `WorldError` if a source has no place or no demand.
void check_sources(Map const& map, std::vector<TrafficSource> const& sources);

}  // namespace detail

/// Traffic without end: lets agents enter a world at its sources as soon as there is room, at a speed from which no
/// vehicle has to brake hard, and removes agents that have left traffic.
///
///   source  [##] ---> | gap >= minimum_gap + headway v | [##] ---> ... ---> sink: the end of the route
///
/// Between two steps of the world call `enter`, which asks for the next agent, and `leave`. An agent without room
/// waits, and so do the agents behind it. The same seed lets the same agents enter at the same times. It is described,
/// so a snapshot can hold who waits, and what is drawn next; it is restored into one with the same sources.
template <class WorldType>
class TrafficInflow {
 public:
  using AgentSpec = typename WorldType::AgentSpec;

  /// An agent that has entered, and at which of the sources.
  struct Entered {
    AgentId id = none<AgentId>;
    std::size_t source{};
  };

  /// An agent that has left traffic: why, and in which lane.
  struct Left {
    AgentId id = none<AgentId>;
    AgentStatus status = AgentStatus::arrived;
    LaneId lane = none<LaneId>;  ///< none on a free corridor
  };

  /// Throws `WorldError` if a source has no lane of the map and no way, or no demand, and `ParameterError` for `rules`.
  TrafficInflow(Map const& map, std::vector<TrafficSource> sources, std::uint64_t seed, InflowRules const& rules = {})
      : sources_(std::move(sources)), rules_(rules), queues_(sources_.size()) {
    check_parameters(rules_);
    detail::check_sources(map, sources_);
    for (std::size_t i = 0; i < sources_.size(); ++i)
      queues_[i] = {sources_[i].lane, way_of(sources_[i]), sources_[i].per_hour,
                    RandomStream(seed, static_cast<std::uint32_t>(i), 0, purpose)};
  }

  /// Number of agents that have arrived at a source and wait for room. At a saturated source at most 1.
  [[nodiscard]] std::uint64_t waiting(std::size_t source) const { return queues_[source].waiting; }

  /// Lets at most one agent enter at each source. `draw(source, random)` returns the `AgentSpec` of the next one: its
  /// shape, behaviour and route, and the speed at which it likes to enter; place and heading are set here. Returns who
  /// has entered; valid until the next call. Throws what `draw` and `World::add` throw. O(sources * agents).
  template <class Draw>
  std::vector<Entered> const& enter(WorldType& world, Draw const& draw) {
    entered_.clear();
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      auto& queue = queues_[i];
      arrive(queue, world.time());
      if (queue.waiting == 0) continue;
      if (!queue.next) queue.next = draw(sources_[i], queue.random);
      auto const id = try_to_enter(world, sources_[i], *queue.next);
      if (!is_valid(id)) continue;
      entered_.push_back({id, i});
      queue.next.reset();
      --queue.waiting;
    }
    return entered_;
  }

  /// Takes those away that have left traffic; returns who they were, valid until the next call. O(agents).
  std::vector<Left> const& leave(WorldType& world) {
    left_.clear();
    for (Slot slot{}; index_of(slot) < world.size(); ++slot) {
      auto const& record = world.frame().agents[slot];
      if (record.status == AgentStatus::driving || record.status == AgentStatus::not_started) continue;
      auto const& agent = world.roster().agents[slot];
      left_.push_back(
          {agent.id, record.status, agent.road->corridors[record.lane.corridor].lane_at(record.lane.s).lane});
    }
    if (!left_.empty()) world.remove_departed();
    return left_;
  }

  static constexpr char const* name = "inflow";
  static constexpr auto parameters() {
    using P = TrafficInflow;
    static_assert(detail::DescribedModel<typename WorldType::Execution> &&
                      detail::DescribedModel<typename WorldType::Dynamics> &&
                      detail::DescribedModel<typename WorldType::Observer>,
                  "cambium: a snapshot of a TrafficInflow holds the next agents; let the world's executions, vehicle "
                  "models and observers describe their parameters, see Described");
    return parameter_list(parameter("rules", &P::rules_, "how agents enter"),
                          parameter("queues", &P::queues_, "at the sources"));
  }

  /// Throws `ParameterError` if the queues are those of other sources.
  void check(std::string const& where) const {
    auto const is_of = [](Queue const& queue, TrafficSource const& source) {
      return queue.lane == source.lane && queue.way == way_of(source) && queue.per_hour == source.per_hour;
    };
    if (!std::equal(queues_.begin(), queues_.end(), sources_.begin(), sources_.end(), is_of))
      throw ParameterError(where, "the inflow was saved with other sources",
                           "restore it into one with the same lanes, ways and demands, in the same order");
  }

 private:
  static constexpr std::uint32_t purpose = 0x696e666c;
  static constexpr double behind_begin = 0.5;  ///< of a lane: where the rear ends of those that enter are [m]

  [[nodiscard]] static std::vector<geometry::Point> way_of(TrafficSource const& source) {
    return source.way ? source.way->way : std::vector<geometry::Point>();
  }

  struct Queue {
    LaneId lane = none<LaneId>;  ///< of its source, as are the next two
    std::vector<geometry::Point> way{};
    double per_hour = TrafficSource::saturated;
    RandomStream random{0, 0, 0};
    double arrival = -1.0;  ///< of the next agent [s]; negative: not drawn yet
    std::uint64_t waiting = 0;
    std::optional<AgentSpec> next{};  ///< the first that waits

    static constexpr char const* name = "queue";
    static constexpr auto parameters() {
      using P = Queue;
      return parameter_list(parameter("lane", &P::lane, "of its source"),
                            parameter("way", &P::way, "m", any_finite, "of its source"),
                            parameter("per_hour", &P::per_hour, "1/h", Range{positive.low, TrafficSource::saturated},
                                      "demand; inf: saturated"),
                            parameter("random", &P::random, "for arrivals and agents"),
                            parameter("arrival", &P::arrival, "s", any_finite, "of the next agent"),
                            parameter("waiting", &P::waiting, "-", Range{0, 1e9}, "agents without room"),
                            parameter("next", &P::next, "the first of them"));
    }
  };

  static void arrive(Queue& queue, double time) {
    if (queue.per_hour == TrafficSource::saturated) {
      queue.waiting = 1;
      return;
    }
    auto const headway = [&] { return -3600.0 / queue.per_hour * portable::log(1.0 - uniform01(queue.random)); };
    if (queue.arrival < 0.0) queue.arrival = time + headway();
    for (; queue.arrival <= time; queue.arrival += headway()) ++queue.waiting;
  }

  /// The agent's id if it has entered, else none. Places it in any case.
  [[nodiscard]] AgentId try_to_enter(WorldType& world, TrafficSource const& source, AgentSpec& spec) const {
    auto const& path = source.way ? source.way->corridors[source.way->main].center : world.map().lane(source.lane).path;
    auto const pose = path.pose(behind_begin + spec.shape.rear);
    spec.position = pose.position();
    spec.heading = pose.heading;
    spec.road = source.way;
    if (is_occupied(world, pose, spec.shape)) return none<AgentId>;
    auto const id = world.add(spec);
    if (auto const speed = speed_of(world, id); speed >= 0.0) {
      auto state = world.state(id);
      state.speed = speed;
      world.set_state(id, state);
      return id;
    }
    world.remove(id);
    return none<AgentId>;
  }

  /// Whether somebody is at the place or less than the smallest gap ahead of it, or changes lanes towards it. Quick: it
  /// spares most attempts.
  [[nodiscard]] bool is_occupied(WorldType const& world, geometry::Pose const& pose,
                                 geometry::Shape const& shape) const {
    constexpr double near = 10.0, lane_width = 5.0;  // [m]
    constexpr double least_turn = 0.005;             // [rad] towards this lane: one has begun to change into it
    auto const along = portable::sin_cos(pose.heading);
    double const half = 0.5 * rules_.minimum_gap;
    auto box = geometry::box_of(shape, pose);
    box.x += half * along.cos;
    box.y += half * along.sin;
    box.half_length += half;
    box.half_width += 0.2;
    double const reach = box.half_length + near;
    for (Slot slot{}; index_of(slot) < world.size(); ++slot) {
      if (!in_traffic(world, slot)) continue;
      auto const circle = detail::circle_of(world, slot);
      double const x = circle.x - box.x, y = circle.y - box.y;
      if (std::abs(x) > reach + circle.radius || std::abs(y) > reach + circle.radius) continue;
      if (geometry::intersects(box, box_at(world, slot))) return true;
      auto const& agent = world.frame().agents[slot];
      double const aside = y * along.cos - x * along.sin;
      if (std::abs(aside) < lane_width && portable::cos(agent.state.heading - pose.heading) > 0.0 &&
          agent.lane.heading_error * aside < -least_turn * std::abs(aside))
        return true;
    }
    return false;
  }

  /// The speed at which an agent that has just been added can go on, at most the one it has; negative if it cannot.
  [[nodiscard]] double speed_of(WorldType& world, AgentId id) const {
    auto const view = world.observe(id);
    double speed = std::min(view.state().speed,
                            detail::entering_speed(world.map(), view.corridor(), view.place().s, view.shape(), rules_));
    bool has_room = speed >= 0.0;
    double const liked = speed;
    view.each_ahead({}, [&](RoadUser const& next) {
      double const leader = std::max(0.0, next.speed), safe = rules_.safe_speed(next.gap, leader);
      has_room = has_room && safe >= std::min(liked, leader);
      speed = std::min(speed, safe);
    });
    if (!has_room || speed < 0.0) return -1.0;
    if (auto const rear = view.behind())
      if (rules_.safe_speed(rear->gap, speed) < rear->speed) return -1.0;
    return speed;
  }

  std::vector<TrafficSource> sources_;
  InflowRules rules_;
  std::vector<Queue> queues_;
  std::vector<Entered> entered_;
  std::vector<Left> left_;
};

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/scenario/traffic_inflow_impl.hpp"
#endif
