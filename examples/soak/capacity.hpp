#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "traffic.hpp"

// What the Highway Capacity Manual gives (HCM 2000 where no other edition is named; quoted second-hand), all in
// vehicles an hour for passenger cars. The second figure of a facility counts heavy vehicles as the manual does.

namespace soak {

/// A kind of road or junction, and what it can pass.
struct Facility {
  std::string kind;
  double per_minute = 0.0;        ///< of passenger cars
  double heavy_per_minute = 0.0;  ///< at the share of heavy vehicles
};

namespace detail {

/// Passenger-car equivalent of a heavy vehicle on level ground: 1.5 on freeways (exhibit 23-8), 2.0 at signals, signs
/// and roundabouts (chapters 16 and 17).
constexpr double on_freeways = 1.5, at_junctions = 2.0;

/// f_HV = 1 / (1 + P (E - 1)): equation 23-3.
[[nodiscard]] inline double heavy_factor(double share, double equivalent) {
  return 1.0 / (1.0 + share * (equivalent - 1.0));
}

/// Capacity of a lane with speed limit `limit` [m/s]: basic freeway segment 1800 + 5 v from 90 to 120 km/h (exhibit
/// 23-3), multilane highway 1200 + 10 v from 70 km/h (exhibit 21-3); below that the base saturation flow 1900 of urban
/// streets (equation 16-4).
[[nodiscard]] inline double lane_capacity(double limit) {
  double const v = 3.6 * (std::isfinite(limit) ? limit : 50.0 / 3.6);
  if (v >= 89.9) return 1800.0 + 5.0 * std::min(v, 120.0);
  return v >= 69.9 ? 1200.0 + 10.0 * v : 1900.0;
}

/// Where lanes leave the map.
[[nodiscard]] inline bool is_exit(cb::Map const& map, cb::map::Lane const& lane) {
  auto const& width = lane.widths.back();
  return lane.drivable() && lane.successors.empty() && !is_valid(lane.merges_into) && !is_valid(lane.opposite) &&
         !is_valid(map.road(lane.road).junction) && width.left + width.right >= 2.5;
}

/// The sum over the lanes that enter, or over those that leave if that is less: merges and lane drops pass what the
/// road behind them does (chapters 13 and 25).
[[nodiscard]] inline double through_lanes(Site const& site) {
  double in = 0.0, out = 0.0;
  for (auto const& source : site.sources) in += lane_capacity(site.map->lane(source.lane).speed_limit_at(0.0));
  for (auto const& lane : site.map->lanes())
    if (is_exit(*site.map, lane)) out += lane_capacity(lane.speed_limit_at(lane.length()));
  return out > 0.0 ? std::min(in, out) : in;
}

/// All ways have to stop, one lane each: a vehicle departs every h seconds on each, with traffic on all others: h = 9.6
/// s at a crossing (case 5), 7.0 s at a T (case 4; exhibits 17-22 and 17-37), to which the share of left turns adds 0.2
/// s, that of right turns -0.6 s and that of heavy vehicles 1.7 s (equation 17-56, exhibit 17-33). Routes are drawn
/// with equal probability: at both a third of the traffic turns left, and a third right.
[[nodiscard]] inline Facility all_way_stop(int ways, double heavy) {
  double const turning = 1.0 / 3.0, headway = (ways == 4 ? 9.6 : 7.0) + (0.2 - 0.6) * turning;
  return {"all-way stop", 60.0 * ways / headway, 60.0 * ways / (headway + 1.7 * heavy)};
}

/// Gap acceptance: v e^(-v t_c / 3600) / (1 - e^(-v t_f / 3600)) in a conflicting flow v (equation 17-3).
[[nodiscard]] inline double gap_capacity(double flow, double critical_gap, double follow_up) {
  return flow * std::exp(-flow * critical_gap / 3600.0) / (1.0 - std::exp(-flow * follow_up / 3600.0));
}

/// The T of intersection_3way, where half of each entrance turns either way. The main road's straight traffic fills its
/// lane at 1700 (the default of chapter 17); those who turn left from it cross that (t_c = 4.1 s, t_f = 2.2
/// s) and, being half of their lane's traffic, bound it to twice as much; the side road crosses both (t_c = 7.1 s for
/// the left turn, t_f = 3.5 s; exhibit 17-5).
[[nodiscard]] inline Facility two_way_stop(double heavy) {
  double const straight = 1700.0, left = gap_capacity(straight, 4.1, 2.2);
  double const side = gap_capacity(straight + 2.0 * left, 7.1, 3.5);
  double const sum = (straight + std::min(straight, 2.0 * left) + side) / 60.0;
  return {"two-way stop", sum, sum * heavy_factor(heavy, at_junctions)};
}

/// A roundabout with one lane: an entrance passes 1130 e^(-0.001 v) in a circulating flow v (HCM 2010, equation 21-1).
/// With four saturated entrances, and half of the traffic leaving at each exit, v is 7/8 of what each entrance passes.
[[nodiscard]] inline Facility roundabout(double heavy) {
  double entrance = 600.0;
  for (int i = 0; i < 100; ++i) entrance = 0.5 * (entrance + 1130.0 * std::exp(-0.001 * 7.0 / 8.0 * entrance));
  return {"roundabout", 4.0 * entrance / 60.0, 4.0 * entrance / 60.0 * heavy_factor(heavy, at_junctions)};
}

/// Two lanes on each of four approaches, opposite ones green together for 15 s of 40 s (see `light_plan`): a lane
/// passes 1900 g / C (equation 16-6), where g is the green, as the start-up loss of 2 s and the use of yellow cancel.
/// Who turns left gives way to a saturated oncoming flow, so that the shared left lane passes 2 (1 + P_L) vehicles of 2
/// s in a cycle (chapter 16, appendix C, lower bound of f_LT); a third of it turns left.
[[nodiscard]] inline Facility signalised(double heavy) {
  double const green = 15.0, cycle = 40.0, turning = 1.0 / 3.0;
  double const right = 1900.0 * green / cycle, left = 1900.0 * 2.0 * (1.0 + turning) / cycle;
  double const sum = 4.0 * (right + left) / 60.0;
  return {"signals", sum, sum * heavy_factor(heavy, at_junctions)};
}

}  // namespace detail

/// The facility that a map is, and its capacity, where `heavy` is the share of trucks and buses. Where the manual has
/// no figure for it, the capacity of its lanes.
[[nodiscard]] inline Facility facility_of(Site const& site, double heavy) {
  auto const name = std::filesystem::path(site.file).stem().string();
  if (name == "intersection_4way") return detail::signalised(heavy);
  if (name == "intersection_3way") return detail::two_way_stop(heavy);
  if (name == "roundabout") return detail::roundabout(heavy);
  if (name == "4way_intersection" || name == "fabriksgatan") return detail::all_way_stop(4, heavy);
  if (name == "threeway_intersection" || name == "simple_3way_intersection_lht") return detail::all_way_stop(3, heavy);
  double const sum = detail::through_lanes(site) / 60.0;
  double const equivalent = site.has_conflicts ? detail::at_junctions : detail::on_freeways;
  return {site.has_conflicts ? "lanes (no figure)"
          : site.has_merges  ? "merge"
                             : "basic lanes",
          sum, sum * detail::heavy_factor(heavy, equivalent)};
}

}  // namespace soak
