#pragma once

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <vector>

#include "cambium/core/stable_sort.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map::detail {

/// The stop signs and lights of a corridor whose pieces are there already. One at a junction, or up to 30 m before it,
/// counts where the junction begins.
[[nodiscard]] inline std::vector<CorridorSignal> corridor_signals(Map const& map, LaneCorridor const& corridor) {
  constexpr double near = 30.0;  // [m]
  auto const& pieces = corridor.pieces;
  auto const junction = [&](std::size_t i) { return map.road(map.lane(pieces[i].lane).road).junction; };
  auto const line_of = [&](std::size_t i, double position) {
    std::size_t at = i;
    if (!is_valid(junction(at)))
      while (at + 1 < pieces.size() && !is_valid(junction(at)) && pieces[at].end < position + near) ++at;
    if (!is_valid(junction(at))) return position;
    while (at > 0 && junction(at - 1) == junction(at)) --at;
    return pieces[at].begin;
  };
  std::vector<CorridorSignal> signals;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (auto const& signal : map.lane(pieces[i].lane).signals) {
      if (signal.kind != SignalKind::stop && signal.kind != SignalKind::light) continue;
      double const position = std::clamp(signal.s - pieces[i].lane_offset, pieces[i].begin, pieces[i].end);
      signals.push_back({line_of(i, position), signal.kind, signal.light});
    }
  cambium::detail::stable_sort(signals, [](CorridorSignal const& s) { return std::tuple(s.line, s.kind, s.light); });
  signals.erase(std::unique(signals.begin(), signals.end()), signals.end());
  return signals;
}

}  // namespace cambium::inline v0_1::map::detail
