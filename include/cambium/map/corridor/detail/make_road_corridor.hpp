#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/corridor/detail/bends.hpp"
#include "cambium/map/corridor/detail/conflicts.hpp"
#include "cambium/map/corridor/detail/corridor_signals.hpp"
#include "cambium/map/corridor/detail/feeders.hpp"
#include "cambium/map/corridor/detail/lane_chains.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map::detail {

/// Joins the lanes of a chain to a lane corridor's lines, widths and pieces.
class LaneJoiner {
 public:
  explicit LaneJoiner(Map const& map) : map_(map) {}

  [[nodiscard]] LaneCorridor join(std::span<LaneId const> lanes) {
    for (auto const id : lanes) add(map_.lane(id));
    LaneCorridor corridor;
    corridor.center = geometry::Line::from_samples(center_);
    corridor.widths = std::move(widths_);
    if (left_.size() > 1) corridor.left = geometry::Line::from_samples(left_);
    if (right_.size() > 1) corridor.right = geometry::Line::from_samples(right_);
    corridor.pieces = make_pieces(corridor.center);
    corridor.speed_limits = join_limits(corridor.pieces);
    find_bends(corridor);
    auto const& last = map_.lane(lanes.back());
    corridor.continues = std::any_of(last.successors.begin(), last.successors.end(),
                                     [&](LaneId next) { return may_enter(last, map_.lane(next)); });
    return corridor;
  }

 private:
  /// Where a lane begins: at vertex `begin`; vertex `anchor` is at path position `s` of the lane.
  struct Start {
    LaneId lane = none<LaneId>;
    std::size_t begin{}, anchor{};
    double s{};
  };

  void add(Lane const& lane) {
    auto const segments = lane.path.segments();
    auto const samples = lane.path.samples();
    append_border(left_, lane.left);
    append_border(right_, lane.right);
    if (center_.empty()) {
      starts_.push_back({lane.id, 0, 0, 0.0});
      center_ = samples;
      widths_ = lane.widths;
      return;
    }
    // The lane before has made the joint's vertex.
    double const bridge = bridge_length(lane, samples.front());
    starts_.push_back({lane.id, center_.size() - 1, center_.size(), bridge});
    if (bridge > 0.0) append(lane.path.pose(bridge), lane.widths_at(bridge));
    for (std::size_t i = 1; i < samples.size(); ++i) {
      double const s = i < segments.size() ? segments[i].s : lane.length();
      if (s < bridge + 1e-3 && i < segments.size()) continue;
      if (append(samples[i], lane.widths[i]) && starts_.back().s == 0.0) starts_.back().s = s;
    }
    if (starts_.back().anchor == center_.size())
      starts_.back() = {lane.id, center_.size() - 1, center_.size() - 1, 0.0};
  }

  /// Adds a vertex if it lies ahead: a lane shorter than the file's rounding may begin before the last one ends.
  bool append(geometry::LineSample const& p, SideWidths const& widths) {
    if (!geometry::goes_on(center_.back(), p)) return false;
    center_.push_back(p);
    widths_.push_back(widths);
    return true;
  }

  /// Length of the transition to a lane that does not join exactly [m]; else 0.
  [[nodiscard]] double bridge_length(Lane const& lane, geometry::LineSample const& begin) const {
    constexpr double tolerance = 1e-3;  // [m], [rad]
    auto const& end = center_.back();
    double const gap = portable::hypot(begin.x - end.x, begin.y - end.y);
    double const turn = std::abs(geometry::angle_difference(begin.heading, end.heading));
    double const left = lane.widths.front().left - widths_.back().left,
                 right = lane.widths.front().right - widths_.back().right;
    double length = 0.0;
    if (std::max(std::abs(left), std::abs(right)) > tolerance) length = 0.1;
    if (gap > tolerance || turn > tolerance) length = std::max(1.0, 2.0 * gap);
    return std::min(length, 0.5 * lane.length());
  }

  static void append_border(std::vector<geometry::LineSample>& border, geometry::Line const& line) {
    for (auto const& p : line.samples())
      if (border.empty() || portable::hypot(p.x - border.back().x, p.y - border.back().y) > 0.01) border.push_back(p);
  }

