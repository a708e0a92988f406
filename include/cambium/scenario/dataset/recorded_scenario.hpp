#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cambium/behavior/open_loop/static_trajectory.hpp"
#include "cambium/core/constants.hpp"
#include "cambium/core/diagnostic.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/route.hpp"
#include "cambium/scenario/dataset/recorded_traffic.hpp"
#include "cambium/scenario/scenario.hpp"

namespace cambium::inline v0_1 {

/// A part of a recording, by its times [s].
struct RecordingWindow {
  double begin = -std::numeric_limits<double>::infinity();
  double end = std::numeric_limits<double>::infinity();
  std::optional<std::int64_t> ego{};  ///< the track that it is about

  friend bool operator==(RecordingWindow const&, RecordingWindow const&) = default;
};

/// Windows of `length`, one every `every` seconds, in which at least `least` tracks move. Throws `ParameterError` for
/// times that are not above 0. O(windows * tracks).
[[nodiscard]] std::vector<RecordingWindow> windows_of(RecordedTraffic const& traffic, double length, double every,
                                                      std::size_t least = 1);

/// One window per track that moves, from its begin to its end: scenarios by ego.
[[nodiscard]] std::vector<RecordingWindow> ego_windows(RecordedTraffic const& traffic);

/// The way of a track over a map: along lanes, or, where it leaves them and on foot, along a free corridor.
struct TrackWay {
  std::optional<map::Route> route{};                ///< its lanes, and straight on for 100 m
  map::LaneStation end{};                           ///< where the track ends; only with a route
  std::shared_ptr<map::RoadCorridor const> road{};  ///< instead of a route
  std::vector<State> states{};                      ///< of the reference point, from where it is on the map
};

/// The way of `track` from `begin` to `end` [s]; its states are those recorded, and interpolated ones at both ends.
/// Vehicles and bicycles get a route, unless they are off the lanes for more than a few states between their first and
/// their last one there. Nothing where the track does not move there. Throws `Error` for a
/// track without such a way, as one that jumps by kilometres.
/// O(states log lanes).
[[nodiscard]] std::optional<TrackWay> way_of(Map const& map, Track const& track, double begin, double end);

/// A scenario from a recording: its time 0 is `begin` of the recording. Replays (`StaticTrajectory`) are all there from
/// the start and show up in traffic when their recording begins. An agent with a behaviour of its own that comes later
/// is added by `enter`: call it before each step.
template <class WorldType>
struct RecordedScenario {
  /// An agent that comes later: where its track is then, it enters.
  struct Entrant {
    double time{};  ///< of the world [s]
    typename WorldType::AgentSpec spec;
    StaticTrajectory recorded;  ///< in the world's time
  };

  Scenario<WorldType> scenario;
  std::vector<Entrant> later{};              ///< by time
  std::vector<geometry::Polygon> objects{};  ///< obstacles that stand
  double begin = 0.0, end = 0.0;             ///< of the recording [s]
  std::vector<Diagnostic> diagnostics{};     ///< tracks that could not take part, or not on lanes

  [[nodiscard]] double duration() const { return end - begin; }

  /// A world with the agents that are there at the start, and the objects. Throws as `Scenario::make_world`.
  [[nodiscard]] WorldType make_world() const {
    auto world = scenario.make_world();
    for (auto const& object : objects) world.add_object(object);
    return world;
  }

