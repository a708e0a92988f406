#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/road/cubic.hpp"
#include "cambium/map/road/reference_line.hpp"
#include "cambium/map/road/road.hpp"

/// From exact roads to sampled lanes. The borders of a section's lanes are curves t(s) beside the reference line, given
/// by cubics. All lanes of a section are sampled at the same stations, in cross-sections, so that neighbours share the
/// points of their common border.
///
///     left border    o-----o-----------o---o--o       a cross-section is one column; where the road bends or a lane
///     border         o-----o-----------o---o--o       widens, columns are closer together
///     right border   o-----o-----------o---o--o
///
/// Where a geometry or a record begins, there is always a cross-section. Between two of these breaks the curves are
/// smooth, and an interval is halved until every border and centre line keeps within the tolerances of its chord, in
/// position and in heading. A step or a kink at a break gets a second cross-section a millimetre before it.
namespace cambium::inline v0_1::map::detail {

/// The cross-section of a road at one station: the reference line and the t of every lane border, from left to right.
struct CrossSection {
  double s{};
  CurvePoint reference;
  portable::SinCos direction;  ///< of the reference line
  std::vector<Lateral> borders;

  /// Point and direction of the curve at `lateral` (with the curve's slope and the factor 1 - curvature t).
  [[nodiscard]] geometry::LineSample at(Lateral const& lateral) const {
    double const turn = portable::atan2(lateral.slope, 1.0 - reference.curvature * lateral.t);
    return {reference.x - direction.sin * lateral.t, reference.y + direction.cos * lateral.t, reference.heading + turn};
  }
  /// Middle between border `i` and the next.
  [[nodiscard]] Lateral center(std::size_t i) const { return 0.5 * (borders[i] + borders[i + 1]); }
};

/// Samples a lane section so that the lanes' centre lines and borders keep within the tolerances between two stations.
class SectionSampler {
 public:
  SectionSampler(Road const& road, RoadSection const& section, MapOptions const& options)
      : road_(road), section_(section), options_(options) {
    left_lanes_ = static_cast<std::size_t>(std::count_if(section.lanes.begin(), section.lanes.end(),
                                                         [](RoadLane const& lane) { return lane.number > 0; }));
  }

  /// Cross-sections from the section's begin to its end, ends included; every place where a record or a geometry begins
  /// is among them.
  [[nodiscard]] std::vector<CrossSection> sample() const { return sample(0.0, 0.0, 0.0); }

  /// The exact cross-section at station `s` [m], the nearest of the section where it lies outside.
  [[nodiscard]] CrossSection at(double s) const {
    s = std::clamp(s, section_.begin, std::nextafter(section_.end, section_.begin));
    return cross_section(s, s);
  }

  /// As above; between the stations `from` and `to` no two are farther apart than `longest` [m].
  [[nodiscard]] std::vector<CrossSection> sample(double longest, double from, double to) const {
    auto const breaks = break_points();
    std::vector<CrossSection> result;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
      double const inside = 0.5 * (breaks[i] + breaks[i + 1]);
      auto at = cross_section(breaks[i], inside);
      auto const last = cross_section(breaks[i + 1], inside, &at);
      if (i > 0) add_before_break(breaks[i], breaks[i - 1], at, result);
      result.push_back(at);
      double const dense_begin = std::max(breaks[i], from), dense_end = std::min(breaks[i + 1], to);
      for (int k = 0; longest > 0.0 && dense_begin + k * longest < dense_end; ++k) {
        double const s = dense_begin + k * longest;
        if (s - at.s < 1e-6 || breaks[i + 1] - s < 1e-6) continue;
        auto const next = cross_section(s, inside, &at);
        refine(at, next, inside, 0, result);
        result.push_back(next);
        at = next;
      }
      refine(at, last, inside, 0, result);
      if (i + 2 == breaks.size()) result.push_back(last);
    }
    return result;
  }

 private:
  [[nodiscard]] std::vector<double> break_points() const {
    std::vector<double> points{section_.begin, section_.end};
    auto const add = [&](double s) {
      if (s > section_.begin && s < section_.end) points.push_back(s);
    };
    auto const add_those_inside = [&](auto records) {  // a road may have thousands, and as many sections
      auto at = std::partition_point(records.begin(), records.end(),
                                     [&](auto const& record) { return record.s <= section_.begin; });
      for (; at != records.end() && at->s < section_.end; ++at) points.push_back(at->s);
    };
    add_those_inside(road_.reference_line.geometries());
    add_those_inside(road_.lane_offset.records());
    for (auto const& lane : section_.lanes)
      for (auto const* profile : {&lane.width, &lane.border})
        for (auto const& record : profile->records()) add(section_.begin + record.s);
    std::sort(points.begin(), points.end());
    // Breaks closer than a micrometre are one: there is nothing between them to sample.
    std::vector<double> result{points.front()};
    for (double const s : points)
      if (s - result.back() > 1e-6 && section_.end - s > 1e-6) result.push_back(s);
    result.push_back(section_.end);
    return result;
  }

