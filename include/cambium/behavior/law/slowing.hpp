#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace cambium::inline v0_1 {

/// How fast a driver's acceleration may change, and what it was over the last step. The default bounds nothing.
struct JerkBound {
  double jerk = std::numeric_limits<double>::infinity();  ///< highest change of the acceleration [m/s^3]
  double acceleration = 0.0;                              ///< over the last step [m/s^2]; NaN: bounds nothing

  /// Whether it makes a difference.
  [[nodiscard]] bool matters() const { return jerk < 1e3 && !std::isnan(acceleration); }
  /// What drivers plan with [m/s^3]: the rest is reserve.
  [[nodiscard]] double planned() const { return 0.8 * jerk; }
};

/// A distance and how it depends on the state in which a vehicle begins to slow down.
struct SlowingDistance {
  double distance = 0.0;         ///< [m]
  double by_speed = 0.0;         ///< derivative [s]
  double by_acceleration = 0.0;  ///< derivative [s^2]
};

/// The distance in which a vehicle of `speed` [m/s] and `acceleration` [m/s^2] slows down to `target` [m/s] if its
/// acceleration changes by `jerk` [m/s^3], finite: down to -`deceleration` [m/s^2], and back to 0 at the end. A vehicle
/// that brakes harder already does so until the end begins; one so slow that this end is too long for it ends faster.
/// 0 if it does not exceed `target`.
///
///     acceleration  \              /     With p the hardest braking, o = speed - target and j = jerk, the two ramps
///              0 ----\------------/---   alone change the speed by o where p^2 = j o + a^2 / 2; braking evenly
///             -p      \__________/       in between, the rest is that of even braking plus target p / (2 j) and
///                                        p^3 / (24 j^2).
[[nodiscard]] inline SlowingDistance slowing_distance(double speed, double acceleration, double target,
                                                      double deceleration, double jerk) {
  double const over = speed - target, a = acceleration, square = a * a;
  if (2.0 * jerk * over + (a > 0.0 ? square : 0.0) <= 0.0) return {};
  if (a < 0.0 && 2.0 * jerk * over < square) {
    double const time = 2.0 * over / -a, distance = time * (target - a * time / 6.0);
    return {distance, (2.0 * target + 4.0 / 3.0 * over) / -a, distance / -a};
  }
  double const hardest = std::min(std::sqrt(jerk * over + 0.5 * square), std::max(deceleration, -a));
  double const time = (a + hardest) / jerk, slower = speed + (square - hardest * hardest) / (2.0 * jerk);
  double const ramp = time * (speed + time * (0.5 * a - jerk * time / 6.0));
  double const even = (slower * slower - target * target) / (2.0 * hardest);
  double const distance =
      ramp + even + 0.5 * target * hardest / jerk + hardest * hardest * hardest / (24.0 * jerk * jerk);
  double by_acceleration = (speed + a * time + slower * a / hardest) / jerk;
  if (hardest == -a) {  // it brakes as hard as it does now: less to build up, more to take back
    by_acceleration = even / hardest - 0.5 * target / jerk - square / (8.0 * jerk * jerk);
  }
  return {distance, time + slower / hardest, by_acceleration};
}

/// The distance [m] in which a vehicle of `speed` [m/s] stops softly that brakes with sqrt(2 `jerk` speed): the end of
/// every `slowing_distance` to a standstill, where the braking falls by `jerk` [m/s^3].
[[nodiscard]] inline double soft_stop(double speed, double jerk) { return speed * std::sqrt(2.0 * speed / jerk) / 3.0; }

