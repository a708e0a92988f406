#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/cubic.hpp"

namespace cambium::inline v0_1::map::detail {

/// Looks at a road's records along s: leaves out, and reports, those that are beyond any road.
class RecordCheck {
 public:
  RecordCheck(opendrive::RoadElement& road, Findings& findings)
      : road_(road), findings_(findings), ids_("road " + road.id) {}

  /// Negative widths are reported, too.
  void run() {
    auto const of_road = [&] { return ids_; };
    leave_out_wild(road_.lane_offset, road_.geometry_length(), road_.line, "laneOffset", of_road);
    leave_out_wild(road_.elevation, road_.geometry_length(), road_.line, "elevation", of_road, highest);
    leave_out_wild(road_.superelevation, road_.geometry_length(), road_.line, "superelevation", of_road, steepest,
                   "rad");
    check_surface();
    for (std::size_t i = 0; i < road_.lane_sections.size(); ++i) {
      opendrive::LaneSection& section = road_.lane_sections[i];
      double const end = i + 1 < road_.lane_sections.size() ? road_.lane_sections[i + 1].s : road_.geometry_length();
      for (opendrive::LaneElement& lane : section.lanes) {
        auto const of = [&] { return ids_ + ", section " + std::to_string(i) + ", lane " + std::to_string(lane.id); };
        leave_out(lane.heights, lane.line, "height", of(), [](opendrive::HeightRecord const& height, auto const&) {
          return std::abs(height.inner) <= highest && std::abs(height.outer) <= highest;
        });
        leave_out_wild(lane.borders, end - section.s, lane.line, "border", of);
        double const lowest = leave_out_wild(lane.widths, end - section.s, lane.line, "width", of);
        if (lowest < -1e-3)
          report(lane.line, "lane", of(),
                 "its width falls to " + cambium::detail::rounded_text(lowest) + " m; below 0 it counts as 0");
      }
    }
  }

 private:
  static constexpr double highest = 1e5;    ///< [m]
  static constexpr double steepest = 10.0;  ///< [rad]

  /// Leaves out what tilts or bends the road across beyond any road.
  void check_surface() {
    constexpr double farthest = 1000.0;  // to the side [m]
    auto const keeps_within = [](CubicRecord const& record, double end, double largest) {
      auto const [low, high] = extremes(record, record.s, std::max(end, record.s));
      return low >= -largest && high <= largest;
    };
    using Crossfalls = std::span<opendrive::Crossfall const>;
    leave_out(road_.crossfall, road_.line, "crossfall", ids_,
              [&](opendrive::Crossfall const& crossfall, Crossfalls behind) {
                auto const next =
                    std::find_if(behind.begin(), behind.end(), [&](auto const& o) { return o.side == crossfall.side; });
                double const end = next != behind.end() ? next->record.s : road_.geometry_length();
                return keeps_within(crossfall.record, std::min(end, road_.geometry_length()), steepest);
              });
    using Shapes = std::span<opendrive::LateralShape const>;
    leave_out(road_.shape, road_.line, "shape", ids_, [&](opendrive::LateralShape const& shape, Shapes behind) {
      bool const is_last = behind.empty() || behind.front().s != shape.s;
      double const end = is_last ? farthest : std::min(farthest, behind.front().record.s);
      return keeps_within(shape.record, end, highest);
    });
  }

  /// Removes the records for which `keep(record, those kept after it)` is false.
  template <class Record, class Keep>
  void leave_out(std::vector<Record>& records, int line, char const* element, std::string const& ids,
                 Keep const& keep) {
    std::size_t kept = records.size();
    // From the back: where a record is left out, the one before it holds up to the next one that is kept.
    for (std::size_t i = records.size(); i-- > 0;)
      if (keep(records[i], std::span<Record const>(records).subspan(kept))) std::swap(records[--kept], records[i]);
    if (kept == 0) return;
    report(line, element, ids, std::to_string(kept) + " records are beyond any road; they were left out");
    records.erase(records.begin(), records.begin() + static_cast<std::ptrdiff_t>(kept));
  }

  /// Removes records that leave +-`largest` [m] before `end`; returns the smallest value of the others.
  template <class Ids>
  double leave_out_wild(std::vector<CubicRecord>& records, double end, int line, char const* element, Ids const& ids,
                        double largest = 1000.0, char const* unit = "m") {
    double lowest = 0.0;
    std::size_t kept = records.size();
    // From the back: where a record is left out, the one before it holds up to the next one that is kept.
    for (std::size_t i = records.size(); i-- > 0;) {
      double const to = kept < records.size() ? std::min(end, records[kept].s) : end;
      auto const [low, high] = extremes(records[i], records[i].s, std::max(to, records[i].s));
      if (low >= -largest && high <= largest) {
        lowest = std::min(lowest, low);
        records[--kept] = records[i];
        continue;
      }
      report(line, element, ids(),
             "the record at " + cambium::detail::rounded_text(records[i].s) + " m reaches " +
                 cambium::detail::rounded_text(high > largest ? high : low) + " " + unit + "; it was left out");
    }
    records.erase(records.begin(), records.begin() + static_cast<std::ptrdiff_t>(kept));
    return lowest;
  }

  void report(int line, char const* element, std::string ids, std::string sentence) {
    findings_.add(Severity::warning, line, element, std::move(ids), std::move(sentence));
  }

  opendrive::RoadElement& road_;
  Findings& findings_;
  std::string ids_;
};

}  // namespace cambium::inline v0_1::map::detail