  [[nodiscard]] IdVector<CorridorPiece, PieceId> make_pieces(geometry::Line const& center) const {
    auto const segments = center.segments();
    auto const position = [&](std::size_t vertex) {
      return vertex < segments.size() ? segments[vertex].s : center.length();
    };
    IdVector<CorridorPiece, PieceId> pieces;
    for (std::size_t i = 0; i < starts_.size(); ++i) {
      auto const& start = starts_[i];
      std::size_t const last = i + 1 < starts_.size() ? starts_[i + 1].begin : segments.size();
      auto const& lane = map_.lane(start.lane);
      double const offset = start.s - position(start.anchor);
      pieces.push_back({.lane = start.lane,
                        .begin = position(start.begin),
                        .end = position(last),
                        .index_offset = lane.index_begin + offset,
                        .type = lane.type,
                        .lane_offset = offset,
                        .first_segment = static_cast<std::uint32_t>(start.begin),
                        .segments = static_cast<std::uint32_t>(last - start.begin)});
    }
    return pieces;
  }

  [[nodiscard]] std::vector<SpeedStep> join_limits(std::span<CorridorPiece const> pieces) const {
    std::vector<SpeedStep> joined;
    auto const add = [&joined](double begin, double limit) {
      if (joined.empty() || joined.back().limit != limit) joined.push_back({begin, limit});
    };
    for (auto const& piece : pieces) {
      auto const& lane = map_.lane(piece.lane);
      add(piece.begin, lane.speed_limit_at(0.0));
      for (auto const& step : lane.speed_limits)
        if (step.begin > 0.0) add(std::clamp(step.begin - piece.lane_offset, piece.begin, piece.end), step.limit);
    }
    if (joined.size() == 1 && !std::isfinite(joined.front().limit)) joined.clear();
    return joined;
  }

  Map const& map_;
  std::vector<geometry::LineSample> center_, left_, right_;
  std::vector<SideWidths> widths_;
  std::vector<Start> starts_;
};

/// Sets the pieces' `lane_end`. `is_short`: the corridor ends before the route does.
inline void set_lane_ends(Map const& map, LaneCorridor& corridor, bool is_short) {
  double end = is_short ? corridor.length() : std::numeric_limits<double>::infinity();
  for (auto piece = corridor.pieces.rbegin(); piece != corridor.pieces.rend(); ++piece) {
    auto const& lane = map.lane(piece->lane);
    if (is_valid(lane.merges_into)) end = lane.merge_begin - piece->lane_offset;
    piece->lane_end = end;
  }
}

/// The number of the chain that holds `lane` in `stage`; of several, one that has not come there by a merge, else the
/// first.
[[nodiscard]] inline CorridorId chain_of(Map const& map, std::span<LaneChain const> chains, std::size_t stage,
                                         LaneId lane) {
  auto found = none<CorridorId>;
  if (!is_valid(lane)) return found;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    if (chains[i].at(stage) != lane) continue;
    auto const before = static_cast<std::ptrdiff_t>(stage - chains[i].begin);
    bool const has_merged = std::any_of(chains[i].lanes.begin(), chains[i].lanes.begin() + before,
                                        [&map](LaneId l) { return is_valid(map.lane(l).merges_into); });
    if (!has_merged) return static_cast<CorridorId>(i);
    if (found == none<CorridorId>) found = static_cast<CorridorId>(i);
  }
  return found;
}

/// The number of the chain with the route's last lane; of several, the first with the most lanes of the route.
[[nodiscard]] inline CorridorId main_chain(std::span<LaneChain const> chains, std::span<LaneId const> route) {
  std::size_t best = 0;
  std::ptrdiff_t most = -1;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    if (!chains[i].has(route.back())) continue;
    auto const count = std::count_if(route.begin(), route.end(), [&](LaneId lane) { return chains[i].has(lane); });
    if (count <= most) continue;
    most = count;
    best = i;
  }
  return static_cast<CorridorId>(best);
}

/// Whether the right of way decides who goes first where feeders merge into the corridor at `meet` [m]: there is a
/// conflict with a lane that merges there, or, where lanes cross before they end in one, with each of them.
[[nodiscard]] inline bool merges_by_rule(LaneCorridor const& corridor, double meet) {
  constexpr double near = 1e-3;  // [m]
  auto const& conflicts = corridor.conflicts;
  if (std::any_of(conflicts.begin(), conflicts.end(),
                  [&](Conflict const& conflict) { return std::abs(conflict.meet - meet) < near; }))
    return true;
  auto const ends_there = [&](Feeder const& feeder) {
    return std::abs(feeder.free_until - meet) < near && std::abs(feeder.end - meet) < near;
  };
  auto const conflicts_with = [&](Feeder const& feeder) {
    return std::any_of(conflicts.begin(), conflicts.end(),
                       [&](Conflict const& conflict) { return conflict.other == feeder.lane; });
  };
  auto const& feeders = corridor.feeders;
  return std::any_of(feeders.begin(), feeders.end(), ends_there) &&
         std::none_of(feeders.begin(), feeders.end(),
                      [&](Feeder const& feeder) { return ends_there(feeder) && !conflicts_with(feeder); });
}

