#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/core/parameters.hpp"

namespace cambium::inline v0_1 {

/// Assumptions of Responsibility-Sensitive Safety (RSS) about road users: a response time, bounds of their
/// accelerations until then, and their braking afterwards. Defaults are the example values in the documentation of
/// ad-rss-lib 4.
///
/// The idea: two vehicles are safe as long as, lengthwise or sideways, they stay apart even in the worst case. In this
/// case both accelerate towards each other as hard as the bounds permit until the response time is over, and then brake
/// as the proper response requires. Once both distances are unsafe, the situation is dangerous and the proper response
/// applies.
struct RssParameters {
  double response_time = 1.0;
  double maximum_acceleration = 3.5;
  double maximum_deceleration = 8.0;
  double minimum_deceleration = 4.0;
  double correct_deceleration = 3.0;
  double lateral_acceleration = 0.2;
  double lateral_deceleration = 0.8;
  double lateral_margin = 0.1;

  static constexpr char const* name = "rss";
  static constexpr char const* summary = "assumptions about road users: response time, bounds of accelerations";
  static constexpr char const* source = "Shalev-Shwartz, Shammah, Shashua 2017; defaults: ad-rss-lib 4";
  static constexpr auto parameters() {
    using P = RssParameters;
    constexpr Range rate{0.01, 50};
    return parameter_list(
        parameter("response_time", &P::response_time, "s", Range{0, 10}, "until a driver responds to danger (rho)"),
        parameter("maximum_acceleration", &P::maximum_acceleration, "m/s^2", Range{0, 50},
                  "highest before the response"),
        parameter("maximum_deceleration", &P::maximum_deceleration, "m/s^2", rate,
                  "hardest braking of a vehicle ahead"),
        parameter("minimum_deceleration", &P::minimum_deceleration, "m/s^2", rate,
                  "least braking in response to danger"),
        parameter("correct_deceleration", &P::correct_deceleration, "m/s^2", rate,
                  "the same for a vehicle in its own lane that meets an oncoming one"),
        parameter("lateral_acceleration", &P::lateral_acceleration, "m/s^2", Range{0, 50},
                  "highest before the response"),
        parameter("lateral_deceleration", &P::lateral_deceleration, "m/s^2", rate, "of lateral motion, in response"),
        parameter("lateral_margin", &P::lateral_margin, "m", Range{0, 10},
                  "lateral distance that fluctuations take up (mu)"));
  }

  void check(std::string const& where) const {
    if (!(minimum_deceleration <= maximum_deceleration))
      throw ParameterError(where, "minimum_deceleration is above maximum_deceleration", "swap them");
  }
};

namespace detail {

/// Distance [m] until a vehicle stops that accelerates by `a` for `response` [s] and then brakes by `b`; negative for a
/// vehicle that moves away all the time.
template <class Scalar>
[[nodiscard]] Scalar rss_stopping_distance(Scalar speed, double response, double a, double b) {
  using std::abs;
  Scalar const then = speed + Scalar(response * a);
  return (speed + then) * Scalar(0.5 * response) + then * abs(then) / Scalar(2 * b);
}

}  // namespace detail

/// Safe distance [m], bumper to bumper, of a follower at `rear_speed` behind a vehicle at `front_speed` [m/s] in its
/// direction (Shalev-Shwartz, Shammah, Shashua 2017, "On a formal model of safe and scalable self-driving cars", lemma
/// 2). Speeds are not negative.
template <class Scalar>
[[nodiscard]] Scalar rss_same_direction(RssParameters const& p, Scalar rear_speed, Scalar front_speed) {
  using std::max;
  Scalar const rear =
      detail::rss_stopping_distance(rear_speed, p.response_time, p.maximum_acceleration, p.minimum_deceleration);
  return max(Scalar(0), rear - front_speed * front_speed / Scalar(2 * p.maximum_deceleration));
}

/// Safe distance [m] between a vehicle in its own lane at `speed` and an oncoming one at `oncoming_speed`, both
/// positive [m/s] (same paper, definition 2).
template <class Scalar>
[[nodiscard]] Scalar rss_opposite_direction(RssParameters const& p, Scalar speed, Scalar oncoming_speed) {
  return detail::rss_stopping_distance(speed, p.response_time, p.maximum_acceleration, p.correct_deceleration) +
         detail::rss_stopping_distance(oncoming_speed, p.response_time, p.maximum_acceleration, p.minimum_deceleration);
}

/// Safe lateral distance [m], side to side, of two vehicles with lateral speeds [m/s, positive to the left] (same
/// paper, lemma 4, with the sign of its definition for a vehicle that still moves away when it begins to brake).
template <class Scalar>
[[nodiscard]] Scalar rss_lateral(RssParameters const& p, Scalar left_ones_speed, Scalar right_ones_speed) {
  using std::max;
  auto const closing = [&p](Scalar speed) {
    return detail::rss_stopping_distance(speed, p.response_time, p.lateral_acceleration, p.lateral_deceleration);
  };
  return Scalar(p.lateral_margin) + max(Scalar(0), closing(-left_ones_speed) + closing(right_ones_speed));
}

/// The proper response to a dangerous situation (same paper, definitions 4 and 7): brake by at least
/// `minimum_deceleration`, and come no closer to a side.
struct RssResponse {
  bool brake = false;
  bool keep_off_left = false;
  bool keep_off_right = false;

