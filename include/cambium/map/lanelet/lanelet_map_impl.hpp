#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/core/text.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/map/building/build_map.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/building/polyline_roads.hpp"
#include "cambium/map/building/road_plan.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/lanelet/detail/lanelet_bounds.hpp"
#include "cambium/map/lanelet/detail/lanelet_network.hpp"
#include "cambium/map/lanelet/detail/lanes_as_lanelets.hpp"
#include "cambium/map/lanelet/lanelet_map.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/curve_layout.hpp"

namespace cambium::inline v0_1::map {

namespace detail {

/// Makes a map of lanelets: each becomes a road with one lane along its own middle, so that no lane's path depends on
/// the shape of another one; links, neighbours, signs and permitted changes are those of the lanelets.
class LaneletMapMaker {
 public:
  LaneletMapMaker(std::vector<Lanelet> lanelets, std::string const& file, std::vector<Diagnostic>& diagnostics)
      : findings_{file, diagnostics}, network_(std::move(lanelets), findings_), builder_(file) {}

  [[nodiscard]] LaneletMap make(MapOptions const& options) {
    for (std::size_t i = 0; i < network_.lanelets.size(); ++i) add_road(i);
    if (of_road_.empty())
      throw MapError(findings_.file, "no lanelet is left to make a map of" + likely_cause(findings_.list),
                     "give lanelets with a left and a right bound");
    add_priorities();
    LaneletMap result;
    result.map =
        build_linked_map(builder_.document(), options, findings_.file, findings_.list, [this](Map::Parts& parts) {
          parts_ = &parts;
          find_lanes();
          link();
          for (auto const& lane : parts.lanes) report_outside(lane);
          for (std::size_t i = 0; i < lanes_.size(); ++i) {
            if (!is_valid(lanes_[i])) continue;
            put_beside(i);
            add_signals(i);
          }
        });
    for (std::size_t i = 0; i < lanes_.size(); ++i)
      if (is_valid(lanes_[i])) result.lanes.emplace(network_.lanelets[i].id, lanes_[i]);
    return result;
  }

 private:
  /// The name of a lanelet's road; "-1" is none in OpenDRIVE.
  [[nodiscard]] static std::string name_of(std::int64_t id) { return id == -1 ? "lanelet -1" : std::to_string(id); }

  /// Straight from each height to the next; they are those of the ends of the geometries.
  [[nodiscard]] static std::vector<CubicRecord> elevation_along(std::vector<Geometry> const& line,
                                                                std::vector<double> const& heights) {
    std::vector<CubicRecord> records;
    for (std::size_t i = 0; i + 1 < heights.size(); ++i)
      records.push_back({line[i].s, heights[i], (heights[i + 1] - heights[i]) / line[i].length, 0.0, 0.0});
    return records;
  }

  void add_road(std::size_t i) {
    auto const& lanelet = network_.lanelets[i];
    auto const& center = network_.centers[i];
    try {
      auto const id = name_of(lanelet.id);
      auto plan = lane_along(curve_around(center.points, center.corners, network_.headings[i][0],
                                          network_.headings[i][1], "lanelet " + id),
                             center.widths, id);
      auto& lane = plan.sections.front().right.front();
      lane.type = lanelet.type;
      if (lanelet.speed_limit && is_speed_limit(*lanelet.speed_limit))
        lane.speed_limit = lanelet.speed_limit;
      else if (lanelet.speed_limit)
        network_.report(Severity::warning, i,
                        "its limit of " + cambium::detail::rounded_text(*lanelet.speed_limit) +
                            " m/s is not between 0.1 and 200 m/s, and counts as none");
      if (auto const junction = network_.junction_of[i]; junction != LaneletNetwork::nobody) {
        auto const [at, is_new] = junctions_.try_emplace(junction);
        if (is_new) at->second = builder_.add_junction("junction " + plan.id);
        plan.junction = at->second;
      }
      auto elevation = elevation_along(plan.line, center.heights);
      (void)builder_.add_road(std::move(plan));
      if (!elevation.empty()) builder_.road(id).elevation = std::move(elevation);
      for (auto& written : builder_.road(id).lane_sections.front().lanes) {
        if (written.id == 0) continue;
        written.line = lanelet.line;
        if (lanelet.both_directions) written.direction = opendrive::LaneDirection::both;
      }
      of_road_.push_back(i);
    } catch (MapError const& problem) {
      network_.report(Severity::warning, i, std::string(problem.what()) + "; the lanelet was left out");
    }
  }

