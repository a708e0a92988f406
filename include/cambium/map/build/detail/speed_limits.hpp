#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::map::detail {

/// The limit of the last of `records` that begins at `s` or before [m/s]; nothing where that one gives none or
/// nonsense.
template <class Record>
[[nodiscard]] std::optional<double> limit_in_force(std::vector<Record> const& records, double s) {
  auto const next =
      std::upper_bound(records.begin(), records.end(), s + 1e-9, [](double v, Record const& r) { return v < r.s; });
  auto const limit = next == records.begin() ? std::nullopt : (next - 1)->limit;
  return limit && *limit > 0.0 ? limit : std::nullopt;
}

/// Fills `Lane::speed_limits`: the lane's own records where one gives a limit ("no limit" is one), else the road's. Of
/// roads, a type record without a speed ends the limit before it. Call it when the paths are final.
inline void set_speed_limits(OpenDriveDocument const& document, std::span<Lane> lanes) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (auto& lane : lanes) {
    auto const& source = document.roads[index_of(lane.road)];
    auto const& section = source.lane_sections[lane.section];
    auto const& written = *section.find(lane.number);
    std::vector<double> stations{lane.road_begin};
    auto const add = [&](double s) {
      if (std::isfinite(s)) stations.push_back(s);
    };
    auto type = std::partition_point(source.types.begin(), source.types.end(),
                                     [&](auto const& t) { return t.s < lane.road_begin; });
    for (; type != source.types.end() && type->s < lane.road_end; ++type) add(type->s);
    for (auto const& speed : written.speeds) add(lane.road_begin + speed.s);
    std::sort(stations.begin(), stations.end());
    std::vector<SpeedStep> steps;
    for (std::size_t i = 0; i < stations.size(); ++i) {
      double const from = stations[i],
                   to = i + 1 < stations.size() ? std::min(stations[i + 1], lane.road_end) : lane.road_end;
      if (!(from >= lane.road_begin && to - from > 1e-6)) continue;
      auto const own = limit_in_force(written.speeds, from - lane.road_begin);
      double const limit = own ? *own : limit_in_force(source.types, from).value_or(infinity);
      steps.push_back({lane.stretch_between(from, to).begin, limit});
    }
    if (!lane.along_road) std::reverse(steps.begin(), steps.end());
    auto const same = [](SpeedStep const& a, SpeedStep const& b) { return a.limit == b.limit; };
    steps.erase(std::unique(steps.begin(), steps.end(), same), steps.end());
    if (steps.size() == 1 && steps[0].limit == infinity) steps.clear();
    lane.speed_limits = std::move(steps);
  }
}

}  // namespace cambium::map::detail
