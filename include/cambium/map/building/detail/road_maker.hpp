#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/building/road_plan.hpp"
#include "cambium/map/detail/geometry_fault.hpp"
#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/cubic.hpp"
#include "cambium/map/road/lane_type.hpp"
#include "cambium/map/road/reference_line.hpp"

namespace cambium::inline v0_1::map::detail {

/// Makes a document's road from a plan. Throws `MapError`, see `MapBuilder::add_road`.
class RoadMaker {
 public:
  explicit RoadMaker(RoadPlan plan) : plan_(std::move(plan)), where_("road " + plan_.id) {}

  [[nodiscard]] opendrive::RoadElement make() {
    check_line();
    if (plan_.sections.empty() || plan_.sections.front().s != 0.0)
      fail("it has no lane section at s 0", "give sections, the first one at 0");
    check(plan_.lane_offset, "lane offset");
    check_limit(plan_.speed_limit);
    road_.id = plan_.id;
    road_.name = plan_.name;
    road_.junction = plan_.junction;
    road_.rule = plan_.rule;
    road_.geometry_lines.resize(plan_.line.size());
    road_.geometries = std::move(plan_.line);
    road_.lane_offset = std::move(plan_.lane_offset);
    road_.length = road_.geometry_length();
    if (!plan_.type.empty() || plan_.speed_limit) {
      road_.types.emplace_back();
      road_.types.back().type = plan_.type;
      road_.types.back().limit = plan_.speed_limit;
    }
    for (std::size_t k = 0; k < plan_.sections.size(); ++k) add_section(k);
    for (std::size_t k = 0; k + 1 < plan_.sections.size(); ++k) link_section(k);
    return std::move(road_);
  }

 private:
  [[noreturn]] void fail(std::string const& what, std::string const& remedy) const {
    throw MapError(where_, what, remedy);
  }

  /// Each geometry begins where the previous one ends, up to the rounding of files.
  void check_line() const {
    constexpr double tolerance = 0.01;  // [m], [rad]
    char const* const remedy = "lay out a line, see lay_from";
    if (plan_.line.empty()) fail("it has no geometry", remedy);
    double end = 0.0;
    std::optional<CurvePoint> before;
    for (std::size_t i = 0; i < plan_.line.size(); ++i) {
      auto const& g = plan_.line[i];
      std::string const which = "geometry " + std::to_string(i);
      if (!(g.length > 0.0)) fail(which + " has no length", remedy);
      if (auto const* const fault = fault_of(g)) fail(which + ": " + fault, remedy);
      if (!(std::abs(g.s - end) <= tolerance))
        fail(which + " is at s " + cambium::detail::rounded_text(g.s) + " m instead of " +
                 cambium::detail::rounded_text(end) + " m, where the previous one ends",
             remedy);
      auto const begin = evaluate(g, 0.0);
      double const gap = before ? portable::hypot(begin.x - before->x, begin.y - before->y) : 0.0;
      double const turn = before ? std::abs(geometry::angle_difference(begin.heading, before->heading)) : 0.0;
      if (!(gap <= tolerance && turn <= tolerance))
        fail(which + " begins " + cambium::detail::rounded_text(gap) + " m and " + cambium::detail::rounded_text(turn) +
                 " rad from where the previous one ends",
             remedy);
      before = evaluate(g, g.length);
      end = g.s + g.length;
    }
  }

  /// Records are finite, in the order of s and not before 0.
  void check(std::vector<CubicRecord> const& records, std::string const& of) const {
    for (std::size_t i = 0; i < records.size(); ++i) {
      auto const& r = records[i];
      std::string const which = of + " record " + std::to_string(i);
      if (!is_finite(r)) fail(which + " is not finite", "give finite numbers");
      if (!(i > 0 ? r.s > records[i - 1].s : r.s >= 0.0))
        fail(which + " is at s " + cambium::detail::rounded_text(r.s) + " m, not after " +
                 (i > 0 ? "the previous one, at " + cambium::detail::rounded_text(records[i - 1].s) + " m" : "0"),
             "give records in the order of s");
    }
  }