  /// Who goes before whom within junctions.
  void add_priorities() {
    std::map<std::int64_t, std::size_t> places;
    for (std::size_t i = 0; i < network_.lanelets.size(); ++i) places.emplace(network_.lanelets[i].id, i);
    auto& made = builder_.document().junctions;
    std::map<std::string, std::size_t> numbers;
    for (std::size_t k = 0; k < made.size(); ++k) numbers.emplace(made[k].id, k);
    for (std::size_t i = 0; i < network_.lanelets.size(); ++i)
      for (auto const other : network_.lanelets[i].goes_before) {
        auto const at = places.find(other);
        auto const junction = network_.junction_of[i];
        auto const id = junctions_.find(junction);
        if (at == places.end() || id == junctions_.end() || network_.junction_of[at->second] != junction)
          network_.report(Severity::info, i,
                          "it goes before lanelet " + std::to_string(other) +
                              ", with which it shares no junction; that priority was ignored");
        else
          made[numbers.at(id->second)].priorities.push_back({name_of(network_.lanelets[i].id), name_of(other)});
      }
  }

  [[nodiscard]] Lane& lane_of(LaneletNetwork::Way way) {
    auto& lane = parts_->lanes[index_of(lanes_[way.lanelet])];
    return way.backwards ? parts_->lanes[index_of(lane.opposite)] : lane;
  }

  /// Which lanes the lanelets have become, and gives these their borders.
  void find_lanes() {
    lanes_.assign(network_.lanelets.size(), none<LaneId>);
    for (auto& lane : parts_->lanes) {
      auto const i = of_road_[index_of(lane.road)];
      if (lane.along_road) lanes_[i] = lane.id;
      auto left = network_.lanelets[i].left, right = network_.lanelets[i].right;
      if (!lane.along_road) {
        std::reverse(left.begin(), left.end());
        std::reverse(right.begin(), right.end());
        std::swap(left, right);
      }
      lane.left = geometry::Line::from_points(left);
      lane.right = geometry::Line::from_points(right);
    }
  }

  /// Reports a path that leaves the room between its bounds, as where these narrow and turn at once.
  void report_outside(Lane const& lane) {
    constexpr double most = 0.3, spacing = 1.0;  // [m]
    constexpr int steps = 200;
    if (!lane.drivable() || !lane.along_road) return;
    auto ring = lane.left.points(), right = lane.right.points();
    ring.insert(ring.end(), right.rbegin(), right.rend());
    double farthest = most, where = 0.0;
    int const count = std::clamp(static_cast<int>(lane.length() / spacing), 1, steps);
    for (int k = 0; k <= count; ++k) {
      double const s = lane.length() * k / count;
      Point const p = lane.path.pose(s).position();
      if (is_within(ring, p)) continue;
      double const away = std::min(distance_to(ring, p), distance_to(std::array{ring.front(), ring.back()}, p));
      if (away > farthest) std::tie(farthest, where) = std::pair(away, s);
    }
    if (farthest > most)
      network_.report(Severity::warning, of_road_[index_of(lane.road)],
                      "its path leaves its bounds by " + cambium::detail::rounded_text(std::round(farthest * 10) / 10) +
                          " m, " + cambium::detail::rounded_text(std::round(where)) + " m from its begin");
  }

  void report_kink(std::size_t i, Lane const& lane, Lane const& next) {
    constexpr double most = 0.5;  // [rad]
    double const kink =
        std::abs(geometry::angle_difference(next.path.begin_pose().heading, lane.path.end_pose().heading));
    if (kink > most)
      network_.report(Severity::warning, i,
                      "lanelet " + std::to_string(network_.lanelets[of_road_[index_of(next.road)]].id) + " continues " +
                          cambium::detail::rounded_text(std::round(kink * 100) / 100) +
                          " rad off its direction; the link was kept");
  }

  void link() {
    for (auto const& [from, to] : network_.links)
      if (is_valid(lanes_[from.lanelet]) && is_valid(lanes_[to.lanelet])) {
        auto &before = lane_of(from), &behind = lane_of(to);
        before.successors.push_back(behind.id);
        behind.predecessors.push_back(before.id);
        if (!from.backwards && !to.backwards && before.drivable() && !network_.inferred.contains({from, to}))
          report_kink(from.lanelet, before, behind);
      }
    for (auto& lane : parts_->lanes) {
      std::sort(lane.successors.begin(), lane.successors.end());
      std::sort(lane.predecessors.begin(), lane.predecessors.end());
    }
  }

  /// The stretches of the lane of lanelet `i` beside which its neighbour's bound `line` runs.
  [[nodiscard]] std::vector<PathStretch> stretches_beside(std::size_t i, bool on_left,
                                                          std::vector<Point> const& line) const {
    auto const& lane = parts_->lanes[index_of(lanes_[i])];
    auto const& center = network_.centers[i];
    std::vector<PathStretch> stretches;
    for (auto const& [first, last] : places_beside(center, on_left, line)) {
      auto const place = [&](std::size_t k) {
        return std::clamp(lane.path.project(center.points[k]).s, 0.0, lane.length());
      };
      stretches.push_back(
          {first == 0 ? 0.0 : place(first), last + 1 == center.points.size() ? lane.length() : place(last)});
    }
    return stretches;
  }

