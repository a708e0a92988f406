#pragma once

#include <algorithm>
#include <cstdint>

#include "cambium/behavior/view.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium::inline v0_1 {

/// Smallest distance [m], bumper to bumper, at which a vehicle cannot run into the one ahead. The front one brakes at
/// once with `front_deceleration`, the rear one after `reaction_time` [s] with `rear_deceleration`, both positive
/// [m/s^2], each to a standstill. Speeds [m/s] are not negative. (Rizaldi et al. 2017, "Formalising and Monitoring
/// Traffic Rules for Autonomous Vehicles in Isabelle/HOL", theorem 4: the largest of the distances 1 and 2 where 2
/// applies. Distances 0 and 3 of the theorem are bounds that suffice and are never smaller.) O(1).
[[nodiscard]] inline double safe_distance(double rear_speed, double front_speed, double reaction_time,
                                          double rear_deceleration, double front_deceleration) {
  double const reacting = rear_speed * reaction_time;
  double const rear_stop = reacting + rear_speed * rear_speed / (2.0 * rear_deceleration);
  double const front_stop = front_speed * front_speed / (2.0 * front_deceleration);
  double needed = std::max(0.0, rear_stop - front_stop);
  double const front_then = std::max(0.0, front_speed - front_deceleration * reaction_time);
  if (front_deceleration < rear_deceleration && front_then > 0.0 && front_then < rear_speed &&
      rear_speed / rear_deceleration < front_then / front_deceleration) {
    // They come closest while both brake, at equal speeds.
    double const closing = rear_speed - front_then;
    double const front_way = 0.5 * (front_speed + front_then) * reaction_time;
    needed =
        std::max(needed, reacting - front_way + closing * closing / (2.0 * (rear_deceleration - front_deceleration)));
  }
  return needed;
}

/// Whether an agent keeps the safe distance to the next road user in its lane, ahead or behind. Road users in lanes
/// that have yet to merge do not count. O(1), as `ObservedWorld::ahead`.
///
/// BARK's label of that name counts overlapping vehicles as safe, swaps the decelerations of the two where the ego is
/// behind, and is always true in its last version. Left out are its options to look at crossing vehicles, and to be
/// content with a safe distance sideways.
struct SafeDistance {
  enum class Side : std::uint8_t { ahead, behind };

  Side side = Side::ahead;
  double reaction_time = 1.0;
  double deceleration = 7.84;
  double other_deceleration = 7.84;

  static constexpr char const* name = "safe_distance";
  static constexpr char const* summary = "keeps the safe distance to the next road user in its lane, ahead or behind";
  static constexpr char const* source = "Rizaldi et al. 2017, theorem 4; defaults: BARK's rules";
  static constexpr auto parameters() {
    using P = SafeDistance;
    return parameter_list(
        choice("side", &P::side, "ahead|behind", "the road user to which distance is kept"),
        parameter("reaction_time", &P::reaction_time, "s", Range{0, 10}, "of the one that is behind"),
        parameter("deceleration", &P::deceleration, "m/s^2", Range{0.1, 50}, "own braking"),
        parameter("other_deceleration", &P::other_deceleration, "m/s^2", Range{0.1, 50}, "the other's braking"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World& world, Slot slot) const {
    auto const view = world.truth(slot);
    Look const look{.merging = Merging::ignored};
    auto const next = side == Side::ahead ? view.ahead(look) : view.behind(look);
    if (!next) return true;
    double const own = std::max(0.0, view.state().speed), other = std::max(0.0, next->speed);
    double const needed = side == Side::ahead
                              ? safe_distance(own, other, reaction_time, deceleration, other_deceleration)
                              : safe_distance(other, own, reaction_time, other_deceleration, deceleration);
    return next->gap > 0.0 && next->gap >= needed;
  }
};

}  // namespace cambium::inline v0_1
