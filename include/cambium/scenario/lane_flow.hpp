#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/behavior/presets.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/distribution.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/random.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/off_road.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/free_corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/scenario/lane_traffic.hpp"
#include "cambium/scenario/scenario.hpp"
#include "cambium/scenario/traffic_inflow.hpp"
#include "cambium/scenario/traffic_population.hpp"
#include "cambium/world/agent_spec.hpp"

namespace cambium::inline v0_1 {

/// A behaviour parameter drawn separately for each driver.
struct DrawnParameter {
  std::string key{};
  Distribution value{};

  static constexpr char const* name = "drawn_parameter";
  static constexpr auto parameters() {
    using P = DrawnParameter;
    return parameter_list(parameter("key", &P::key, "of the parameter, as idm.desired_speed"),
                          parameter("value", &P::value, "how it is drawn"));
  }
};

/// Drivers of one kind: what they drive, and how.
template <class World>
struct DriverShare {
  enum class Vehicle : std::uint8_t { any, car, van, truck, bus, bicycle, pedestrian };

  double share = 1.0;
  Vehicle vehicle = Vehicle::any;
  typename World::Behavior behavior{};
  std::vector<DrawnParameter> drawn{};
  typename World::Observer observer{};
  bool people = false;

  static constexpr char const* name = "driver_share";
  static constexpr auto parameters() {
    using P = DriverShare;
    auto const who = parameter_list(
        parameter("share", &P::share, "-", non_negative, "of the drivers, relative to the others'"),
        choice("vehicle", &P::vehicle, "any|car|van|truck|bus|bicycle|pedestrian", "any: by the mix of the traffic"),
        parameter("behavior", &P::behavior, "of these drivers"),
        parameter("drawn", &P::drawn, "parameters of the behaviour that differ by driver"));
    auto const people = parameter_list(parameter("people", &P::people, "they are as the recipe's populations are"));
    return join_parameters(
        join_parameters(who, detail::if_described(parameter("observer", &P::observer, "how they see the others"))),
        people);
  }
};

/// Traffic from a source to a sink: where on the way, how dense, how fast, who drives, where to, and who is under test.
template <class World>
struct LaneFlow {
  enum class Ego : std::uint8_t { none, first, middle, last, random };
  enum class GoalOf : std::uint8_t { all, ego };

  LaneId from = none<LaneId>;
  LaneId to = none<LaneId>;
  std::optional<geometry::Point> from_point{}, to_point{};
  std::vector<geometry::Point> way{};
  LaneTraffic traffic{};
  std::vector<DriverShare<World>> drivers{};
  Goal goal{};
  GoalOf goal_of = GoalOf::all;
  Ego ego = Ego::none;
  double controlled_share = 0.0;