/// The acceleration closest to `wanted` [m/s^2] that the jerk permits in a step of `dt` [s] at `speed` [m/s]. Where
/// more than the `comfortable` deceleration is wanted, or was, it changes the faster, as that of one who has to hurry
/// does; where nearly all is wanted of the `lowest` acceleration, at once.
[[nodiscard]] inline double bounded_acceleration(double wanted, double speed, double comfortable, double lowest,
                                                 JerkBound const& bound, double dt) {
  constexpr double emergency = 0.9;  // share of the lowest acceleration
  if (!bound.matters() || wanted <= -std::max(comfortable, -emergency * lowest)) return wanted;
  // [1/s] more jerk for what is beyond the comfortable deceleration: more if the vehicle would stop soon
  double const urgency = std::max(2.5, -3.0 * wanted / std::max(speed, 0.1));
  auto const change = [&](double braking) {
    return (bound.jerk + urgency * std::max(0.0, braking - comfortable)) * dt;
  };
  double const low = bound.acceleration - change(-wanted), high = bound.acceleration + change(-bound.acceleration);
  return wanted < low ? low : wanted > high ? high : wanted;
}

namespace detail {

/// The highest acceleration [m/s^2] over a step of `dt` [s] after which a vehicle of `speed` [m/s] comes to `target`
/// [m/s] softly, from below or above.
[[nodiscard]] inline double approach(double speed, double target, JerkBound const& bound, double dt) {
  double const change = target - speed, jerk = bound.planned();
  if (!bound.matters() || 2.0 * std::abs(change) <= jerk * dt * dt) return change / dt;
  return std::copysign(std::sqrt(2.0 * jerk * std::abs(change)) - 0.5 * jerk * dt, change);
}

/// Where a ramp of acceleration starts, and how that depends on the mean acceleration of the step before.
struct RampStart {
  double acceleration;  ///< [m/s^2]
  double by_mean;       ///< derivative [-]
};

/// The acceleration from which a ramp of `jerk` [m/s^3] starts at the end of a step of `dt` [s] whose mean is `mean`
/// [m/s^2], so that the mean of the next step differs by no more than `jerk` dt: the one that slows down the most, up
/// to `deceleration` [m/s^2] if `mean` is no less, but still ends softly when the vehicle is `over` [m/s] slower.
[[nodiscard]] inline RampStart ramp_start(double mean, double over, double deceleration, double jerk, double dt) {
  double const half = 0.5 * jerk * dt, softest = -std::sqrt(2.0 * jerk * std::max(0.0, over));
  RampStart const start = mean - half >= -deceleration ? RampStart{mean - half, 1.0}
                          : mean > -deceleration       ? RampStart{-deceleration, 0.0}
                                                       : RampStart{mean, 1.0};
  if (start.acceleration >= softest) return start;
  return softest <= mean + half ? RampStart{softest, softest < 0.0 ? jerk * dt / softest : 0.0}
                                : RampStart{mean + half, 1.0};
}

/// The highest acceleration over a step of `dt` [s] after which the vehicle still slows down to `target` [m/s] within
/// `distance` > 0 [m] as in `slowing_distance`: by more than `deceleration` [m/s^2] if that no longer suffices, but at
/// least `lowest` [m/s^2], and at most what the jerk permits.
[[nodiscard]] inline double highest_acceleration(double speed, double distance, double target, double deceleration,
                                                 double lowest, JerkBound const& bound, double dt) {
  constexpr int most = 12;
  constexpr double close = 1e-5;  // [m]
  double low = std::max(lowest, -speed / dt), high = std::max(low, bound.acceleration + bound.jerk * dt);
  double const jerk = bound.planned();
  double a = high;
  for (int i = 0; i < most; ++i) {
    double const end = speed + a * dt;
    auto const start = ramp_start(a, end - target, deceleration, jerk, dt);
    auto const slowing = slowing_distance(end, start.acceleration, target, deceleration, jerk);
    double const beyond = 0.5 * (speed + end) * dt + slowing.distance - distance;
    if (i == 0 && beyond <= 0.0) return high;
    if (std::abs(beyond) < close || high - low < 1e-6) return a;
    (beyond > 0.0 ? high : low) = a;
    double const slope = dt * (0.5 * dt + slowing.by_speed) + start.by_mean * slowing.by_acceleration;
    double const next = a - beyond / slope;
    a = next > low && next < high ? next : 0.5 * (low + high);
  }
  return a;
}

}  // namespace detail

}  // namespace cambium::inline v0_1
