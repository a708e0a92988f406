#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "cambium/map/lane_position.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/frame.hpp"
#include "cambium/world/static_object.hpp"
#include "cambium/world/traffic_index.hpp"

namespace cambium::detail {

/// An agent this close to its path follows it, whatever the borders do: the path of an ending lane crosses one [m].
inline constexpr double on_path = 0.3;

/// Finds the agent's new place on its road: in its lane corridor, or in the next one once it has crossed the border.
template <class Record>
void move_on_lane(map::RoadCorridor const& road, Record& next) {
  geometry::Pose const pose{next.state.x, next.state.y, next.state.heading};
  next.lane = map::locate(road, next.lane.corridor, pose, next.lane);
  auto const& corridor = road.corridors[next.lane.corridor];
  auto const& piece = corridor.pieces[next.lane.piece];
  if (std::abs(next.lane.lateral) > on_path) {
    auto const widths = corridor.widths_at(next.lane.s, next.lane.segment);
    auto const beside = next.lane.lateral > widths.left     ? piece.left
                        : next.lane.lateral < -widths.right ? piece.right
                                                            : map::no_corridor;
    if (beside != map::no_corridor) {
      next.lane = map::locate(road, beside, pose);
      return;
    }
  }
  if (next.lane.s > corridor.length()) next.status = corridor.continues ? AgentStatus::arrived : AgentStatus::left_map;
}

/// Cosine of an angle that is mostly small, as between a vehicle and its lane: there four terms are as good as the
/// function.
[[nodiscard]] inline double cosine_of_small(double angle) {
  double const square = angle * angle;
  if (square > 1e-3) return std::cos(angle);
  return 1.0 - square / 2 * (1.0 - square / 12 * (1.0 - square / 30));
}

/// Half the width of the widest vehicle that is within its lane wherever it follows the path [m]; where two paths come
/// too close for that, the lanes overlap and the index knows.
inline constexpr double usual_half_width = 1.5;

/// Adds an entry to the list for each neighbouring lane that the agent of `entry` reaches into.
template <class Agent, class Record>
void straddle(Map const& map, Agent const& agent, Record const& record, TrafficEntry entry,
              std::vector<TrafficEntry>& list) {
  auto const& at = record.lane;
  auto const& corridor = agent.road->corridors[at.corridor];
  double const left = at.lateral + agent.shape.left, right = agent.shape.right - at.lateral;
  auto const widths = corridor.widths_at(at.s, at.segment);
  auto const& lane = map.lane(corridor.pieces[at.piece].lane);
  double const share = (at.index - lane.index_begin) / lane.length();
  auto const enter = [&](LaneId beside) {
    if (!is_valid(beside)) return;
    auto const& other = map.lane(beside);
    double const s = other.path.project({record.state.x, record.state.y}, other.path.find(share * other.length())).s;
    entry.position = other.index_begin + std::clamp(s, 0.0, other.length());
    list.push_back(entry);
  };
  if (left > widths.left) enter(lane.left_neighbor);
  if (right > widths.right) enter(lane.right_neighbor);
}

/// Brings the index up to date with the agents of a frame.
template <class Roster, class Frame>
void refresh_traffic(TrafficIndex& index, Map const& map, Roster const& roster, Frame const& frame) {
  auto const entry_of = [&](std::uint32_t slot) {
    auto const& record = frame.agents[slot];
    auto const& agent = roster.agents[slot];
    double const position =
        record.status == AgentStatus::driving ? record.lane.index : std::numeric_limits<double>::infinity();
    double const speed = record.state.speed * cosine_of_small(record.lane.heading_error);
    return TrafficEntry{
        position, agent.shape.front, agent.shape.rear, speed, slot, static_cast<std::uint32_t>(agent.id)};
  };
  auto const add_straddling = [&](TrafficEntry const& entry, std::vector<TrafficEntry>& list) {
    auto const& agent = roster.agents[entry.slot];
    auto const& record = frame.agents[entry.slot];
    bool const is_usual = std::max(agent.shape.left, agent.shape.right) <= usual_half_width;
    if ((is_usual && std::abs(record.lane.lateral) <= on_path) || record.status != AgentStatus::driving) return;
    straddle(map, agent, record, entry, list);
  };
  index.refresh(frame.agents.size(), entry_of, add_straddling);
}

/// A polygon's corners and points between them, at most `spacing` [m] apart.
[[nodiscard]] inline std::vector<geometry::Point> points_around(geometry::Polygon const& outline, double spacing) {
  std::vector<geometry::Point> points;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    auto const [a, b] = outline.edge(i);
    int const parts = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
    for (int k = 0; k < parts; ++k) points.emplace_back(a + (b - a) * (static_cast<double>(k) / parts));
  }
  return points;
}

/// Index entries of static objects, sorted: one in each drivable lane whose borders an object reaches across. An
/// entry's slot is the object's place in the list.
[[nodiscard]] inline std::vector<TrafficEntry> object_entries(Map const& map, std::span<StaticObject const> objects) {
  struct Stretch {
    double begin = std::numeric_limits<double>::infinity(), end = -std::numeric_limits<double>::infinity();
  };
  std::vector<TrafficEntry> entries;
  for (std::uint32_t slot = 0; slot < objects.size(); ++slot) {
    std::map<LaneId, Stretch> stretches;
    for (auto const& p : points_around(objects[slot].outline, 0.1))
      for (auto const& hit : map.lanes_near(p, 0.0)) {
        if (!map.lane(hit.lane).drivable()) continue;
        auto& stretch = stretches[hit.lane];
        stretch.begin = std::min(stretch.begin, hit.s);
        stretch.end = std::max(stretch.end, hit.s);
      }
    for (auto const& [lane, stretch] : stretches) {
      double const half = (stretch.end - stretch.begin) / 2;
      double const position = map.lane(lane).index_begin + stretch.begin + half;
      entries.push_back({position, half, half, 0.0, slot, static_cast<std::uint32_t>(objects[slot].id)});
    }
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

}  // namespace cambium::detail