  /// The cross-section at `s` by the records in force at `inside`; `near` is one of those, of the same interval between
  /// breaks: from there a spiral is not far.
  [[nodiscard]] CrossSection cross_section(double s, double inside, CrossSection const* near = nullptr) const {
    auto const& line = road_.reference_line;
    auto const& g = line.geometries()[line.locate(inside)];
    CrossSection cross{s,
                       near != nullptr ? advance(g, near->reference, near->s, s) : evaluate(g, s - g.s),
                       {},
                       std::vector<Lateral>(section_.lanes.size() + 1)};
    cross.direction = portable::sin_cos(cross.reference.heading);
    cross.borders[left_lanes_] = lateral_at(road_.lane_offset, s, inside);
    double const ds = s - section_.begin, at = inside - section_.begin;
    for (std::size_t i = left_lanes_; i-- > 0;)
      cross.borders[i] = clamped_outer_border(section_.lanes[i], cross.borders[i + 1], ds, at);
    for (std::size_t i = left_lanes_; i < section_.lanes.size(); ++i)
      cross.borders[i + 1] = clamped_outer_border(section_.lanes[i], cross.borders[i], ds, at);
    return cross;
  }

  /// Where a line has a kink or a step at `s`, after which the cross-section is `behind`, adds a station a little
  /// before `s`: so only these last millimetres are interpolated between the two sides.
  void add_before_break(double s, double last_break, CrossSection const& behind,
                        std::vector<CrossSection>& result) const {
    constexpr double little = 1e-3;  // [m]
    double const inside = 0.5 * (last_break + s);
    if (s - result.back().s < 2.0 * little) return;
    auto const end = cross_section(s, inside);
    for (std::size_t i = 0; i < end.borders.size(); ++i)
      if (breaks(end.at(end.borders[i]), behind.at(behind.borders[i])) ||
          (i + 1 < end.borders.size() && breaks(end.at(end.center(i)), behind.at(behind.center(i))))) {
        result.push_back(cross_section(s - little, inside));
        return;
      }
  }

  [[nodiscard]] bool breaks(geometry::LineSample const& a, geometry::LineSample const& b) const {
    return portable::hypot(b.x - a.x, b.y - a.y) > 0.3 * options_.position_tolerance ||
           std::abs(geometry::angle_difference(b.heading, a.heading)) > options_.heading_tolerance;
  }

  /// How far `m` is from the chord from `a` to `b` [m].
  [[nodiscard]] static double off_chord(geometry::LineSample const& a, geometry::LineSample const& m,
                                        geometry::LineSample const& b) {
    double const dx = b.x - a.x, dy = b.y - a.y, chord = portable::hypot(dx, dy);
    return chord > 1e-9 ? std::abs(dx * (m.y - a.y) - dy * (m.x - a.x)) / chord : portable::hypot(m.x - a.x, m.y - a.y);
  }

  /// Whether a straight chord from `a` to `b` is good enough for a curve through `m`.
  [[nodiscard]] bool fits(geometry::LineSample const& a, geometry::LineSample const& m,
                          geometry::LineSample const& b) const {
    double const turn = geometry::angle_difference(b.heading, a.heading);
    // The middle is where an arc is farthest from its chord; the margin covers curves that are not arcs.
    return is_near(a, m, b) && std::abs(turn) <= MapOptions::turn_per_tolerance * options_.heading_tolerance &&
           std::abs(geometry::angle_difference(m.heading, a.heading) - 0.5 * turn) <= 0.7 * options_.heading_tolerance;
  }

  [[nodiscard]] bool fits(CrossSection const& a, CrossSection const& m, CrossSection const& b) const {
    for (std::size_t i = 0; i < a.borders.size(); ++i) {
      if (!fits(a.at(a.borders[i]), m.at(m.borders[i]), b.at(b.borders[i]))) return false;
      if (i + 1 < a.borders.size() && !fits(a.at(a.center(i)), m.at(m.center(i)), b.at(b.center(i)))) return false;
    }
    return true;
  }

