#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/building/detail/section_sampler.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/road/road.hpp"

namespace cambium::inline v0_1::map::detail {

/// The place of the lane `number` among those of its section.
[[nodiscard]] inline std::size_t column_of(RoadSection const& section, int number) {
  return static_cast<std::size_t>(std::find_if(section.lanes.begin(), section.lanes.end(),
                                               [number](RoadLane const& lane) { return lane.number == number; }) -
                                  section.lanes.begin());
}

/// Fills a lane's path, widths, stations and borders from cross-sections: column `column` of the section.
/// `path_of(cross)` gives the path's lateral coordinate. False where the lane has no length (its inner side
/// degenerates, or the section is shorter than a micrometre).
template <class PathOf>
[[nodiscard]] bool set_geometry(Lane& lane, std::span<CrossSection const> sections, std::size_t column,
                                PathOf const& path_of) {
  std::vector<geometry::LineSample> path, left, right;
  std::vector<SideWidths> widths;
  std::vector<double> stations;
  constexpr double kink = 1e-3;  // [m]
  bool folded = false;
  auto const add_if_apart = [](std::vector<geometry::LineSample>& samples, geometry::LineSample const& p) {
    if (!samples.empty() && portable::hypot(p.x - samples.back().x, p.y - samples.back().y) < 1e-6) return false;
    samples.push_back(p);
    return true;
  };
  auto const add = [&](CrossSection const& cross) {
    auto const on_path = path_of(cross);
    auto at = [&](Lateral const& l) {
      auto p = cross.at(l);
      if (!lane.along_road) p.heading += geometry::pi;
      return p;
    };
    auto const &high = cross.borders[column], &low = cross.borders[column + 1];
    auto p = at(on_path);
    bool const is_new = path.empty() || portable::hypot(p.x - path.back().x, p.y - path.back().y) >= 1e-6;
    bool const folds = path.size() > 1 && is_new && !geometry::goes_on(path.back(), p);
    if (folds && !folded) {  // beside a kink: it turns there, and goes on where it is ahead again
      p.x = path.back().x + kink * portable::cos(p.heading);
      p.y = path.back().y + kink * portable::sin(p.heading);
    }
    if (is_new && !(folds && folded)) {
      path.push_back(p);
      double const above = high.t - on_path.t, below = on_path.t - low.t;
      widths.push_back(lane.along_road ? SideWidths{above, below} : SideWidths{below, above});
      stations.push_back(cross.s);
    }
    folded = folds;
    add_if_apart(left, at(lane.along_road ? high : low));
    add_if_apart(right, at(lane.along_road ? low : high));
  };
  if (lane.along_road)
    std::for_each(sections.begin(), sections.end(), add);
  else
    std::for_each(sections.rbegin(), sections.rend(), add);
  if (path.size() < 2) return false;
  lane.path = geometry::Line::from_samples(path);
  lane.widths = std::move(widths);
  lane.stations = std::move(stations);
  lane.left = left.size() > 1 ? geometry::Line::from_samples(left) : geometry::Line{};
  lane.right = right.size() > 1 ? geometry::Line::from_samples(right) : geometry::Line{};
  return true;
}

/// 0 to 1 with first and second derivative 0 at both ends, and its derivative.
struct Smoothstep {
  double value{}, slope{};
  explicit Smoothstep(double u) {
    u = std::clamp(u, 0.0, 1.0);
    value = u * u * u * (10 + u * (6 * u - 15));
    slope = 30 * u * u * (1 - u) * (1 - u);
  }
};

/// The path of a lane that swings onto the neighbour in column `target` between the road stations `from` and `to` (in
/// the direction of travel: `from` > `to` on a lane driven against the road).
[[nodiscard]] inline Lateral merging_path(CrossSection const& cross, std::size_t column, std::size_t target,
                                          double from, double to) {
  auto const own = cross.center(column), other = cross.center(target);
  Smoothstep const w((cross.s - from) / (to - from));
  return {own.t + w.value * (other.t - own.t),
          own.slope + w.value * (other.slope - own.slope) + w.slope / (to - from) * (other.t - own.t), 0.0};
}

/// Where a lane begins to narrow towards its end, as a road station; `longest` [m] before the end where it does not
/// narrow.
[[nodiscard]] inline double taper_begin(SectionSampler const& sampler, std::size_t column, bool along_road,
                                        double longest) {
  auto const sections = sampler.sample();
  auto const width = [&](CrossSection const& c) { return c.borders[column].t - c.borders[column + 1].t; };
  double widest = 0.0;
  for (auto const& cross : sections) widest = std::max(widest, width(cross));
  auto const& end = along_road ? sections.back() : sections.front();
  double const begin_of_lane = along_road ? sections.front().s : sections.back().s;
  double begin = end.s;
  if (widest > 0.0 && width(end) < 0.5 * widest) {
    // From the end backwards to where it has 95 % of its width.
    double const wide = 0.95 * widest;
    auto const crossing = [&](double narrow, double broad) {
      while (std::abs(narrow - broad) > 1e-4) {
        double const middle = 0.5 * (narrow + broad);
        (width(sampler.at(middle)) > wide ? broad : narrow) = middle;
      }
      return broad;
    };
    auto const last = sections.size() - 1;
    for (std::size_t i = 1; i <= last; ++i) {
      auto const &narrow = along_road ? sections[last - i + 1] : sections[i - 1],
                 &c = along_road ? sections[last - i] : sections[i];
      if (!(width(c) > wide)) continue;
      begin = crossing(narrow.s, c.s);
      break;
    }
  }
  constexpr double shortest = 30.0;  // [m] a swing shorter than this is no longer comfortable
  double const length =
      1.3 * std::abs(end.s - begin);  // begins a little before the lane narrows: long vehicles need the room
  double const swing = length == 0.0 ? longest : std::clamp(length, shortest, std::max(shortest, longest));
  double const available = std::abs(end.s - begin_of_lane);
  return along_road ? end.s - std::min(swing, available) : end.s + std::min(swing, available);
}

/// The curves that lanes' paths are samples of. Looks at the roads, lanes and options that it is made with.
class ExactPaths {
 public:
  ExactPaths(std::span<Road const> roads, std::span<Lane const> lanes, MapOptions const& options)
      : roads_(roads), lanes_(lanes), options_(options) {}

  /// The place on the exact path, with the direction of travel, at the station of path position `s` [m]. O(lanes of the
  /// section), each a binary search.
  [[nodiscard]] geometry::Pose at(Lane const& lane, double s) const {
    auto const& road = roads_[index_of(lane.road)];
    auto const& section = road.sections[lane.section];
    auto const column = column_of(section, lane.number);
    auto const cross = SectionSampler(road, section, options_).at(lane.station_at(s));
    auto course = cross.center(column);
    if (is_valid(lane.merges_into)) {
      auto const target = column_of(section, lanes_[index_of(lane.merges_into)].number);
      double const from = lane.station_at(lane.merge_begin), to = lane.along_road ? section.end : section.begin;
      course = merging_path(cross, column, target, from, to);
    }
    auto pose = cross.at(course);
    if (!lane.along_road) pose.heading += geometry::pi;
    return pose;
  }

 private:
  std::span<Road const> roads_;
  std::span<Lane const> lanes_;
  MapOptions const& options_;
};

}  // namespace cambium::inline v0_1::map::detail