  /// Enters the right neighbour of a lanelet.
  void put_beside(std::size_t i) {
    auto const k = network_.right_of[i];
    if (k == LaneletNetwork::nobody || !is_valid(lanes_[k])) return;
    auto const &left = network_.lanelets[i], &right = network_.lanelets[k];
    auto &own = lane_of({i}), &other = lane_of({k});
    if (own.drivable() != other.drivable() && (own.type == LaneType::bus || other.type == LaneType::bus))
      return network_.report(
          Severity::info, i,
          "it or its neighbour " + std::to_string(right.id) + " is for buses; nobody changes lanes between them");
    if (!own.drivable() || !other.drivable()) return;
    if (is_valid(own.opposite) || is_valid(other.opposite))
      return network_.report(Severity::info, i,
                             "it or its neighbour " + std::to_string(right.id) +
                                 " is driven both ways; nobody changes lanes between them");
    own.right_neighbor = other.id;
    other.left_neighbor = own.id;
    if (left.may_change_right) own.right_changes = stretches_beside(i, false, right.left);
    if (right.may_change_left) other.left_changes = stretches_beside(k, true, left.right);
  }

  void add_signals(std::size_t i) {
    auto& lane = lane_of({i});
    for (auto const& signal : network_.lanelets[i].signals) {
      LaneSignal written{std::clamp(lane.length() - signal.before_end, 0.0, lane.length()), signal.kind};
      if (signal.kind == SignalKind::light) {
        auto const [at, is_new] = lights_.try_emplace(signal.light, static_cast<LightId>(parts_->lights.size()));
        if (is_new) parts_->lights.push_back({at->second, signal.light});
        written.light = at->second;
      }
      lane.signals.push_back(written);
    }
    cambium::detail::stable_sort(lane.signals, [](LaneSignal const& s) { return std::tuple(s.s, s.kind, s.light); });
  }

  Findings findings_;
  LaneletNetwork network_;
  MapBuilder builder_;
  Map::Parts* parts_ = nullptr;
  std::vector<std::size_t> of_road_;              ///< the lanelet of each road
  std::vector<LaneId> lanes_;                     ///< of each lanelet; none: left out
  std::map<std::size_t, std::string> junctions_;  ///< by `LaneletNetwork::junction_of`
  std::map<std::string, LightId> lights_;
};

}  // namespace detail

CAMBIUM_COLD LaneletMap build_lanelet_map(std::vector<Lanelet> lanelets, MapOptions const& options,
                                          std::string const& file, std::vector<Diagnostic> found) {
  auto result = detail::LaneletMapMaker(std::move(lanelets), file, found).make(options);
  result.diagnostics = std::move(found);
  return result;
}

CAMBIUM_COLD double distance_before_end(Lanelet const& lanelet, geometry::Point const& place) {
  if (detail::fault_of_bound(lanelet.left) != nullptr || detail::fault_of_bound(lanelet.right) != nullptr) return 0.0;
  detail::FacingBounds const bounds(lanelet);
  if (!((place - bounds.middle(0.0)).norm() <= bounds.length())) return 0.0;
  double nearest = std::numeric_limits<double>::infinity(), share = 1.0;
  for (std::size_t i = 0; i + 1 < bounds.shares.size(); ++i) {
    double const u = bounds.shares[i], v = bounds.shares[i + 1];
    geometry::Point const from = bounds.middle(u), way = bounds.middle(v) - from;
    double const along = std::clamp((place - from).dot(way) / std::max(way.squaredNorm(), 1e-12), 0.0, 1.0);
    double const away = (place - from - along * way).norm();
    if (away < nearest) std::tie(nearest, share) = std::pair(away, u + along * (v - u));
  }
  return std::round((1.0 - share) * bounds.length() * 1e6) * 1e-6;
}

CAMBIUM_COLD std::optional<std::array<geometry::Point, 2>> line_before_end(Lanelet const& lanelet, double distance) {
  if (detail::fault_of_bound(lanelet.left) != nullptr || detail::fault_of_bound(lanelet.right) != nullptr) return {};
  detail::FacingBounds const bounds(lanelet);
  double const share = std::clamp(1.0 - distance / bounds.length(), 0.0, 1.0);
  return std::array{bounds.left.at(share), bounds.right.at(share)};
}

CAMBIUM_COLD std::vector<Lanelet> lanelets_of(Map const& map, std::int64_t first_id) {
  return detail::LanesAsLanelets(map, first_id).make();
}

}  // namespace cambium::inline v0_1::map
