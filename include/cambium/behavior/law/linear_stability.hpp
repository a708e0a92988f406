#pragma once

#include <complex>

namespace cambium {

/// A car-following law about steady following: how the follower's acceleration changes with what it sees.
struct LinearFollowing {
  double by_gap{};           ///< [1/s^2], above 0
  double by_speed{};         ///< with its own speed [1/s], below 0
  double by_leader_speed{};  ///< [1/s], not below 0

  /// Whether a platoon damps waves of every length; else long ones grow from vehicle to vehicle (Treiber, Kesting 2013,
  /// "Traffic Flow Dynamics", chapter 15, string stability of car-following models).
  [[nodiscard]] bool is_string_stable() const {
    return by_speed * by_speed - by_leader_speed * by_leader_speed >= 2.0 * by_gap;
  }

  /// Rate [1/s] at which a wave grows in time (below 0: decays) where each vehicle lags `phase` [rad] behind its
  /// leader; on a ring of n vehicles waves have phases of 2 pi m / n. The larger real part of the two roots r of r^2 =
  /// by_gap (e - 1) + (by_speed + by_leader_speed e) r, e = exp(i phase).
  [[nodiscard]] double growth_rate(double phase) const {
    auto const e = std::polar(1.0, phase);
    auto const half = 0.5 * (by_speed + by_leader_speed * e);
    return half.real() + std::abs(std::sqrt(half * half + by_gap * (e - 1.0)).real());
  }
};

/// The derivatives of `acceleration(speed, gap, leader_speed)` [m/s^2] where all drive at `speed` [m/s] with `gap` [m],
/// by central differences.
template <class Law>
[[nodiscard]] LinearFollowing linear_following(Law const& acceleration, double speed, double gap) {
  constexpr double h = 1e-4;
  return {(acceleration(speed, gap + h, speed) - acceleration(speed, gap - h, speed)) / (2 * h),
          (acceleration(speed + h, gap, speed) - acceleration(speed - h, gap, speed)) / (2 * h),
          (acceleration(speed, gap, speed + h) - acceleration(speed, gap, speed - h)) / (2 * h)};
}

}  // namespace cambium