  /// Appends the stations needed strictly between `a` and `b`.
  void refine(CrossSection const& a, CrossSection const& b, double inside, int depth,
              std::vector<CrossSection>& result) const {
    if (depth > 16 || b.s - a.s < 1e-3 || straight(a.s, b.s, inside)) return;
    auto const middle = cross_section(0.5 * (a.s + b.s), inside, &a);
    bool const has_room_to_wind = depth == 0 && b.s - a.s > 40.0;  // its middle alone says too little
    if (!has_room_to_wind && !winds(a, b) && fits(a, middle, b) && (bends_evenly(inside) || quarters_fit(a, b, inside)))
      return;
    refine(a, middle, inside, depth + 1, result);
    result.push_back(middle);
    refine(middle, b, inside, depth + 1, result);
  }

  /// Whether the road turns so far from `a` to `b` that headings and places may come again. Exact but for cubics, which
  /// turn less than once.
  [[nodiscard]] static bool winds(CrossSection const& a, CrossSection const& b) {
    double const sharpest = std::max(std::abs(a.reference.curvature), std::abs(b.reference.curvature));
    return sharpest * (b.s - a.s) > 1.0;  // [rad]
  }

  /// Whether the middle alone shows how far the heading is off; not where the curve winds about its chord.
  [[nodiscard]] bool bends_evenly(double inside) const {
    auto const kind = road_.reference_line.geometries()[road_.reference_line.locate(inside)].kind;
    return (kind == GeometryKind::line || kind == GeometryKind::arc) && has_linear_borders(inside);
  }

  /// Whether the curves between `a` and `b` are near to the chords at the quarters, too, and the headings to the
  /// interpolated ones. A cubic, and what a spiral is on so short a piece, that keeps within 0.7 of the tolerance at
  /// the quarters and in the middle does so within 0.77 of it everywhere.
  [[nodiscard]] bool quarters_fit(CrossSection const& a, CrossSection const& b, double inside) const {
    for (double const u : {0.25, 0.75}) {
      auto const at = cross_section(a.s + u * (b.s - a.s), inside, &a);
      for (std::size_t i = 0; i < a.borders.size(); ++i) {
        if (!is_near(a.at(a.borders[i]), at.at(at.borders[i]), b.at(b.borders[i]))) return false;
        if (i + 1 == a.borders.size()) break;
        auto const from = a.at(a.center(i)), to = b.at(b.center(i)), here = at.at(at.center(i));
        double const turn = geometry::angle_difference(to.heading, from.heading);
        double const off = geometry::angle_difference(here.heading, from.heading) - u * turn;
        if (!is_near(from, here, to) || std::abs(off) > 0.7 * options_.heading_tolerance) return false;
      }
    }
    return true;
  }

  [[nodiscard]] bool is_near(geometry::LineSample const& a, geometry::LineSample const& m,
                             geometry::LineSample const& b) const {
    return off_chord(a, m, b) <= 0.7 * options_.position_tolerance;
  }

  [[nodiscard]] bool has_linear_borders(double inside) const {
    auto const linear = [](CubicRecord const* record) {
      return record == nullptr || (record->c == 0.0 && record->d == 0.0);
    };
    double const ds = inside - section_.begin;
    return linear(road_.lane_offset.find(inside)) &&
           std::all_of(section_.lanes.begin(), section_.lanes.end(), [&](RoadLane const& lane) {
             return linear((lane.border.empty() ? lane.width : lane.border).find(ds));
           });
  }

  /// A straight road whose widths are linear from `begin` to `end` needs no station in between.
  [[nodiscard]] bool straight(double begin, double end, double inside) const {
    auto const& line = road_.reference_line;
    if (line.geometries()[line.locate(inside)].kind != GeometryKind::line) return false;
    if (!has_linear_borders(inside)) return false;
    double const first = begin - section_.begin, last = end - section_.begin;
    return std::all_of(section_.lanes.begin(), section_.lanes.end(), [&](RoadLane const& lane) {
      auto const* record = lane.border.empty() ? lane.width.find(inside - section_.begin) : nullptr;
      return record == nullptr || (record->value(first) < 0.0) == (record->value(last) < 0.0);
    });
  }

  Road const& road_;
  RoadSection const& section_;
  MapOptions const& options_;
  std::size_t left_lanes_ = 0;
};

}  // namespace cambium::inline v0_1::map::detail
