#pragma once

#include <array>

namespace cambium::inline v0_1 {

/// A quantity and its first two derivatives in time.
template <class Scalar>
struct PointMotion {
  Scalar position{};      ///< [m]
  Scalar speed{};         ///< [m/s]
  Scalar acceleration{};  ///< [m/s^2]
};

/// A polynomial of degree 5 in time.
template <class Scalar>
struct Quintic {
  std::array<Scalar, 6> c{};  ///< c[0] + c[1] t + ... + c[5] t^5

  /// Position, velocity and acceleration at `t` [s].
  [[nodiscard]] PointMotion<Scalar> at(Scalar t) const {
    return {c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5])))),
            c[1] + t * (Scalar(2) * c[2] + t * (Scalar(3) * c[3] + t * (Scalar(4) * c[4] + t * Scalar(5) * c[5]))),
            Scalar(2) * c[2] + t * (Scalar(6) * c[3] + t * (Scalar(12) * c[4] + t * Scalar(20) * c[5]))};
  }

  /// Third derivative [m/s^3].
  [[nodiscard]] Scalar jerk(Scalar t) const {
    return Scalar(6) * c[3] + t * (Scalar(24) * c[4] + t * Scalar(60) * c[5]);
  }

  /// Integral of the squared jerk from 0 to `t` [m^2/s^5].
  [[nodiscard]] Scalar squared_jerk(Scalar t) const {
    return t * (Scalar(36) * c[3] * c[3] + t * (Scalar(144) * c[3] * c[4] +
                                                t * (Scalar(192) * c[4] * c[4] + Scalar(240) * c[3] * c[5] +
                                                     t * (Scalar(720) * c[4] * c[5] + t * Scalar(720) * c[5] * c[5]))));
  }
};

/// The motion from `start` to `end` in `duration` > 0 [s] with the smallest integral of squared jerk (Takahashi, Hongo,
/// Ninomiya, Sugimoto 1989).
template <class Scalar>
[[nodiscard]] Quintic<Scalar> quintic(PointMotion<Scalar> const& start, PointMotion<Scalar> const& end,
                                      Scalar duration) {
  Scalar const T = duration, T2 = T * T;
  // Differences from a motion at the initial acceleration, scaled by powers of T to lengths.
  Scalar const way = end.position - (start.position + T * (start.speed + Scalar(0.5) * T * start.acceleration));
  Scalar const change = (end.speed - (start.speed + T * start.acceleration)) * T;
  Scalar const bend = (end.acceleration - start.acceleration) * T2;
  return {{start.position, start.speed, Scalar(0.5) * start.acceleration,
           (Scalar(10) * way - Scalar(4) * change + Scalar(0.5) * bend) / (T2 * T),
           (Scalar(-15) * way + Scalar(7) * change - bend) / (T2 * T2),
           (Scalar(6) * way - Scalar(3) * change + Scalar(0.5) * bend) / (T2 * T2 * T)}};
}

/// Like `quintic`, but with a free end position: reaches the speed and acceleration of `end` by a polynomial of degree
/// 4 (Werling, Ziegler, Kammel, Thrun 2010, section V.C).
template <class Scalar>
[[nodiscard]] Quintic<Scalar> quartic(PointMotion<Scalar> const& start, PointMotion<Scalar> const& end,
                                      Scalar duration) {
  Scalar const T = duration;
  Scalar const change = end.speed - (start.speed + T * start.acceleration);
  Scalar const bend = (end.acceleration - start.acceleration) * T;
  return {{start.position, start.speed, Scalar(0.5) * start.acceleration,
           (Scalar(3) * change - bend) / (Scalar(3) * T * T), (bend - Scalar(2) * change) / (Scalar(4) * T * T * T),
           Scalar(0)}};
}

}  // namespace cambium::inline v0_1
