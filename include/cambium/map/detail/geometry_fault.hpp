#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/map/road/reference_line.hpp"

namespace cambium::inline v0_1::map::detail {

/// Why a geometry is unusable for driving or computing; null where nothing is wrong. Length 0 is no fault.
[[nodiscard]] inline char const* fault_of(Geometry const& g) {
  constexpr double farthest = 1e8, longest = 1e6;  // [m]: beyond any map
  constexpr double most_turn = 100.0;              // [rad]: more than any ramp winds
  auto const within = [](double value, double bound) { return std::abs(value) <= bound; };  // false for no number
  if (g.length < 0.0) return "the length is negative";
  bool const is_cubic = g.kind == GeometryKind::cubic;
  if (is_cubic && (g.cubic == nullptr || !(g.length > 0.0))) return "it is a cubic without its curve or its length";
  bool const is_far = is_cubic && !(within(g.cubic->length(), longest) && within(g.cubic->u()[0], farthest) &&
                                    within(g.cubic->v()[0], farthest));
  if (is_far || !within(g.x, farthest) || !within(g.y, farthest) || !within(g.s, longest) || !within(g.length, longest))
    return "a coordinate lies beyond 100 000 km or a length beyond 1000 km, or is not finite";
  if (!within(g.heading, 1e4)) return "hdg is beyond 10 000 rad, or not finite";
  if (!std::isfinite(g.curvature_start) || !std::isfinite(g.curvature_end)) return "the curvature is not finite";
  if (!(std::max(std::abs(g.curvature_start), std::abs(g.curvature_end)) * g.length < most_turn))
    return "the curve turns by more than 100 rad";
  return nullptr;
}

}  // namespace cambium::inline v0_1::map::detail
