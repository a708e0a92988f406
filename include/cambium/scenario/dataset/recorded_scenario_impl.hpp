#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/constants.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/free_corridor.hpp"
#include "cambium/scenario/dataset/recorded_scenario.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// Finds the lanes that a track goes along.
class LaneMatcher {
 public:
  explicit LaneMatcher(Map const& map) : map_(map) {}

  /// Takes the next state; whether it is on a lane that runs its way.
  bool add(State const& state) {
    constexpr double aside = 2.0;  // [m] from the lane
    geometry::Pose const pose{state.x, state.y, state.heading};
    auto const hit = last_ ? map_.nearest_lane(pose, *last_, aside) : map_.nearest_lane(pose, aside);
    if (!hit) return false;
    double const along = map_.lane(hit->lane).path.pose(hit->s).heading;
    if (std::abs(geometry::angle_difference(state.heading, along)) > 0.5 * geometry::pi) return false;
    last_ = hit;
    if (lanes_.empty() || lanes_.back() != hit->lane) lanes_.push_back(hit->lane);
    return true;
  }

  [[nodiscard]] map::LaneStation end() const { return {last_->lane, last_->s}; }

  /// The lanes as a route; nothing where no way leads from one to the next.
  [[nodiscard]] std::optional<map::Route> route() const {
    map::Route route;
    auto& lanes = route.lanes;
    for (auto const id : lanes_) {
      auto const& lane = map_.lane(id);
      // Of lanes side by side only where the track came in counts, and where it went.
      while (lanes.size() > 1 && beside(lanes.back(), id) && beside(lanes[lanes.size() - 2], id)) lanes.pop_back();
      if (!lanes.empty() && lanes.back() == id) continue;
      // At a fork the wrong branch may seem nearer at first.
      if (lanes.size() > 1 && !follows(lanes.back(), id) && follows(lanes[lanes.size() - 2], id)) lanes.pop_back();
      if (!lanes.empty() && !follows(lanes.back(), id) && !add_way(lanes, id)) return std::nullopt;
      lanes.push_back(lane.id);
    }
    auto const ahead = map::straight_route(map_, lanes.back(), map_.lane(lanes.back()).length() + 100.0);
    for (std::size_t i = 1; i < ahead.lanes.size(); ++i) {
      if (std::find(lanes.begin(), lanes.end(), ahead.lanes[i]) != lanes.end()) break;
      lanes.push_back(ahead.lanes[i]);
    }
    for (std::size_t i = 0; i < lanes.size(); ++i)
      if (i + 1 == lanes.size() || !beside(lanes[i], lanes[i + 1])) route.length += map_.lane(lanes[i]).length();
    return route;
  }

 private:
  /// Whether the lanes lie side by side: in a section of a road, or as neighbours of one another, as lanelets do.
  [[nodiscard]] bool beside(LaneId a, LaneId b) const {
    auto const &one = map_.lane(a), &other = map_.lane(b);
    if (one.road == other.road && one.section == other.section) return one.along_road == other.along_road;
    for (auto const side : {&map::Lane::left_neighbor, &map::Lane::right_neighbor})
      for (auto at = one.*side; is_valid(at) && at != a; at = map_.lane(at).*side)
        if (at == b) return true;
    return false;
  }
  [[nodiscard]] bool follows(LaneId a, LaneId b) const {
    auto const& lane = map_.lane(a);
    return lane.left_neighbor == b || lane.right_neighbor == b ||
           std::find(lane.successors.begin(), lane.successors.end(), b) != lane.successors.end();
  }
  /// Adds the lanes between the last one and `to`.
  [[nodiscard]] bool add_way(std::vector<LaneId>& lanes, LaneId to) const {
    constexpr double longest = 200.0;  // [m]
    map::RouteOptions options;
    options.obey_lane_marks = false;
    auto const between = map_.shortest_route(lanes.back(), to, options);
    if (!between || between->lanes.size() < 2) return false;
    double skipped = 0.0;
    for (std::size_t i = 1; i + 1 < between->lanes.size(); ++i) {
      if (std::find(lanes.begin(), lanes.end(), between->lanes[i]) != lanes.end()) return false;
      skipped += map_.lane(between->lanes[i]).length();
    }
    if (skipped > longest) return false;
    lanes.insert(lanes.end(), between->lanes.begin() + 1, between->lanes.end() - 1);
    return true;
  }

