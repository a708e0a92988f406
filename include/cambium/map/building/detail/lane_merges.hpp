#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/map/building/detail/lane_geometry.hpp"
#include "cambium/map/building/detail/path_check.hpp"
#include "cambium/map/building/detail/section_sampler.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map::detail {

/// Where a lane that merges leaves its middle: a little before it narrows, or over the last `longest` [m] of one that
/// does not.
struct MergeBegin {
  double from = 0.0;  ///< [m] from its begin
  bool narrows = false;
};
[[nodiscard]] inline MergeBegin merge_begin(Lane const& lane, double longest) {
  constexpr double shortest = 30.0;  // [m]
  double const length = lane.length();
  auto const width = [&lane](std::size_t i) { return lane.widths[i].left + lane.widths[i].right; };
  double widest = 0.0;
  for (std::size_t i = 0; i < lane.widths.size(); ++i) widest = std::max(widest, width(i));
  auto narrow = lane.widths.size() - 1;
  if (width(narrow) < 0.5 * widest)
    while (narrow > 0 && width(narrow) < 0.95 * widest) --narrow;
  bool const narrows = narrow + 1 < lane.widths.size();
  double const taper = narrows ? 1.3 * (length - lane.path.segments()[narrow].s) : 0.0;
  double const swing = narrows ? std::clamp(taper, shortest, std::max(shortest, longest)) : longest;
  return {std::max(0.0, length - swing), narrows};
}

/// Why a lane must not, or cannot, merge into its neighbour `onto`; null where it may. One that narrows to nothing
/// leaves no choice, whatever the line says.
[[nodiscard]] inline char const* fault_of_merge(Lane const& lane, Lane const& onto, double longest) {
  constexpr double steepest = 0.5, tightest = 0.2;  // slope; curvature [1/m]
  auto const [from, narrows] = merge_begin(lane, longest);
  auto const& changes = onto.id == lane.left_neighbor ? lane.left_changes : lane.right_changes;
  if (!narrows && changes.empty()) return "the line between them forbids the change";
  auto const end = lane.path.end_pose().position();
  double const way = lane.length() - from, aside = std::abs(onto.path.project(end).lateral);
  // The largest slope and curvature of a `Smoothstep` across.
  if (1.875 * aside > steepest * way || 5.78 * aside > tightest * way * way) return "it is too short for a merge";
  return nullptr;
}

/// Moves the places of a lane's signals and permitted changes.
template <class Moved>
void move_places(Lane& lane, Moved const& moved) {
  for (auto& signal : lane.signals) signal.s = moved(signal.s);
  for (auto* changes : {&lane.left_changes, &lane.right_changes})
    for (auto& stretch : *changes) stretch = {moved(stretch.begin), moved(stretch.end)};
}

/// Lets a lane's path swing over onto that of its neighbour `onto`, of whatever road, and go on with it to its end,
/// from where `merge_begin` says.
inline void swing_over(Lane& lane, Lane const& onto, double longest) {
  constexpr double spacing = 1.0;  // [m]
  double const length = lane.length(), from = merge_begin(lane, longest).from;

  auto const across = [&](double s) {  // to the neighbour's path, left positive [m]
    auto const at = lane.path.pose(s);
    auto const foot = onto.path.pose(onto.path.project(at.position()).s);
    auto const [sin, cos] = portable::sin_cos(at.heading);
    return (foot.y - at.y) * cos - (foot.x - at.x) * sin;
  };
  std::vector<double> places;
  for (auto const& segment : lane.path.segments())
    if (segment.s < from - 1e-3) places.push_back(segment.s);
  auto const steps = std::max(1, static_cast<int>(std::ceil((length - from) / spacing)));
  for (int k = 0; k <= steps; ++k) places.push_back(from + (length - from) * k / steps);
  std::vector<geometry::LineSample> path;
  std::vector<SideWidths> widths;
  std::vector<double> stations;
  for (double const s : places) {
    auto const at = lane.path.pose(s);
    double lateral = 0.0, slope = 0.0;
    if (s > from) {
      constexpr double h = 0.5;  // [m]
      double const before = std::max(0.0, s - h), behind = std::min(length, s + h), t = across(s);
      Smoothstep const w((s - from) / (length - from));
      lateral = w.value * t;
      slope = w.value * (across(behind) - across(before)) / (behind - before) + w.slope / (length - from) * t;
    }
    auto const [sin, cos] = portable::sin_cos(at.heading);
    path.push_back({at.x - sin * lateral, at.y + cos * lateral,
                    at.heading + portable::atan2(slope, 1.0 - lane.path.curvature(s) * lateral)});
    auto const w = lane.widths_at(s);
    widths.push_back({w.left - lateral, w.right + lateral});
    stations.push_back(lane.station_at(s));
  }
  auto const samples = onto.path.samples();
  auto const reached = [&] { return onto.path.project(geometry::Point{path.back().x, path.back().y}).s; };
  for (; path.size() > 2 && reached() > onto.length() - 0.05; path.pop_back()) {  // it ends behind that one's end
    widths.pop_back();
    stations.pop_back();
  }
  double const joined = reached();
  for (std::size_t i = 1; i < samples.size(); ++i) {  // to where that one ends
    double const s = i < onto.path.segments().size() ? onto.path.segments()[i].s : onto.length();
    if (s < joined + 0.01) continue;
    path.push_back(samples[i]);
    widths.push_back(widths.back());
    stations.push_back(stations.back());
  }
  move_places(lane, [&](double s) { return lane.station_at(s); });
  lane.merges_into = onto.id;
  lane.merge_begin = from;
  lane.path = geometry::Line::from_samples(path);
  lane.widths = std::move(widths);
  lane.stations = std::move(stations);
  move_places(lane, [&](double station) { return lane.position_at(station); });
}

