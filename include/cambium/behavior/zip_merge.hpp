#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/idm.hpp"
#include "cambium/behavior/lane_changing.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium {

/// Zip merge: keeps its lane up to where it merges with another, and there lets one vehicle from the other lane in
/// before itself, behind the vehicle ahead (the alternate order that, for instance, the German StVO asks for in section
/// 7 (4)). The first of the other lane behind the vehicle ahead is let in where it is ahead, beside, or not farther
/// back than `reach`; who is first of all of its lane goes before those behind it. Between the two a gap opens bit by
/// bit, in proportion to the way that is left. After `patience` at a standstill it goes when there is room. Car
/// following by IDM.
struct ZipMerge {
  IdmParameters idm{};
  double zone = 150.0;
  double reach = 12.0;
  double patience = 4.0;
  double tolerance = 1e-4;

  static constexpr char const* name = "zip_merge";
  static constexpr char const* summary =
      "IDM; keeps its lane up to a merge and lets one vehicle from the other lane in before itself";
  static constexpr char const* source = "rule: StVO section 7 (4); control of the gap: own";
  static constexpr auto parameters() {
    using P = ZipMerge;
    return std::make_tuple(
        parameter("idm", &P::idm, "-", {}, "the driver's own car following"),
        parameter("zone", &P::zone, "m", Range{1, 400}, "how far before a merge it begins to give way"),
        parameter("reach", &P::reach, "m", Range{0, 100}, "how far back a vehicle is still let in before"),
        parameter("patience", &P::patience, "s", Range{0, 600},
                  "at a standstill, until it no longer waits to be passed"),
        parameter("tolerance", &P::tolerance, "m/s^2", Range{1e-12, 1},
                  "error of the exact integration, as speed per second"));
  }

  struct Memory {
    AgentId ahead = none<AgentId>;  ///< who was last ahead in the own lane before the merge
    float stood{};                  ///< how long it has been standing [s]
    float bend{};                   ///< see `plan_to_center`

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    double const speed = std::max(0.0, view.state().speed);
    memory.stood = speed < 0.3 ? memory.stood + static_cast<float>(dt) : 0.0f;
    detail::IdmLaw const law(idm);
    detail::Restriction ahead{infinite, 0.0, law.free(speed)};
    double const merge = next_merge(view);
    auto const leader = merge < infinite ? view.front_in_lane() : view.front();
    if (leader) ahead.add(law, speed, leader->gap, leader->speed);
    if (merge < infinite) {
      if (auto const other = let_in(view, memory, leader, merge)) {
        double const front = view.lane_position().s + view.shape().front;
        ahead.add(law, speed, map::gap_before_merge(front, other->s - other->rear, merge), other->speed);
      }
    } else if (leader) {
      memory.ahead = leader->agent;
    }
    return plan_to_center(view, memory.bend, idm_motion(idm, speed, ahead.gap, ahead.speed, dt, tolerance), dt);
  }

 private:
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  /// Where the next merge within the zone is on the own corridor; infinite where there is none.
  template <class View>
  [[nodiscard]] double next_merge(View const& view) const {
    double const s = view.lane_position().s;
    for (auto const& feeder : view.corridor().feeders) {
      if (feeder.begin > s + zone) break;
      if (feeder.is_still_to_merge() && feeder.free_until > s && feeder.free_until < s + zone) return feeder.free_until;
    }
    return infinite;
  }

  /// Who of the other lane is to go before this one, if there is somebody.
  template <class View>
  [[nodiscard]] std::optional<MergingNeighbor> let_in(View const& view, Memory& memory,
                                                      std::optional<Neighbor> const& leader, double merge) const {
    double const front = view.lane_position().s + view.shape().front;
    auto const is_before = [&](MergingNeighbor const& other, double by) { return other.s + other.front > front + by; };
    if (!leader) {  // the first of the lane: who is closer to the merge goes first
      auto const other = view.merging(merge, infinite);
      constexpr double equal = 0.5;  // [m]
      if (other && is_before(*other, other->agent < view.id() ? -equal : equal)) return other;
      return std::nullopt;
    }
    double const rear_of_leader = front + leader->gap;
    if (rear_of_leader < merge) memory.ahead = leader->agent;
    if (leader->agent != memory.ahead) {  // the other lane has had its turn
      auto const other = view.merging(merge, infinite);
      if (other && is_before(*other, reach)) return other;  // too far ahead to let this one in
      return std::nullopt;
    }
    auto const other = view.merging(merge, rear_of_leader);
    if (!other || !is_before(*other, -reach)) return std::nullopt;
    if (memory.stood > patience && !is_before(*other, 0.0)) return std::nullopt;
    return other;
  }
};
static_assert(BehaviorModel<ZipMerge>);

}  // namespace cambium