  void check_limit(std::optional<double> const& limit) const {
    if (limit && !(*limit >= 0.0)) fail("a speed limit is negative or not a number", "give it in m/s");
  }

  void add_section(std::size_t k) {
    auto const& section = plan_.sections[k];
    double const end = k + 1 < plan_.sections.size() ? plan_.sections[k + 1].s : road_.length;
    if (!(section.s >= 0.0 && section.s < end))
      fail("section " + std::to_string(k) + " does not begin before the next one or the road's end, " +
               cambium::detail::rounded_text(end) + " m",
           "give sections in the order of s, on the road");
    opendrive::LaneSection result;
    result.s = section.s;
    for (std::size_t i = section.left.size(); i-- > 0;)
      result.lanes.push_back(lane(section.left, i, 1, end - section.s));
    result.lanes.push_back({});
    result.lanes.back().road_marks.push_back(
        section.middle_mark.value_or(make_mark("solid", opendrive::LaneChangePermission::none)));
    for (std::size_t i = 0; i < section.right.size(); ++i)
      result.lanes.push_back(lane(section.right, i, -1, end - section.s));
    road_.lane_sections.push_back(std::move(result));
  }

  [[nodiscard]] opendrive::LaneElement lane(std::vector<LanePlan> const& side, std::size_t i, int sign,
                                            double length) const {
    auto const& plan = side[i];
    check_limit(plan.speed_limit);
    double const end_width = plan.end_width.value_or(plan.width);
    if (!(plan.width >= 0.0 && plan.width <= 1000.0 && end_width >= 0.0 && end_width <= 1000.0))
      fail("a lane's width is negative, beyond 1 km or not a number", "give widths in m");
    opendrive::LaneElement result;
    result.id = sign * (static_cast<int>(i) + 1);
    result.type = plan.type;
    check(plan.widths, "lane " + std::to_string(result.id) + ", width");
    result.widths = plan.widths;
    if (plan.widths.empty()) result.widths = {smooth_step(0.0, plan.width, end_width, length)};
    for (std::size_t r = 0; r < result.widths.size(); ++r) {
      double const to = r + 1 < result.widths.size() ? result.widths[r + 1].s : length;
      auto const [low, high] = extremes(result.widths[r], result.widths[r].s, to);
      if (!(low > -1e-6 && high <= 1000.0))
        fail("the width of lane " + std::to_string(result.id) + " falls below 0, or beyond 1 km",
             "give widths that do not");
    }
    if (plan.speed_limit) {
      result.speeds.emplace_back();
      result.speeds.back().limit = plan.speed_limit;
    }
    bool const inner = i + 1 < side.size() && is_drivable(plan.type) && is_drivable(side[i + 1].type);
    result.road_marks.push_back(plan.mark.value_or(inner ? make_mark("broken", opendrive::LaneChangePermission::both)
                                                         : make_mark("solid", opendrive::LaneChangePermission::none)));
    return result;
  }

  void link_section(std::size_t k) {
    auto& next = road_.lane_sections[k + 1];
    for (auto& lane : road_.lane_sections[k].lanes) {
      if (lane.id == 0) continue;
      auto const& section = plan_.sections[k];
      auto const& side = lane.id > 0 ? section.left : section.right;
      auto const& wanted = side[static_cast<std::size_t>(std::abs(lane.id)) - 1].next;
      if (wanted == 0) continue;
      auto const target = std::find_if(next.lanes.begin(), next.lanes.end(), [&](opendrive::LaneElement const& other) {
        return other.id == wanted.value_or(lane.id) && (wanted || is_drivable(other.type) == is_drivable(lane.type));
      });
      if (target == next.lanes.end() && wanted)
        fail("lane " + std::to_string(lane.id) + " of section " + std::to_string(k) + " should continue as lane " +
                 std::to_string(*wanted) + ", which the next section does not have",
             "name a lane that it has, or 0");
      if (target == next.lanes.end()) continue;
      lane.successors.push_back(target->id);
      target->predecessors.push_back(lane.id);
    }
  }

  RoadPlan plan_;
  std::string where_;
  opendrive::RoadElement road_;
};

}  // namespace cambium::inline v0_1::map::detail
