#pragma once

#include <complex>

namespace cambium::inline v0_1 {

/// A car-following law linearised at steady following: derivatives of the follower's acceleration.
struct LinearFollowing {
  double by_gap{};           ///< by the gap [1/s^2], above 0
  double by_speed{};         ///< by its own speed [1/s], below 0
  double by_leader_speed{};  ///< by the leader's speed [1/s], not below 0

  /// Whether a platoon damps waves of every length; otherwise long waves grow from vehicle to vehicle (Treiber, Kesting
  /// 2013, "Traffic Flow Dynamics", chapter 15, string stability of car-following models).
  [[nodiscard]] bool is_string_stable() const {
    return by_speed * by_speed - by_leader_speed * by_leader_speed >= 2.0 * by_gap;
  }

  /// Growth rate [1/s] of a wave (below 0: it decays) in which each vehicle lags `phase` [rad] behind its leader; on a
  /// ring of n vehicles, waves have phases of 2 pi m / n. The larger real part of the two roots r of r^2 = by_gap (e -
  /// 1) + (by_speed + by_leader_speed e) r with e = exp(i phase).
  [[nodiscard]] double growth_rate(double phase) const {
    auto const e = std::polar(1.0, phase);
    auto const half = 0.5 * (by_speed + by_leader_speed * e);
    return half.real() + std::abs(std::sqrt(half * half + by_gap * (e - 1.0)).real());
  }
};

/// Derivatives of `acceleration(speed, gap, leader_speed)` [m/s^2] where all vehicles drive at `speed` [m/s] with `gap`
/// [m], by central differences.
template <class Law>
[[nodiscard]] LinearFollowing linear_following(Law const& acceleration, double speed, double gap) {
  constexpr double h = 1e-4;
  return {(acceleration(speed, gap + h, speed) - acceleration(speed, gap - h, speed)) / (2 * h),
          (acceleration(speed + h, gap, speed) - acceleration(speed - h, gap, speed)) / (2 * h),
          (acceleration(speed, gap, speed + h) - acceleration(speed, gap, speed - h)) / (2 * h)};
}

}  // namespace cambium::inline v0_1