  Map const& map_;
  std::optional<map::LaneHit> last_;
  std::vector<LaneId> lanes_;
};

/// The states of a track's reference point in a window, with interpolated ones at its ends.
[[nodiscard]] inline std::vector<State> states_between(Track const& track, double begin, double end) {
  std::vector<State> states;
  double const from = std::max(begin, track.begin()), to = std::min(end, track.end());
  if (!(from < to)) return states;
  auto const shape = reference_shape(track);
  states.push_back(reference_state(track.at(from), shape));
  for (auto const& state : track.states)
    if (state.time > from && state.time < to) states.push_back(reference_state(state, shape));
  states.push_back(reference_state(track.at(to), shape));
  return states;
}

/// The states with the headings of the motion before or, at the begin, behind them where they are at rest: those of a
/// table may be anything then. As they are where the track never moves.
[[nodiscard]] inline std::vector<State> headed_by_motion(std::vector<State> states) {
  auto const moves = [](State const& state) { return std::abs(state.speed) > 0.5; };  // [m/s]
  auto const first = std::find_if(states.begin(), states.end(), moves);
  if (first == states.end()) return states;
  double heading = first->heading;
  for (auto& state : states)
    if (moves(state))
      heading = state.heading;
    else
      state.heading = heading;
  return states;
}

/// A corridor along the states, for tracks that leave the lanes.
[[nodiscard]] inline std::shared_ptr<map::RoadCorridor const> own_way(Map const& map, Track const& track,
                                                                      std::span<State const> states) {
  constexpr double apart = 0.5, beyond = 2.0;  // [m]
  std::vector<geometry::Point> points;
  for (auto const& state : states)
    if (points.empty() || (geometry::Point{state.x, state.y} - points.back()).norm() >= apart)
      points.emplace_back(state.x, state.y);
  auto const& last = states.back();
  points.emplace_back(points.back().x() + beyond * portable::cos(last.heading),
                      points.back().y() + beyond * portable::sin(last.heading));
  bool const walks = track.type == TrackType::pedestrian;
  return map::build_free_corridor(
      map, points,
      {.width = std::max(1.0, track.width + 0.5), .type = walks ? map::LaneType::walking : map::LaneType::other});
}

CAMBIUM_COLD void require_replayable(RecordedTraffic const& traffic, RecordingWindow const& window) {
  require_map(traffic.map, traffic.name.empty() ? "recording" : traffic.name);
  if (!(window.begin <= window.end))
    throw Error(traffic.name, "the window ends before it begins", "let it end after its begin");
  bool found = !window.ego;
  for (auto const& track : traffic.tracks) {
    if (track.states.empty())
      throw Error(traffic.name + ": track " + std::to_string(track.id), "it has no states", "leave the track out");
    found = found || track.id == *window.ego;
    if (!track.stands && !(track.id >= 0 && track.id < static_cast<std::int64_t>(index_of(none<AgentId>))))
      throw Error(traffic.name + ": track " + std::to_string(track.id), "no agent can have this id",
                  "give the tracks numbers from 0 to 4294967294");
  }
  if (!found)
    throw Error(traffic.name, "its ego, track " + std::to_string(*window.ego) + ", is not there",
                "give the id of a track");
}

CAMBIUM_COLD Diagnostic about_track(RecordedTraffic const& traffic, Track const& track, std::string sentence) {
  return {Severity::info, traffic.name, 0, "", "track " + std::to_string(track.id), std::move(sentence)};
}

CAMBIUM_COLD std::vector<map::LightPlan> lights_from(RecordedTraffic const& traffic, double begin) {
  auto lights = traffic.lights;
  for (auto& plan : lights) {
    if (!(plan.cycle > 0.0)) continue;
    double const lasts = plan.green_end - plan.green_begin;
    plan.green_begin = std::fmod(plan.green_begin - begin, plan.cycle);
    plan.green_end = plan.green_begin + lasts;
  }
  return lights;
}