  /// Adds the agents of `later` whose time has come, except for the first `entered`, which are in the world already.
  /// Returns how many of them are in the world then. Throws what `World::add` throws.
  [[nodiscard]] std::size_t enter(WorldType& world, std::size_t entered) const {
    for (; entered < later.size() && later[entered].time <= world.time() + same_time; ++entered) {
      auto const& entrant = later[entered];
      auto spec = entrant.spec;
      auto const state = entrant.recorded.at(world.time());
      spec.position = {state.x, state.y};
      spec.heading = state.heading;
      spec.speed = std::max(0.0, state.speed);
      world.add(spec);
    }
    return entered;
  }
};

namespace detail {

/// The agent of a track: without its behaviour.
template <class WorldType>
[[nodiscard]] typename WorldType::AgentSpec recorded_agent(Track const& track, TrackWay const& way) {
  typename WorldType::AgentSpec spec;
  auto const& first = way.states.front();
  spec.position = {first.x, first.y};
  spec.heading = first.heading;
  spec.speed = std::max(0.0, first.speed);
  spec.shape = reference_shape(track);
  spec.route = way.route;
  spec.road = way.road;
  spec.id = static_cast<AgentId>(track.id);
  if (way.route) {
    spec.goal = ReachLane{way.end.lane, std::max(0.0, way.end.s - 1.0)};
  } else {
    spec.goal = ReachLaneEnd{1.0};
  }
  return spec;
}

/// Throws `Error` unless there is a map, a number of seconds, and ids that agents can have.
void require_replayable(RecordedTraffic const& traffic, RecordingWindow const& window);

[[nodiscard]] Diagnostic about_track(RecordedTraffic const& traffic, Track const& track, std::string sentence);

/// The light plans with the world's time 0 at `begin` of the recording.
[[nodiscard]] std::vector<map::LightPlan> lights_from(RecordedTraffic const& traffic, double begin);

[[nodiscard]] geometry::Polygon outline_of(Track const& track);

/// An id that no track has.
[[nodiscard]] AgentId unused_agent_id(RecordedTraffic const& traffic, std::int64_t wanted);

}  // namespace detail

/// The scenario of a window with the agents of its tracks. `behavior_of(track)` returns an
/// `std::optional<World::Behavior>`: the behaviour that replaces the driver of that track, from its recorded state on,
/// with the recorded route and the end of the track's lane as its goal; nothing: the track is replayed. Agents have the
/// ids of their tracks. Throws `Error` where the recording has no map, the window's ego is none of its tracks, or an id
/// is negative or beyond 32 bits. O(states log lanes).
template <class WorldType, class ToBehavior>
[[nodiscard]] RecordedScenario<WorldType> recorded_scenario(RecordedTraffic const& traffic,
                                                            RecordingWindow const& window,
                                                            ToBehavior const& behavior_of) {
  static_assert(WorldType::Behaviors::template contains<StaticTrajectory>,
                "cambium::recorded_scenario<World>: the world's cambium::BehaviorSet<Models...> must contain "
                "cambium::StaticTrajectory, which replays tracks");
  static_assert(
      std::is_convertible_v<decltype(behavior_of(std::declval<Track const&>())),
                            std::optional<typename WorldType::Behavior>>,
      "cambium::recorded_scenario<World>: behavior_of(track) must return std::optional<World::Behavior>, nothing for "
      "a track that is replayed");
  detail::require_replayable(traffic, window);
  RecordedScenario<WorldType> result;
  result.begin = std::isfinite(window.begin) ? window.begin : traffic.begin();
  result.end = std::isfinite(window.end) ? window.end : traffic.end();
  result.scenario.map = traffic.map;
  result.scenario.lights = detail::lights_from(traffic, result.begin);
  if (window.ego) result.scenario.ego = static_cast<AgentId>(*window.ego);
  for (auto const& track : traffic.tracks) {
    if (track.stands) {
      result.objects.push_back(detail::outline_of(track));
      continue;
    }
    auto way = way_of(*traffic.map, track, result.begin, result.end);
    if (!way) continue;
    if (!way->route && track.type != TrackType::pedestrian)
      result.diagnostics.push_back(
          detail::about_track(traffic, track, "it does not keep to the lanes; it got a way of its own"));
    for (auto& state : way->states) {
      state.time -= result.begin;
      state.speed = std::max(0.0, state.speed);
    }
    auto spec = detail::recorded_agent<WorldType>(track, *way);
    std::optional<typename WorldType::Behavior> const behavior = behavior_of(track);
    StaticTrajectory recorded(std::move(way->states));
    if (!behavior) {
      spec.behavior = recorded;
    } else {
      spec.behavior = *behavior;
      if (recorded.start_time() > 0.0) {
        result.later.push_back({recorded.start_time(), std::move(spec), std::move(recorded)});
        continue;
      }
    }
    result.scenario.agents.push_back(std::move(spec));
  }
  detail::stable_sort(result.later, [](auto const& entrant) { return entrant.time; });
  if (is_valid(result.scenario.ego) && std::none_of(result.scenario.agents.begin(), result.scenario.agents.end(),
                                                    [&](auto const& agent) { return agent.id == result.scenario.ego; }))
    result.scenario.ego = none<AgentId>;  // it comes later
  return result;
}

/// As above: all tracks are replayed.
template <class WorldType>
[[nodiscard]] RecordedScenario<WorldType> recorded_scenario(RecordedTraffic const& traffic,
                                                            RecordingWindow const& window = {}) {
  return recorded_scenario<WorldType>(
      traffic, window, [](Track const&) -> std::optional<typename WorldType::Behavior> { return std::nullopt; });
}

/// The scenario of a planning problem: an ego with `ego_behavior` and `shape` in its initial state, with its goal (see
/// `PlanningProblem::goal`; its times are for who judges), and the tracks as above. The ego's id is the problem's, or
/// the next one that no track has. Throws as above.
template <class WorldType, class ToBehavior>
[[nodiscard]] RecordedScenario<WorldType> problem_scenario(RecordedTraffic const& traffic,
                                                           PlanningProblem const& problem,
                                                           typename WorldType::Behavior const& ego_behavior,
                                                           ToBehavior const& behavior_of,
                                                           geometry::Shape const& shape = geometry::car()) {
  RecordingWindow window{.begin = problem.initial.time, .end = problem.initial.time};
  for (auto const& goal : problem.goals) window.end = std::max(window.end, goal.last_time);
  auto result = recorded_scenario<WorldType>(traffic, window, behavior_of);
  auto const start = reference_state(problem.initial, shape);
  result.scenario.ego = detail::unused_agent_id(traffic, problem.id);
  typename WorldType::AgentSpec spec;
  spec.position = {start.x, start.y};
  spec.heading = start.heading;
  spec.speed = std::max(0.0, start.speed);
  spec.shape = shape;
  spec.behavior = ego_behavior;
  spec.goal = problem.goal();
  spec.id = result.scenario.ego;
  result.scenario.agents.push_back(std::move(spec));
  return result;
}

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/scenario/dataset/recorded_scenario_impl.hpp"
#endif
