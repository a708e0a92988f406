#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/scenario/dataset/recorded_traffic.hpp"

namespace cambium::inline v0_1 {

CAMBIUM_COLD std::vector<LaneId> GoalState::lanes(Map const& map) const {
  constexpr double step = 0.5;  // [m]
  std::vector<std::pair<double, LaneId>> found;
  for (auto const& area : areas)
    for (auto const id : map.lanes_in(area.bounding_box())) {
      auto const& lane = map.lane(id);
      if (!lane.drivable()) continue;
      double inside = 0.0;
      for (double s = 0.0; s <= lane.length(); s += step)
        if (area.contains(lane.path.pose(s).position())) inside += step;
      if (inside > 0.0) found.emplace_back(-inside, id);
    }
  std::sort(found.begin(), found.end());
  std::vector<LaneId> lanes;
  for (auto const& [length, id] : found)
    if (std::find(lanes.begin(), lanes.end(), id) == lanes.end()) lanes.push_back(id);
  return lanes;
}

CAMBIUM_COLD Goal PlanningProblem::goal() const {
  if (goals.empty()) return NoGoal{};
  if (goals.size() == 1) return OwnGoal(goals.front());
  AnyGoal any;
  for (auto const& goal : goals) any.parts.push_back(OwnGoal(goal));
  return any;
}

CAMBIUM_COLD Track const& RecordedTraffic::track(std::int64_t id) const {
  for (auto const& track : tracks)
    if (track.id == id) return track;
  constexpr std::size_t most = 12;
  std::string ids;
  for (std::size_t i = 0; i < std::min(most, tracks.size()); ++i)
    ids += (i == 0 ? "" : ", ") + std::to_string(tracks[i].id);
  if (tracks.size() > most) ids += " and " + std::to_string(tracks.size() - most) + " more";
  throw Error(name + ": track " + std::to_string(id), "there is no such track",
              ids.empty() ? "it has no tracks" : "there are " + ids);
}

CAMBIUM_COLD double RecordedTraffic::begin() const {
  double first = std::numeric_limits<double>::infinity();
  for (auto const& track : tracks)
    if (!track.stands && !track.states.empty()) first = std::min(first, track.begin());
  return std::isfinite(first) ? first : 0.0;
}

CAMBIUM_COLD double RecordedTraffic::end() const {
  double last = -std::numeric_limits<double>::infinity();
  for (auto const& track : tracks)
    if (!track.stands && !track.states.empty()) last = std::max(last, track.end());
  return std::isfinite(last) ? last : 0.0;
}

CAMBIUM_COLD void add_tracks(RecordedTraffic& traffic, RecordedTraffic const& more) {
  std::set<std::int64_t> ids;
  for (auto const& track : traffic.tracks) ids.insert(track.id);
  for (auto const& track : more.tracks) ids.insert(track.id);
  auto next = ids.empty() ? 0 : *ids.rbegin();
  ids.clear();
  for (auto const& track : traffic.tracks) ids.insert(track.id);
  for (auto track : more.tracks) {
    if (!ids.insert(track.id).second) track.id = ++next;
    traffic.tracks.push_back(std::move(track));
  }
  traffic.diagnostics.insert(traffic.diagnostics.end(), more.diagnostics.begin(), more.diagnostics.end());
}

CAMBIUM_COLD void check_recorded_traffic(RecordedTraffic const& traffic) {
  std::set<std::int64_t> ids;
  for (auto const& track : traffic.tracks) {
    auto const where = traffic.name + ": track " + std::to_string(track.id);
    if (!ids.insert(track.id).second) throw Error(where, "there is another one of that id", "give each its own");
    if (track.states.empty()) throw Error(where, "it has no states", "leave the track out");
    if (!(track.length > 0.0 && track.width > 0.0 && track.length <= 100.0 && track.width <= 100.0))
      throw Error(where, "its length or width is not above 0 and up to 100 m", "give the size of its body");
    for (std::size_t i = 0; i < track.states.size(); ++i) {
      if (!is_finite(track.states[i])) throw Error(where, "a state is not finite", "leave that state out");
      if (i > 0 && !(track.states[i - 1].time < track.states[i].time))
        throw Error(where, "its times do not rise", "sort its states, and leave repeated ones out");
    }
  }
}

}  // namespace cambium::inline v0_1