  [[nodiscard]] bool any() const { return brake || keep_off_left || keep_off_right; }
  friend bool operator==(RssResponse const&, RssResponse const&) = default;
};

/// The own vehicle and another road user, lengthwise and sideways.
struct RssSituation {
  double gap{};                  ///< lengthwise, bumper to bumper [m]; ≤ 0: beside each other
  double speed{};                ///< own, along the lane [m/s]
  double other_speed{};          ///< of the other along the same direction; negative if it is oncoming [m/s]
  double side_gap{};             ///< side to side [m]; ≤ 0: in each other's path
  double lateral_speed{};        ///< own, to the left [m/s]
  double other_lateral_speed{};  ///< [m/s]
  bool is_ahead = true;          ///< otherwise behind, by the reference points
  bool is_left = false;          ///< otherwise on the right, by the reference points
  bool in_own_lane = true;       ///< otherwise in a lane for oncoming traffic
};

/// The safe distance lengthwise [m]: of two vehicles in one direction that of the rear one, else that of two that meet;
/// 0 where they have passed each other.
[[nodiscard]] inline double rss_safe_gap(RssParameters const& p, RssSituation const& at) {
  double const own = std::max(0.0, at.speed), other = std::abs(at.other_speed);
  if (at.other_speed < 0.0 && !at.is_ahead) return 0.0;
  if (at.other_speed < 0.0)
    return at.in_own_lane ? rss_opposite_direction(p, own, other) : rss_opposite_direction(p, other, own);
  return at.is_ahead ? rss_same_direction(p, own, other) : rss_same_direction(p, other, own);
}

/// The proper response to one road user: none unless the distances are unsafe both lengthwise and sideways. Of two
/// vehicles in one direction, the rear one brakes; of two that meet, both brake. Vehicles beside each other do not
/// brake, and no vehicle comes closer sideways while there is still room.
[[nodiscard]] inline RssResponse rss_response(RssParameters const& p, RssSituation const& at) {
  RssResponse response;
  if (at.gap > 0.0 && at.gap >= rss_safe_gap(p, at)) return response;
  if (at.side_gap > 0.0 && at.side_gap >= (at.is_left ? rss_lateral(p, at.other_lateral_speed, at.lateral_speed)
                                                      : rss_lateral(p, at.lateral_speed, at.other_lateral_speed)))
    return response;
  bool const beside = at.gap <= 0.0 && at.side_gap > 0.0;
  response.brake = at.is_ahead && !beside;
  if (at.side_gap > 0.0) (at.is_left ? response.keep_off_left : response.keep_off_right) = true;
  return response;
}

}  // namespace cambium::inline v0_1
