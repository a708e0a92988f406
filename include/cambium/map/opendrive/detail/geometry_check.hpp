#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "cambium/core/error.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/reference_line.hpp"

namespace cambium::inline v0_1::map::detail {

using cambium::detail::rounded_text;

/// Checks that the geometries of a road join.
class GeometryCheck {
 public:
  GeometryCheck(opendrive::RoadElement const& road, Findings& findings) : road_(road), findings_(findings) {}

  /// Reports geometries that do not begin where the previous one ends. False where the road is unusable: a geometry is
  /// far off, or there is no telling what the curve does in the gap.
  [[nodiscard]] bool is_continuous() {
    if (!begins_and_ends()) return false;
    double widest = 0.0;  // of the slight ones
    int slight_ones = 0, slight_line = 0;
    for (std::size_t i = 1; i < road_.geometries.size(); ++i) {
      auto const gap = slight_gap(i);
      if (!gap) return false;
      slight_ones += *gap > slight;
      if (*gap <= std::max(slight, widest)) continue;
      widest = *gap;
      slight_line = road_.geometry_lines[i];
    }
    if (slight_ones > 0)
      warn(slight_line,
           "it starts " + rounded_text(widest) + " m off the end of the previous geometry" +
               (slight_ones > 1 ? " (and " + std::to_string(slight_ones - 1) + " others a little less)" : ""));
    return true;
  }

 private:
  static constexpr double slight = 1e-3;      // [m]
  static constexpr double most_turn = 200.0;  // [rad]: more than any ramp winds, little enough for looking at all laps

  bool lose(std::size_t geometry, std::string const& what) {
    warn(road_.geometry_lines[geometry], what + "; the road was left out");
    return false;
  }

  /// Whether the geometries have a length and begin where the road does.
  [[nodiscard]] bool begins_and_ends() {
    if (!(road_.geometry_length() > 0.0))
      return lose(road_.geometries.size() - 1, "the geometries end at " + rounded_text(road_.geometry_length()) + " m");
    double const first_s = road_.geometries.front().s;
    if (turn_beyond(road_.geometries.front(), 0.0, first_s) > 1.0)
      return lose(0, "the road has no geometry before " + rounded_text(first_s) + " m");
    if (std::abs(first_s) > slight)
      warn(road_.geometry_lines[0],
           "the first geometry starts at " + rounded_text(first_s) + " m, not at 0; the road starts at 0 all the same");
    double heading = 0.0, least = 0.0, most = 0.0;
    for (auto const& g : road_.geometries) {
      heading += 0.5 * (g.curvature_start + g.curvature_end) * g.length;
      least = std::min(least, heading);
      most = std::max(most, heading);
    }
    if (most - least > most_turn)
      return lose(0, "the road winds around itself by " + rounded_text(most - least) + " rad");
    return true;
  }

  /// How far geometry `i` starts from the end of the one before [m], where that is hardly noticeable; 0 where it is,
  /// and reported; nothing where the road is lost.
  [[nodiscard]] std::optional<double> slight_gap(std::size_t i) {
    constexpr double noticeable = 0.1, bearable = 100.0;  // [m]; `noticeable` also [rad]
    Geometry const &before = road_.geometries[i - 1], &next = road_.geometries[i];
    auto const nothing = [&](std::string const& what) {
      lose(i, what);
      return std::nullopt;
    };
    double const missing = next.s - before.s - before.length;
    if (turn_beyond(before, before.length, missing) > 1.0)
      return nothing("there is no geometry for " + rounded_text(missing) + " m before it");
    CurvePoint const end = evaluate(before, before.length);
    CurvePoint const start =
        next.kind == GeometryKind::cubic ? evaluate(next, 0.0) : CurvePoint{next.x, next.y, next.heading};
    double const gap = portable::hypot(start.x - end.x, start.y - end.y);
    double const turn = std::abs(geometry::angle_difference(start.heading, end.heading));
    if (gap <= noticeable && turn <= noticeable) return gap;
    std::string const sentence =
        "it starts " + rounded_text(gap) + " m and " + rounded_text(turn) + " rad off the end of the previous geometry";
    if (gap > bearable) return nothing(sentence);
    warn(road_.geometry_lines[i], sentence);
    return 0.0;
  }

  /// How far a geometry turns where it is continued for `distance` [m] from `end` (its own begin or end) [rad].
  [[nodiscard]] static double turn_beyond(Geometry const& g, double end, double distance) {
    double const rate = std::abs(curvature_rate(g)),
                 curvature = std::abs(end > 0.0 ? g.curvature_end : g.curvature_start);
    return distance > 0.0 ? distance * (curvature + 0.5 * rate * distance) : 0.0;
  }

  void warn(int line, std::string sentence) {
    findings_.add(Severity::warning, line, "geometry", "road " + road_.id, std::move(sentence));
  }

  opendrive::RoadElement const& road_;
  Findings& findings_;
};

}  // namespace cambium::inline v0_1::map::detail