  static constexpr char const* name = "lane_flow";
  static constexpr auto parameters() {
    using P = LaneFlow;
    auto const where = parameter_list(
        parameter("from", &P::from, "source: the lane where the way begins"),
        parameter("to", &P::to, "sink: the lane where it ends; absent: it leads to the goal, else straight on"),
        parameter("from_point", &P::from_point, "m", {}, "instead of from: a point in the lane"),
        parameter("to_point", &P::to_point, "m", {}, "instead of to: a point in the lane"),
        parameter("way", &P::way, "m", any_finite,
                  "instead of from and to: points of a way that is no lane, as on foot"));
    auto const what = parameter_list(
        parameter("traffic", &P::traffic, "where on the way, speeds, gaps, vehicles"),
        parameter("drivers", &P::drivers, "drawn by their shares; without any: IDM drivers as drawn by traffic"),
        parameter("goal", &P::goal, "of the vehicles"), choice("goal_of", &P::goal_of, "all|ego", "who has the goal"),
        choice("ego", &P::ego, "none|first|middle|last|random", "which vehicle is the ego; the front one is the first"),
        parameter("controlled_share", &P::controlled_share, "-", Range{0, 1},
                  "share of the other vehicles that a benchmark drives, too"));
    return join_parameters(where, what);
  }
};

namespace detail {

[[nodiscard]] inline geometry::Shape shape_of(std::uint8_t vehicle, VehicleMix const& mix, RandomStream& random) {
  using namespace geometry;
  Shape const shapes[] = {car(), car(), van(), truck(), bus(), bicycle(), pedestrian()};
  return vehicle == 0 ? mix(random) : shapes[vehicle];
}

/// A flow and its way through the map.
template <class World>
struct FlowPlan {
  LaneFlow<World> flow;
  map::Route route{};
  std::shared_ptr<map::RoadCorridor const> road{};
  map::LaneCorridor const* lanes = nullptr;  ///< of the road, from the source on
  std::string where{};
};

/// The candidate lanes of an end of a flow, the most likely one first. Throws `ParameterError` if there is none.
[[nodiscard]] inline std::vector<LaneId> lanes_of(Map const& map, LaneId lane,
                                                  std::optional<geometry::Point> const& point, char const* name,
                                                  std::string const& where) {
  if (!point && is_valid(lane) && (index_of(lane) >= map.lanes().size() || !map.lane(lane).drivable()))
    throw ParameterError(where + "." + name, "there is no such lane for vehicles",
                         "examples/run map FILE lists the lanes");
  if (!point) return is_valid(lane) ? std::vector{lane} : std::vector<LaneId>{};
  if (is_valid(lane))
    throw ParameterError(where, std::string("has both ") + name + " and " + name + "_point", "leave out one of them");
  std::vector<LaneId> lanes;
  for (auto const& hit : map.lanes_near(*point, {.radius = 5.0, .only_drivable = true})) lanes.push_back(hit.lane);
  if (lanes.empty())
    throw ParameterError(where + "." + name + "_point", "no drivable lane is within 5 m of it",
                         "look at examples/run map FILE --picture");
  return lanes;
}

/// Plans a way off the lanes. Throws `ParameterError` at `plan.where` if it has a source or sink beside it, or
/// if nobody would be on foot.
template <class World>
void plan_free_way(Map const& map, FlowPlan<World>& plan) {
  auto const& flow = plan.flow;
  if (is_valid(flow.from) || is_valid(flow.to) || flow.from_point || flow.to_point)
    throw ParameterError(plan.where, "has a way beside from or to", "leave out one of them");
  if (flow.drivers.empty())
    throw ParameterError(plan.where, "has a way, but no drivers",
                         "say who goes there, as {\"vehicle\": \"pedestrian\"}");
  try {
    plan.road = map::build_free_corridor(map, flow.way);
  } catch (MapError const& problem) {
    throw ParameterError(plan.where + ".way", problem.what());
  }
  plan.lanes = &plan.road->corridors.front();
}

/// Plans the way of a flow. Throws `ParameterError` at `plan.where` if there is none.
template <class World>
void plan_way(std::shared_ptr<Map const> const& map, FlowPlan<World>& plan) {
  auto const& flow = plan.flow;
  if (!flow.way.empty()) return plan_free_way(*map, plan);
  auto const sources = lanes_of(*map, flow.from, flow.from_point, "from", plan.where),
             sinks = lanes_of(*map, flow.to, flow.to_point, "to", plan.where);
  if (sources.empty())
    throw ParameterError(plan.where, "names no source", "give \"from\": \"road/section/lane\", or \"from_point\"");
  if (sinks.empty()) {
    // The way from the lane to the goal is that of an agent at its begin.
    World probe(map);
    auto const begin = map->lane(sources.front()).path.pose(0.0);
    typename World::AgentSpec spec{.position = begin.position(), .heading = begin.heading};
    if (flow.goal_of == LaneFlow<World>::GoalOf::all) spec.goal = flow.goal;
    auto const scout = probe.add(spec);
    spec.goal = flow.goal;
    static_cast<void>(probe.add(spec));  // throws if the goal cannot be reached
    plan.road = probe.roster().agents[probe.slot_of(scout)].road;
    plan.route = {.lanes = plan.road->route};
  }
  for (auto const from : sources)
    for (auto const to : sinks)
      if (auto route = plan.road ? std::nullopt : map->shortest_route(from, to)) {
        plan.route = std::move(*route);
        plan.road = map::build_road_corridor(*map, plan.route);
      }
  if (!plan.road)
    throw ParameterError(plan.where, "no way leads from its source to its sink",
                         "examples/run map FILE --reachable lists where one gets");
  // With lane changes on the way, the main corridor is beside the source.
  auto const& all = plan.road->corridors;
  auto const begins_at_source = [&](map::LaneCorridor const& one) {
    return one.lane_at(0.0).lane == plan.route.lanes.front();
  };
  auto const own = std::find_if(all.begin(), all.end(), begins_at_source);
  plan.lanes = own != all.end() ? &*own : &all[plan.road->main];
}

/// Checks that drawn parameters exist, and are in their ranges whatever is drawn.
template <class World>
void check_drawn(LaneFlow<World> const& flow, std::string const& where) {
  for (std::size_t d = 0; d < flow.drivers.size(); ++d)
    for (std::size_t i = 0; i < flow.drivers[d].drawn.size(); ++i) {
      auto const& drawn = flow.drivers[d].drawn[i];
      auto const place = where + ".drivers[" + std::to_string(d) + "].drawn[" + std::to_string(i) + "]";
      for (double const bound : {drawn.value.lowest(), drawn.value.highest()}) {
        auto behavior = flow.drivers[d].behavior;
        std::visit([&](auto& model) { set_parameter(model, drawn.key, bound, place); }, behavior);
      }
    }
}

/// Whether a driver differs by population.
template <class World>
[[nodiscard]] bool is_person(DriverShare<World> const& driver) {
  return driver.people && driver.share > 0.0;
}

/// Checks that those who differ by population can do so.
template <class World>
void check_people(LaneFlow<World> const& flow, std::string const& where) {
  for (std::size_t d = 0; d < flow.drivers.size(); ++d) {
    auto const& driver = flow.drivers[d];
    bool const is_driver = std::visit([]<class Given>(Given const&) { return can_be_person<Given>; }, driver.behavior);
    if (driver.people && !is_driver)
      throw ParameterError(where + ".drivers[" + std::to_string(d) + "].people",
                           "is true, but the behaviour is no Driver, as mobil is one",
                           "leave it out, or take another behaviour");
  }
}

template <class World>
[[nodiscard]] std::vector<FlowPlan<World>> plan_flows(std::shared_ptr<Map const> const& map,
                                                      std::vector<LaneFlow<World>> const& flows,
                                                      std::string const& where) {
  std::vector<FlowPlan<World>> plans;
  bool has_ego = false;
  for (auto const& flow : flows) {
    FlowPlan<World> plan{.flow = flow, .where = where + ".flows[" + std::to_string(plans.size()) + "]"};
    if (flow.ego != LaneFlow<World>::Ego::none && std::exchange(has_ego, true))
      throw ParameterError(plan.where, "is the second flow with an ego", "let one flow have it");
    if (flow.drivers.empty() && !World::Behaviors::template contains<IdmClassic>)
      throw ParameterError(plan.where, "has no drivers, and the program's BehaviorSet no IdmClassic",
                           "give \"drivers\"");
    auto const has_share = [](DriverShare<World> const& driver) { return driver.share > 0.0; };
    if (!flow.drivers.empty() && std::none_of(flow.drivers.begin(), flow.drivers.end(), has_share))
      throw ParameterError(plan.where, "has only drivers whose share is 0", "give one of them a share");
    auto usual = flow.traffic;
    usual.desired_speed = LaneTraffic{}.desired_speed;
    if (!flow.drivers.empty() && !equal_parameters(usual, flow.traffic))
      throw ParameterError(plan.where + ".traffic.desired_speed", "is not for flows with drivers",
                           "give the speed to these, or draw it: {\"key\": \"desired_speed\", \"value\": ...}");
    check_drawn(flow, plan.where);
    check_people(flow, plan.where);
    plan_way(map, plan);
    auto& traffic = plan.flow.traffic;
    traffic.end = std::min(traffic.end, plan.lanes->length());
    if (!flow.drivers.empty()) traffic.desired_speed = Uniform{100.0, 100.0};  // these drivers are replaced
    plans.push_back(std::move(plan));
  }
  return plans;
}

/// Whether a vehicle that has just entered and its neighbours ahead and behind keep their headway and need not brake
/// hard, and whether it can stop before signals and zones of conflict ahead.
template <class World>
[[nodiscard]] bool has_room(World& world, AgentId id, InflowRules const& rules) {
  auto const slot = world.slot_of(id);
  bool const on_lanes = is_valid(world.roster().agents[slot].road->corridors.front().pieces.front().lane);
  if (Collision{}(world, slot) || (on_lanes && OffRoad{}(world, slot))) return false;
  auto const view = world.observe(id);
  double const speed = view.state().speed;
  auto const is_safe = [&](double gap, double follower, double leader) {
    return gap >= rules.minimum_gap + rules.headway * follower && follower <= rules.safe_speed(gap, leader);
  };
  if (auto const ahead = view.ahead(); ahead && !is_safe(ahead->gap, speed, ahead->speed)) return false;
  if (auto const behind = view.behind(); behind && !is_safe(behind->gap, behind->speed, speed)) return false;
  return speed <= entering_speed(world.map(), view.corridor(), view.place().s, view.shape(), rules);
}

/// The driver of a vehicle as its flow says.
template <class World>
[[nodiscard]] typename World::AgentSpec drawn_agent(FlowPlan<World> const& plan, LaneVehicle const& vehicle,
                                                    DriverShare<World> const* driver, RandomStream& random,
                                                    TrafficPopulation population, RandomStream& people) {
  auto const pose = plan.lanes->center.pose(vehicle.s);
  typename World::AgentSpec spec{.position = pose.position(),
                                 .heading = pose.heading,
                                 .speed = vehicle.speed,
                                 .shape = vehicle.shape,
                                 .way = plan.flow.way};
  if (spec.way.empty()) spec.route = plan.route;
  if (plan.flow.goal_of == LaneFlow<World>::GoalOf::all) spec.goal = plan.flow.goal;
  if constexpr (std::is_assignable_v<decltype(spec.dynamics)&, SingleTrack>)
    if (vehicle.shape == geometry::bicycle()) spec.dynamics = presets::bicycle_dynamics();
  if (driver != nullptr) {
    auto behavior = driver->behavior;
    for (auto const& drawn : driver->drawn)
      std::visit([&](auto& model) { set_parameter(model, drawn.key, drawn.value(random)); }, behavior);
    if (driver->people)
      behavior = std::visit([&](auto const& given) { return driver_of<World>(population, given, people, plan.where); },
                            behavior);
    spec.behavior = behavior;
    spec.observer = driver->observer;
  } else if constexpr (World::Behaviors::template contains<IdmClassic>) {
    spec.behavior = vehicle.driver;
  }
  return spec;
}

/// Adds the vehicles of a flow that have room to the world and the scenario. Returns their ids.
template <class World>
std::vector<AgentId> draw_flow(FlowPlan<World> const& plan, InflowRules const& rules, RandomStream& random,
                               TrafficPopulation population, RandomStream& people, World& world,
                               Scenario<World>& scenario) {
  auto const& flow = plan.flow;
  std::vector<double> shares;
  for (auto const& driver : flow.drivers) shares.push_back(driver.share);
  std::vector<DriverShare<World> const*> drivers;
  auto const vehicles = flow.traffic.sample(random, [&](RandomStream& stream) {
    drivers.push_back(shares.empty() ? nullptr : &flow.drivers[discrete_index(stream, shares)]);
    auto const vehicle =
        drivers.back() == nullptr ? std::uint8_t{0} : static_cast<std::uint8_t>(drivers.back()->vehicle);
    return shape_of(vehicle, flow.traffic.mix, stream);
  });
  std::vector<AgentId> entered;
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    auto spec = drawn_agent(plan, vehicles[i], drivers[i], random, population, people);
    auto const id = world.add(spec);
    if (!has_room(world, id, rules)) {
      world.remove(id);
      continue;
    }
    spec.id = id;
    scenario.agents.push_back(std::move(spec));
    entered.push_back(id);
    if (flow.controlled_share > 0.0 && uniform01(random) < flow.controlled_share) scenario.controlled.push_back(id);
  }
  return entered;
}

/// Makes one of these vehicles the ego as the flow says.
template <class World>
void choose_ego(LaneFlow<World> const& flow, std::vector<AgentId> const& entered, RandomStream& random,
                Scenario<World>& scenario) {
  if (flow.ego == LaneFlow<World>::Ego::none || entered.empty()) return;
  auto const any = uniform_index(random, static_cast<std::uint32_t>(entered.size()));
  std::size_t const chosen[] = {0, 0, entered.size() / 2, entered.size() - 1, any};
  scenario.ego = entered[chosen[static_cast<std::size_t>(flow.ego)]];
  std::erase(scenario.controlled, scenario.ego);
  if (flow.goal_of == LaneFlow<World>::GoalOf::ego)
    for (auto& agent : scenario.agents) {
      if (agent.id.given() != scenario.ego) continue;
      agent.goal = flow.goal;
      if (!is_valid(flow.to) && !flow.to_point) agent.route.reset();  // the ego finds its own way
    }
}

/// Scenario `number` of planned flows at `site`, a scenario without agents: the first of up to 100 draws in which
/// each flow with an ego gets one. Populations drive the same vehicles from the same places.
template <class World>
[[nodiscard]] Scenario<World> draw_flows(Scenario<World> const& site, std::vector<FlowPlan<World>> const& plans,
                                         InflowRules const& rules, TrafficPopulation population, std::uint32_t number,
                                         std::string const& where) {
  auto const empty = site.make_world();
  for (std::uint32_t attempt = 0; attempt < 100; ++attempt) {
    auto scenario = site;
    auto world = empty;
    RandomStream random(site.seed, number, attempt, 0x666c6f77), people(site.seed, number, attempt, 0x706f7075);
    bool is_complete = true;
    for (auto const& plan : plans) {
      auto const entered = draw_flow(plan, rules, random, population, people, world, scenario);
      choose_ego(plan.flow, entered, random, scenario);
      is_complete = is_complete && (plan.flow.ego == LaneFlow<World>::Ego::none || !entered.empty());
    }
    if (is_complete && !scenario.agents.empty()) return scenario;
  }
  throw ParameterError(where, "draws no vehicle, or none for the ego", "give longer or denser flows, or slower ones");
}

}  // namespace detail

}  // namespace cambium::inline v0_1
