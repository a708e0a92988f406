#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/map/lanelet/lanelet.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map::detail {

/// Makes lanelets of the drivable lanes of a map, see `lanelets_of`. A lanelet has one limit, and permits changes
/// everywhere or nowhere: the lanes of a section are cut where these change.
class LanesAsLanelets {
 public:
  LanesAsLanelets(Map const& map, std::int64_t first_id) : map_(map), first_id_(first_id) {
    auto const levels = {0.0, 0.5, 1.0};
    for (auto const& road : map.roads())
      for (double const u : levels) has_heights_ = has_heights_ || road.elevation.value(u * road.length) != 0.0;
    find_cuts();
  }

  [[nodiscard]] std::vector<Lanelet> make() const {
    std::vector<Lanelet> result;
    for (auto const& lane : map_.lanes())
      if (is_kept(lane.id)) add_parts(lane, result);
    return result;
  }

 private:
  using Section = std::pair<RoadId, std::uint32_t>;

  [[nodiscard]] bool is_kept(LaneId id) const {
    if (!is_valid(id)) return false;
    auto const& lane = map_.lane(id);
    return lane.drivable() && !lane.left.empty() && !lane.right.empty();
  }
  [[nodiscard]] static Section section_of(Lane const& lane) { return {lane.road, lane.section}; }

  void find_cuts() {
    for (auto const& lane : map_.lanes()) {
      if (!is_kept(lane.id)) continue;
      for (auto const& step : lane.speed_limits) cut(lane, step.begin);
      for (bool const left : {true, false}) {
        auto const neighbor = left ? lane.left_neighbor : lane.right_neighbor;
        if (!is_valid(neighbor) || section_of(map_.lane(neighbor)) != section_of(lane)) continue;
        for (auto const& stretch : left ? lane.left_changes : lane.right_changes) {
          cut(lane, stretch.begin);
          cut(lane, stretch.end);
        }
      }
    }
    std::int64_t next = first_id_ + static_cast<std::int64_t>(map_.lanes().size());
    for (auto const& lane : map_.lanes()) {
      ends_.push_back(find_ends(lane));
      further_ids_.push_back(next);
      if (is_kept(lane.id)) next += static_cast<std::int64_t>(ends_of(lane).size()) - 2;
    }
  }

  /// Cuts a lane's section beside `s` [m] of its path, unless a cut or an end lies within a metre.
  void cut(Lane const& lane, double s) {
    constexpr double shortest = 1.0;  // [m]
    if (s < shortest || s > lane.length() - shortest) return;
    auto& cuts = cuts_[section_of(lane)];
    double const station = lane.station_at(s);
    if (std::all_of(cuts.begin(), cuts.end(), [&](double other) { return std::abs(other - station) >= shortest; }))
      cuts.insert(std::upper_bound(cuts.begin(), cuts.end(), station), station);
  }

  /// Where a lane's parts begin and end along its path [m].
  [[nodiscard]] std::vector<double> const& ends_of(Lane const& lane) const { return ends_[index_of(lane.id)]; }

  [[nodiscard]] std::vector<double> find_ends(Lane const& lane) const {
    std::vector<double> ends{0.0};
    if (auto const cuts = cuts_.find(section_of(lane)); cuts != cuts_.end())
      for (double const station : cuts->second) ends.push_back(lane.position_at(station));
    std::sort(ends.begin(), ends.end());
    ends.push_back(lane.length());
    return ends;
  }

  [[nodiscard]] std::int64_t id_of(LaneId lane, std::size_t part) const {
    return part == 0 ? first_id_ + static_cast<std::int64_t>(index_of(lane))
                     : further_ids_[index_of(lane)] + static_cast<std::int64_t>(part) - 1;
  }
  [[nodiscard]] std::int64_t last_id_of(LaneId lane) const { return id_of(lane, ends_of(map_.lane(lane)).size() - 2); }