CAMBIUM_COLD geometry::Polygon outline_of(Track const& track) {
  auto const& at = track.states.front();
  if (!track.outline.empty()) {
    auto const [sin, cos] = portable::sin_cos(at.heading);
    std::vector<geometry::Point> corners;
    for (auto const& p : track.outline)
      corners.emplace_back(at.x + cos * p.x() - sin * p.y(), at.y + sin * p.x() + cos * p.y());
    return geometry::Polygon(corners);
  }
  double const length = 0.5 * track.length, width = 0.5 * track.width;
  return geometry::polygon_of(geometry::box_of({length, length, width, width}, {at.x, at.y, at.heading}));
}

CAMBIUM_COLD AgentId unused_agent_id(RecordedTraffic const& traffic, std::int64_t wanted) {
  std::set<std::int64_t> taken;
  for (auto const& track : traffic.tracks) taken.insert(track.id);
  auto id = wanted >= 0 && wanted < static_cast<std::int64_t>(index_of(none<AgentId>)) ? wanted : 0;
  while (taken.contains(id)) ++id;
  return static_cast<AgentId>(id);
}

}  // namespace detail

CAMBIUM_COLD std::vector<RecordingWindow> windows_of(RecordedTraffic const& traffic, double length, double every,
                                                     std::size_t least) {
  if (!(length > 0.0 && every > 0.0))
    throw ParameterError("windows_of", "the length or the distance of windows is not above 0", "give seconds");
  std::vector<RecordingWindow> windows;
  double const first = traffic.begin(), last = traffic.end();
  for (std::size_t i = 0; first + every * static_cast<double>(i) + length <= last + same_time; ++i) {
    double const begin = first + every * static_cast<double>(i);
    auto const moving = std::count_if(traffic.tracks.begin(), traffic.tracks.end(), [&](Track const& track) {
      return !track.stands && track.begin() < begin + length && track.end() > begin;
    });
    if (static_cast<std::size_t>(moving) >= least) windows.push_back({begin, begin + length, std::nullopt});
  }
  return windows;
}

CAMBIUM_COLD std::vector<RecordingWindow> ego_windows(RecordedTraffic const& traffic) {
  std::vector<RecordingWindow> windows;
  for (auto const& track : traffic.tracks)
    if (!track.stands && track.states.size() > 1) windows.push_back({track.begin(), track.end(), track.id});
  return windows;
}

CAMBIUM_COLD std::optional<TrackWay> way_of(Map const& map, Track const& track, double begin, double end) {
  constexpr double most_off = 0.1;  // share of the states between the first and the last one on lanes
  TrackWay way;
  way.states = detail::states_between(track, begin, end);
  if (way.states.empty()) return std::nullopt;
  if (track.type != TrackType::pedestrian) {
    detail::LaneMatcher matcher(map);
    std::size_t first = way.states.size(), last = 0, on_lanes = 0;
    auto const headed = detail::headed_by_motion(way.states);
    for (std::size_t i = 0; i < way.states.size(); ++i) {
      if (!matcher.add(headed[i])) continue;
      first = std::min(first, i);
      last = i;
      ++on_lanes;
    }
    if (last > first && static_cast<double>(on_lanes) >= (1.0 - most_off) * static_cast<double>(last - first + 1) &&
        2 * on_lanes >= way.states.size())
      way.route = matcher.route();
    if (way.route) {
      way.end = matcher.end();
      way.states.erase(way.states.begin() + static_cast<std::ptrdiff_t>(last) + 1, way.states.end());
      way.states.erase(way.states.begin(), way.states.begin() + static_cast<std::ptrdiff_t>(first));
      return way;
    }
  }
  try {
    way.road = detail::own_way(map, track, way.states);
  } catch (Error const& problem) {
    throw Error("track " + std::to_string(track.id), problem.what(), "repair or leave out the track");
  }
  return way;
}

}  // namespace cambium::inline v0_1
