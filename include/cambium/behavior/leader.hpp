#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cambium/behavior/view.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium {

/// What a car-following model follows: the next road user ahead, or a place that must not be passed.
struct Leader {
  double gap = std::numeric_limits<double>::infinity();  ///< from the own front end to its rear end [m]
  double speed = 0.0;                                    ///< along the lane [m/s]
  double acceleration = 0.0;                             ///< [m/s^2]
};

/// What a driver heeds on the road beside other road users.
struct RoadRules {
  enum class LaneEnd {
    ignored,
    before_destination,  ///< brakes where its lane ends or leads away before the route does
    always,              ///< brakes before every end of its lane corridor, as BARK's option does
  };

  LaneEnd lane_end = LaneEnd::ignored;
  double lane_end_distance = 60.0;
  double lane_end_offset = 15.0;
  bool obey_speed_limits = false;

  static constexpr char const* name = "road_rules";
  static constexpr char const* summary = "braking for the end of the lane, obeying speed limits";
  static constexpr char const* source = "own; lane end: BARK";
  static constexpr auto parameters() {
    return parameter_list(choice("lane_end", &RoadRules::lane_end, "ignored|before_destination|always",
                                 "which ends of its lane a driver brakes for"),
                          parameter("lane_end_distance", &RoadRules::lane_end_distance, "m", Range{0, 10'000},
                                    "from how far before the end; above about 15 m/s the default is too short to stop"),
                          parameter("lane_end_offset", &RoadRules::lane_end_offset, "m", Range{0, 1000},
                                    "how far before the end the place is where it would stop"),
                          parameter("obey_speed_limits", &RoadRules::obey_speed_limits, "-", Range{0, 1},
                                    "desire no more than the limit, and be there in time for a lower one ahead"));
  }
};

/// The leader that is the end of the lane, where there is one to brake for.
template <class View>
[[nodiscard]] std::optional<Leader> lane_end_ahead(RoadRules const& rules, View const& view) {
  if (rules.lane_end == RoadRules::LaneEnd::ignored) return std::nullopt;
  auto const& corridor = view.corridor();
  if (rules.lane_end == RoadRules::LaneEnd::before_destination && corridor.reaches_destination) return std::nullopt;
  double const left = corridor.length_until_end(view.place().s) - view.shape().front;
  if (left > rules.lane_end_distance) return std::nullopt;
  return Leader{std::max(0.0, left - rules.lane_end_offset), 0.0, 0.0};
}

/// The neighbour as a leader; its acceleration only where `heed_acceleration`.
template <bool heed_acceleration, class View>
[[nodiscard]] Leader leader_of(View const& view, std::optional<RoadUser> const& neighbor) {
  if (!neighbor) return {};
  Leader leader{neighbor->gap, neighbor->speed, 0.0};
  if constexpr (heed_acceleration)
    if (is_valid(neighbor->agent)) leader.acceleration = view.acceleration(*neighbor);
  return leader;
}

/// What to follow: of `neighbor` and the end of the lane that which asks for the lower acceleration;
/// `acceleration(Leader)` [m/s^2] is the driver's. Without either: a free road. The one place where all car-following
/// models learn what is ahead of them.
template <bool heed_acceleration = false, class View, class F>
[[nodiscard]] Leader leader_to_follow(RoadRules const& rules, View const& view, std::optional<RoadUser> const& neighbor,
                                      F const& acceleration) {
  Leader const next = leader_of<heed_acceleration>(view, neighbor);
  auto const end = lane_end_ahead(rules, view);
  return end && acceleration(*end) < acceleration(next) ? *end : next;
}

/// The highest speed [m/s] at `s` of a corridor that lets a driver who brakes by `deceleration` [m/s^2] be at each
/// limit ahead 3 s in time, as car following comes down to a desired speed slowly; infinite where there is none.
/// O(limits within the way to brake).
CAMBIUM_NOINLINE [[nodiscard]] inline double permitted_speed(map::LaneCorridor const& corridor, double s, double speed,
                                                             double deceleration) {
  double permitted = corridor.speed_limit_at(s);
  double const early = s + 3.0 * speed, reach = early + speed * speed / (2.0 * deceleration);
  for (auto const& step : corridor.speed_limits) {
    if (step.begin <= s) continue;
    if (step.begin > reach) break;
    double const room = std::max(0.0, step.begin - early);
    permitted = std::min(permitted, std::sqrt(step.limit * step.limit + 2.0 * deceleration * room));
  }
  return permitted;
}

/// The driver's desired speed where it is [m/s]: within the limits, if it obeys them.
template <class P, class View>
[[nodiscard]] double desired_within_limits(RoadRules const& rules, P const& idm, View const& view, double speed) {
  if (!rules.obey_speed_limits) return idm.desired_speed;
  return std::clamp(permitted_speed(view.corridor(), view.place().s, speed, idm.comfortable_deceleration), 0.1,
                    idm.desired_speed);
}

/// The driver's parameters `idm` with that desired speed.
template <class P, class View>
[[nodiscard]] P within_limits(RoadRules const& rules, P idm, View const& view, double speed) {
  idm.desired_speed = desired_within_limits(rules, idm, view, speed);
  return idm;
}

}  // namespace cambium