  void add_parts(Lane const& lane, std::vector<Lanelet>& lanelets) const {
    auto const& ends = ends_of(lane);
    auto const left = border_ends(lane, true, ends), right = border_ends(lane, false, ends);
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
      auto lanelet = links_of(lane, k);
      bool const is_whole = ends.size() == 2;
      lanelet.left = is_whole ? lane.left.points() : part_of(lane.left, left[k], left[k + 1]);
      lanelet.right = is_whole ? lane.right.points() : part_of(lane.right, right[k], right[k + 1]);
      if (has_heights_) {
        lanelet.left_heights = heights(lane, lanelet.left, ends[k]);
        lanelet.right_heights = heights(lane, lanelet.right, ends[k]);
      }
      lanelets.push_back(std::move(lanelet));
    }
  }

  /// A part of a lane without its bounds.
  [[nodiscard]] Lanelet links_of(Lane const& lane, std::size_t k) const {
    auto const& ends = ends_of(lane);
    auto const parts = ends.size() - 1;
    Lanelet lanelet{.id = id_of(lane.id, k)};
    if (k + 1 < parts) lanelet.successors.push_back(id_of(lane.id, k + 1));
    if (k > 0) lanelet.predecessors.push_back(id_of(lane.id, k - 1));
    if (k + 1 == parts)
      for (auto const other : lane.successors)
        if (is_kept(other)) lanelet.successors.push_back(id_of(other, 0));
    if (k == 0)
      for (auto const other : lane.predecessors)
        if (is_kept(other)) lanelet.predecessors.push_back(last_id_of(other));
    if (is_kept(lane.left_neighbor)) lanelet.left_neighbor = id_of(lane.left_neighbor, k);
    if (is_kept(lane.right_neighbor)) lanelet.right_neighbor = id_of(lane.right_neighbor, k);
    double const middle = 0.5 * (ends[k] + ends[k + 1]);
    bool const is_cut = parts > 1;  // a lane that is not may still be beside its neighbour in a part only
    lanelet.may_change_left =
        !is_valid(lane.left_neighbor) || (is_cut ? lane.may_change_left(middle) : !lane.left_changes.empty());
    lanelet.may_change_right =
        !is_valid(lane.right_neighbor) || (is_cut ? lane.may_change_right(middle) : !lane.right_changes.empty());
    lanelet.type = lane.type;
    if (double const limit = lane.speed_limit_at(middle); std::isfinite(limit)) lanelet.speed_limit = limit;
    auto const junction = map_.road(lane.road).junction;
    lanelet.in_junction = is_valid(junction);
    if (lanelet.in_junction) add_priorities(lane, map_.junctions()[index_of(junction)], lanelet);
    for (auto const& signal : lane.signals)
      if (signal.s >= ends[k] && (signal.s < ends[k + 1] || k + 1 == parts))
        lanelet.signals.push_back({signal.kind, ends[k + 1] - signal.s,
                                   is_valid(signal.light) ? map_.lights()[index_of(signal.light)].name : ""});
    return lanelet;
  }

  void add_priorities(Lane const& lane, Junction const& junction, Lanelet& lanelet) const {
    for (auto const& priority : junction.priorities) {
      if (priority.high != lane.road) continue;
      for (auto const& overlap : lane.overlaps)
        if (map_.lane(overlap.other).road == priority.low && is_kept(overlap.other))
          for (std::size_t k = 0; k + 1 < ends_of(map_.lane(overlap.other)).size(); ++k)
            lanelet.goes_before.push_back(id_of(overlap.other, k));
    }
    std::sort(lanelet.goes_before.begin(), lanelet.goes_before.end());
    lanelet.goes_before.erase(std::unique(lanelet.goes_before.begin(), lanelet.goes_before.end()),
                              lanelet.goes_before.end());
  }

  /// The place on a line nearest to `p`, from `from` [m] on and at most `reach` [m] farther: a line may lie over
  /// itself, or fold.
  [[nodiscard]] static double place_ahead(geometry::Line const& line, geometry::Point const& p, double from,
                                          double reach) {
    auto const segments = line.segments();
    double nearest = std::numeric_limits<double>::infinity(), found = from;
    for (std::size_t i = line.find(from); i < segments.size() && segments[i].s <= from + reach; ++i) {
      auto const& g = segments[i];
      double const along = (p.x() - g.x) * g.ux + (p.y() - g.y) * g.uy;
      double const s = std::max(from, g.s + std::clamp(along, 0.0, g.length)), way = s - g.s;
      double const away = portable::hypot(p.x() - g.x - way * g.ux, p.y() - g.y - way * g.uy);
      if (away < nearest) std::tie(nearest, found) = std::pair(away, s);
    }
    return found;
  }

  /// The heights of points along the path from `from` [m] on.
  [[nodiscard]] std::vector<double> heights(Lane const& lane, std::vector<geometry::Point> const& points,
                                            double from) const {
    constexpr double slack = 15.0;  // [m] a border may have no length beside so much of the path
    std::vector<double> result;
    double s = from;
    for (std::size_t i = 0; i < points.size(); ++i) {
      double const way = i == 0 ? 0.0 : (points[i] - points[i - 1]).norm();
      s = place_ahead(lane.path, points[i], s, 1.5 * way + slack);
      result.push_back(map_.road(lane.road).elevation.value(lane.station_at(s)));
    }
    return result;
  }

  /// Where on a border a lane's parts begin and end [m].
  [[nodiscard]] static std::vector<double> border_ends(Lane const& lane, bool left, std::vector<double> const& ends) {
    constexpr double step = 2.0, reach = 10.0;  // [m] of the path, and of the border beside it
    auto const& line = left ? lane.left : lane.right;
    std::vector<double> found{0.0};
    double s = 0.0, place = 0.0;
    for (std::size_t k = 1; k + 1 < ends.size(); ++k) {
      while (s < ends[k]) {
        s = std::min(s + step, ends[k]);
        auto const pose = lane.path.pose(s);
        auto const along = portable::sin_cos(pose.heading);
        auto const widths = lane.widths_at(s);
        double const aside = left ? widths.left : -widths.right;
        place = place_ahead(line, {pose.x - aside * along.sin, pose.y + aside * along.cos}, place, reach);
      }
      found.push_back(place);
    }
    found.push_back(line.length());
    return found;
  }

  /// The points of a line from `from` to `to` [m].
  [[nodiscard]] static std::vector<geometry::Point> part_of(geometry::Line const& line, double from, double to) {
    constexpr double apart = 0.01;  // [m]
    std::vector<geometry::Point> points{line.pose(from).position()};
    auto const segments = line.segments();
    for (std::size_t i = line.find(from); i < segments.size() && segments[i].s < to - apart; ++i)
      if (segments[i].s > from + apart) points.emplace_back(segments[i].x, segments[i].y);
    points.push_back(line.pose(to).position());
    return points;
  }

  Map const& map_;
  std::int64_t first_id_;
  bool has_heights_ = false;
  std::map<Section, std::vector<double>> cuts_;  ///< stations along the road, sorted [m]
  std::vector<std::vector<double>> ends_;        ///< of each lane's parts [m]
  std::vector<std::int64_t> further_ids_;        ///< of each lane's parts behind the first
};

}  // namespace cambium::inline v0_1::map::detail