/// Lets lanes that end while their neighbour goes on merge into that one, with a finding; from the lanes that go on
/// outwards, for one may merge into another that merges itself. Those that cannot are dead ends.
inline void merge_into_neighbors(Map::Parts& parts, LaneFindings const& findings) {
  auto const name = [&](Lane const& lane) { return parts.roads[index_of(lane.road)].name; };
  std::map<LaneId, std::pair<LaneId, char const*>> refused;  // the neighbour, and why
  auto const merge = [&](Lane& lane) {
    for (auto const side : {lane.left_neighbor, lane.right_neighbor}) {
      if (!is_valid(side)) continue;
      auto const& beside = parts.lanes[index_of(side)];
      if (beside.successors.empty()) continue;
      if (char const* const fault = fault_of_merge(lane, beside, parts.options.merge_length)) {
        refused.try_emplace(lane.id, side, fault);
        continue;
      }
      swing_over(lane, beside, parts.options.merge_length);
      lane.successors = beside.successors;
      for (auto const next : lane.successors) parts.lanes[index_of(next)].predecessors.push_back(lane.id);
      findings.add(lane, Severity::info, "it ends beside lanelet " + name(beside) + ", and was merged into that one");
      return true;
    }
    return false;
  };
  for (bool found = true; found;) {
    found = false;
    for (auto& lane : parts.lanes)
      if (lane.successors.empty() && merge(lane)) found = true;
  }
  for (auto const& [id, why] : refused) {
    auto const& lane = parts.lanes[index_of(id)];
    if (lane.successors.empty())
      findings.add(lane, Severity::info,
                   "it ends beside lanelet " + name(parts.lanes[index_of(why.first)]) + ", but " + why.second +
                       ": it is a dead end");
  }
}

/// Lets lanes that end while their neighbour goes on merge into that one; not those in `dead_ends`. A lane that is
/// linked to a neighbour's successor beside its own end ends, too.
class LaneMerger {
 public:
  LaneMerger(std::vector<Road> const& roads, std::vector<Lane>& lanes, MapOptions const& options,
             std::set<LaneId> dead_ends)
      : roads_(roads), lanes_(lanes), options_(options), dead_ends_(std::move(dead_ends)) {}

  void merge() {
    for (auto& lane : lanes_)
      if (lane.drivable() && lane.successors.size() == 1) unlink_aside(lane);
    // From the lanes that go on outwards: one may merge into another that merges itself.
    for (bool found = true; found;) {
      found = false;
      for (auto& lane : lanes_)
        if (lane.drivable() && lane.successors.empty() && find_merge(lane)) found = swing(lane) || found;
    }
  }

 private:
  /// Takes a link back that leads to a neighbour's successor, which begins aside of where the lane ends.
  void unlink_aside(Lane& lane) {
    constexpr double aside = 0.5;  // [m]
    auto& next = lanes_[index_of(lane.successors.front())];
    if ((next.path.pose(0.0).position() - lane.path.pose(lane.length()).position()).norm() < aside) return;
    for (auto const side : {lane.left_neighbor, lane.right_neighbor}) {
      if (!is_valid(side)) continue;
      auto const& beside = lanes_[index_of(side)];
      auto const end = beside.path.pose(beside.length()).position();
      if (beside.successors != lane.successors || (next.path.pose(0.0).position() - end).norm() > aside) continue;
      lane.successors.clear();
      std::erase(next.predecessors, lane.id);
      return;
    }
  }

  [[nodiscard]] bool find_merge(Lane& lane) const {
    bool const keeps_left = roads_[index_of(lane.road)].left_hand_traffic;
    for (auto const side : {keeps_left ? lane.right_neighbor : lane.left_neighbor,
                            keeps_left ? lane.left_neighbor : lane.right_neighbor}) {
      if (!is_valid(side) || lanes_[index_of(side)].successors.empty() || dead_ends_.contains(lane.id)) continue;
      lane.merges_into = side;
      return true;
    }
    return false;
  }

  /// Lets the lane's path swing onto the neighbour's and go on as that one does.
  bool swing(Lane& lane) {
    // [m] between the stations of a swing: its curvature is some 0.03 1/m at most (3.5 m over 30 m).
    double const spacing = std::clamp(std::sqrt(8.0 * 0.7 * options_.position_tolerance / 0.03), 0.05, 1.5);
    auto const& road = roads_[index_of(lane.road)];
    auto const& section = road.sections[lane.section];
    auto const column = column_of(section, lane.number),
               target = column_of(section, lanes_[index_of(lane.merges_into)].number);
    SectionSampler const sampler(road, section, options_);
    double const from = taper_begin(sampler, column, lane.along_road, options_.merge_length);
    double const to = lane.along_road ? section.end : section.begin;
    auto const cross_sections = sampler.sample(spacing, std::min(from, to), std::max(from, to));
    auto const path = [&](CrossSection const& c) { return merging_path(c, column, target, from, to); };
    if (!set_geometry(lane, cross_sections, column, path)) {
      lane.merges_into = none<LaneId>;
      dead_ends_.insert(lane.id);
      return false;
    }
    lane.merge_begin = lane.position_at(from);
    auto const& neighbor = lanes_[index_of(lane.merges_into)];
    lane.successors = neighbor.successors;
    for (auto const next : lane.successors) lanes_[index_of(next)].predecessors.push_back(lane.id);
    return !lane.successors.empty();
  }

  std::vector<Road> const& roads_;
  std::vector<Lane>& lanes_;
  MapOptions const& options_;
  std::set<LaneId> dead_ends_;  ///< lanes that must not merge, or could not
};

}  // namespace cambium::inline v0_1::map::detail