/// The road corridor along `route`, see `build_road_corridor`.
[[nodiscard]] inline std::shared_ptr<RoadCorridor const> make_road_corridor(Map const& map,
                                                                            std::vector<LaneId> const& route) {
  auto const stages = route_stages(map, route);
  auto const chains = lane_chains(map, stages);
  if (chains.size() >= index_of(none<CorridorId>))
    throw MapError("route", "it has more lane corridors than can be numbered", "give a shorter one");
  auto road = std::make_shared<RoadCorridor>();
  road->route = route;
  road->main = main_chain(chains, route);
  for (auto const& chain : chains) {
    auto corridor = LaneJoiner(map).join(chain.lanes);
    for (std::size_t i = 0; i < corridor.pieces.size(); ++i) {
      auto& piece = corridor.pieces[i];
      auto const stage = chain.begin + i;
      auto const piece_of = [&](CorridorId number) {
        return static_cast<PieceId>(number == none<CorridorId> ? 0 : stage - chains[index_of(number)].begin);
      };
      piece.left = chain_of(map, chains, stage, map.lane(piece.lane).left_neighbor);
      piece.right = chain_of(map, chains, stage, map.lane(piece.lane).right_neighbor);
      piece.left_piece = piece_of(piece.left);
      piece.right_piece = piece_of(piece.right);
    }
    set_lane_ends(map, corridor, chain.begin + chain.lanes.size() < stages.size());
    corridor.reaches_destination = chain.has(route.back());
    FeederFinder(map, corridor).find();
    corridor.conflicts = ConflictFinder(map, corridor).find();
    corridor.signals = corridor_signals(map, corridor);
    for (auto& feeder : corridor.feeders)
      feeder.by_rule = std::isfinite(feeder.free_until) && merges_by_rule(corridor, feeder.free_until);
    road->corridors.push_back(std::move(corridor));
  }
  return road;
}

inline void require_start(Map const& map, LaneId from) {
  if (index_of(from) >= map.lanes().size())
    throw MapError("route", "its start, lane " + to_string(from) + ", is not in the map",
                   "see Map::lanes for those it has");
}

/// See `map::straight_route`.
[[nodiscard]] inline Route straight_route(Map const& map, LaneId from, double max_length) {
  require_start(map, from);
  Route route{{from}, map.lane(from).length()};
  std::vector<bool> has_come(map.lanes().size());
  has_come[index_of(from)] = true;
  while (route.length < max_length) {
    auto const next = straightest_successor(map, map.lane(route.lanes.back()), [](LaneId) { return true; });
    if (!is_valid(next) || has_come[index_of(next)]) break;
    has_come[index_of(next)] = true;
    route.lanes.push_back(next);
    route.length += map.lane(next).length();
  }
  return route;
}

/// The routes of `map::roads_ahead`.
[[nodiscard]] inline std::vector<Route> routes_ahead(Map const& map, LaneId from) {
  constexpr double forks_within = 120.0, far = 300.0;  // [m]
  require_start(map, from);
  std::vector<LaneId> stem, next{from};
  auto const has_come = [&](LaneId id) { return std::find(stem.begin(), stem.end(), id) != stem.end(); };
  for (double ahead = -map.lane(from).length(); next.size() == 1 && ahead < forks_within;) {
    auto const& lane = map.lane(next.front());
    stem.push_back(lane.id);
    ahead += lane.length();
    next = lane.successors;
    std::erase_if(next, [&](LaneId id) { return !map.lane(id).drivable() || has_come(id); });
  }
  bool const forks = next.size() > 1;
  if (!forks) {
    next = {stem.back()};
    stem.pop_back();
  }
  std::vector<Route> routes;
  for (auto const id : next) {
    auto const on = detail::straight_route(map, id, far).lanes;
    Route route{stem, 0.0};
    route.lanes.insert(route.lanes.end(), on.begin(), std::find_if(on.begin(), on.end(), has_come));
    for (auto const lane : route.lanes) route.length += map.lane(lane).length();
    routes.push_back(std::move(route));
  }
  return routes;
}

}  // namespace cambium::inline v0_1::map::detail
