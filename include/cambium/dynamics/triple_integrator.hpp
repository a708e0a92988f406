#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "cambium/core/parameters.hpp"
#include "cambium/dynamics/single_track.hpp"

namespace cambium {

/// A motion state with its acceleration.
template <class Scalar>
struct BasicAcceleratedState {
  Scalar time{}, x{}, y{}, heading{}, speed{};  ///< as of `BasicState`
  Scalar acceleration{};                        ///< along the heading [m/s^2]
  Scalar lateral_acceleration{};                ///< to the left of it [m/s^2]

  friend bool operator==(BasicAcceleratedState const&, BasicAcceleratedState const&) = default;
};

template <class Scalar>
[[nodiscard]] BasicAcceleratedState<Scalar> add_scaled(BasicAcceleratedState<Scalar> const& a,
                                                       BasicAcceleratedState<Scalar> const& derivative, double h) {
  auto const s = Scalar(h);
  return {a.time + s * derivative.time,
          a.x + s * derivative.x,
          a.y + s * derivative.y,
          a.heading + s * derivative.heading,
          a.speed + s * derivative.speed,
          a.acceleration + s * derivative.acceleration,
          a.lateral_acceleration + s * derivative.lateral_acceleration};
}

/// Change of the acceleration's vector in the map frame.
template <class Scalar>
struct JerkInput {
  Scalar x{}, y{};  ///< [m/s^3]
};

/// Jerk in the plane: x''' and y''' are the input, the state is kept as heading, speed and the acceleration along and
/// across it (the same motion, in the coordinates of the path). Below `lowest_turning_speed` the heading stays, and
/// with it the lateral acceleration has no effect. A driver's braking never makes it faster: what the jerk cannot turn
/// along with a slow vehicle of its lateral acceleration is lost.
struct TripleIntegrator {
  using State = BasicAcceleratedState<double>;
  using Input = JerkInput<double>;

  double jerk_limit = 10.0;
  double response_time = 0.2;
  double wheel_base = 2.7;
  double lowest_acceleration = -8.0;
  double highest_acceleration = 4.0;
  double lateral_acceleration_limit = 8.0;
  double lowest_turning_speed = 0.05;

  static constexpr char const* name = "triple_integrator";
  static constexpr char const* summary = "x''' = j_x, y''' = j_y, in the coordinates of the path";
  static constexpr char const* source = "kinematics; after BARK";
  static constexpr auto parameters() {
    using Self = TripleIntegrator;
    return parameter_list(
        parameter("jerk_limit", &Self::jerk_limit, "m/s^3", Range{0.01, 1000}, "length of the jerk at most"),
        parameter("response_time", &Self::response_time, "s", Range{0.01, 10},
                  "of the acceleration to what the driver asks for"),
        parameter("wheel_base", &Self::wheel_base, "m", Range{0.1, 20}, "of the vehicle that a driver steers"),
        parameter("lowest_acceleration", &Self::lowest_acceleration, "m/s^2", Range{-50, 0},
                  "hardest braking that a driver's action is kept within"),
        parameter("highest_acceleration", &Self::highest_acceleration, "m/s^2", Range{0, 50},
                  "fullest throttle that a driver's action is kept within"),
        parameter("lateral_acceleration_limit", &Self::lateral_acceleration_limit, "m/s^2", Range{0.1, 1000},
                  "that a driver's action is kept within"),
        parameter("lowest_turning_speed", &Self::lowest_turning_speed, "m/s", Range{1e-6, 10},
                  "the heading changes above it"));
  }

  template <class Scalar>
  [[nodiscard]] BasicAcceleratedState<Scalar> derivative(BasicAcceleratedState<Scalar> const& x,
                                                         JerkInput<std::type_identity_t<Scalar>> const& u) const {
    auto const along = direction_of(x.heading);
    Scalar const yaw_rate = x.speed > Scalar(lowest_turning_speed) ? x.lateral_acceleration / x.speed : Scalar(0);
    return {Scalar(1),
            x.speed * along.cos,
            x.speed * along.sin,
            yaw_rate,
            x.acceleration,
            u.x * along.cos + u.y * along.sin + x.lateral_acceleration * yaw_rate,
            u.y * along.cos - u.x * along.sin - x.acceleration * yaw_rate};
  }

  [[nodiscard]] Input limited(Input const& u, State const&) const {
    double const length = std::hypot(u.x, u.y);
    if (!(length > jerk_limit)) return u;
    return {u.x * (jerk_limit / length), u.y * (jerk_limit / length)};
  }

  /// The jerk that brings the acceleration along and across the path to what the action asks for. What turns it along
  /// with the vehicle comes first, so that braking stays braking.
  [[nodiscard]] Input input(Action const& action, State const& x) const {
    double const tangent = std::tan(std::clamp(action.steering, -steepest, steepest));
    double const wanted = std::clamp(action.acceleration, lowest_acceleration, highest_acceleration);
    double const across = held_lateral(x.speed * x.speed * tangent / wheel_base, x.speed, x.acceleration);
    double const forward = (wanted - x.acceleration) / response_time,
                 left = (across - x.lateral_acceleration) / response_time;
    double const yaw_rate = x.speed > lowest_turning_speed ? x.lateral_acceleration / x.speed : 0.0;
    double const turn_along = -x.lateral_acceleration * yaw_rate, turn_across = x.acceleration * yaw_rate;
    double const share = share_within(turn_along, turn_across, forward, left);
    double const along_jerk = turn_along + share * forward, across_jerk = turn_across + share * left;
    auto const [sin, cos] = geometry::sin_cos(x.heading);
    return limited({along_jerk * cos - across_jerk * sin, along_jerk * sin + across_jerk * cos}, x);
  }

  /// Where a driver's action leads in `dt` [s], not longer than `response_time`: the acceleration along and across the
  /// path changes evenly, so the speed is a parabola and stops where that reaches 0; heading and place by Simpson's
  /// rule.
  [[nodiscard]] State driven(State x, Action const& action, double dt) const {
    x.lateral_acceleration = held_lateral(x.lateral_acceleration, x.speed, x.acceleration);
    auto const rate = derivative(x, input(action, x));
    double const a = x.acceleration, change = rate.acceleration, end = x.time + dt;
    double const moving = time_to_stand(x.speed, a, change, dt);
    auto const speed = [&](double t) { return std::max(0.0, x.speed + t * (a + 0.5 * t * change)); };
    auto const lateral = [&](double t) {
      return held_lateral(x.lateral_acceleration + t * rate.lateral_acceleration, speed(t), a + t * change);
    };
    auto const yaw_rate = [&](double t) { return speed(t) > lowest_turning_speed ? lateral(t) / speed(t) : 0.0; };
    double const h = 0.5 * moving, first = yaw_rate(0.0), second = yaw_rate(h), third = yaw_rate(moving);
    double const half_turn = h / 12.0 * (5.0 * first + 8.0 * second - third),
                 turn = h / 3.0 * (first + 4.0 * second + third);
    auto const at_start = direction_of(x.heading), at_half = direction_of(x.heading + half_turn),
               at_end = direction_of(x.heading + turn);
    double const v0 = x.speed, v1 = 4.0 * speed(h), v2 = speed(moving);
    x.x += h / 3.0 * (v0 * at_start.cos + v1 * at_half.cos + v2 * at_end.cos);
    x.y += h / 3.0 * (v0 * at_start.sin + v1 * at_half.sin + v2 * at_end.sin);
    x.heading += turn;
    x.lateral_acceleration = lateral(moving);
    x.acceleration = a + moving * change;
    x.speed = v2;
    x.time = end;
    if (moving < dt) {
      x.speed = 0.0;
      return stopped(x);
    }
    return x;
  }

  /// One that stands is not accelerated any more.
  [[nodiscard]] State stopped(State x) const {
    x.acceleration = x.lateral_acceleration = 0.0;
    return x;
  }

 private:
  static constexpr double steepest = 1.5;  // [rad] steering angle of a driver's action at most

  /// What of a lateral acceleration a driver can have: a turn no tighter than by the steepest steering, and none in
  /// which more than half of the jerk is needed to turn the acceleration along with the vehicle.
  [[nodiscard]] double held_lateral(double lateral, double speed, double acceleration) const {
    if (!(speed > lowest_turning_speed)) return 0.0;
    // a_lat sqrt(a_lat^2 + a^2) / v = jerk / 2, solved for a_lat^2.
    double const square = acceleration * acceleration, jerk = jerk_limit * speed * jerk_limit * speed;
    double const turned = std::sqrt(0.5 * jerk / (square + std::sqrt(square * square + jerk)));
    double const most = std::min({lateral_acceleration_limit, turned, speed * speed * std::tan(steepest) / wheel_base});
    return std::clamp(lateral, -most, most);
  }

  /// The largest share of (x, y) up to 1 that may be added to (along, across) within the limit of the jerk.
  [[nodiscard]] double share_within(double along, double across, double x, double y) const {
    double const square = x * x + y * y, inner = along * x + across * y;
    double const room = jerk_limit * jerk_limit - along * along - across * across;
    if (square + 2.0 * inner <= room) return 1.0;
    if (!(room > 0.0)) return 0.0;
    return std::clamp((std::sqrt(inner * inner + room * square) - inner) / square, 0.0, 1.0);
  }

  /// When a speed with the acceleration `a` that changes by `change` [m/s^3] falls to 0, at most `longest` [s].
  [[nodiscard]] static double time_to_stand(double speed, double a, double change, double longest) {
    if (!(speed > 0.0)) return a > 0.0 || (a == 0.0 && change > 0.0) ? longest : 0.0;
    double const discriminant = a * a - 2.0 * change * speed;
    if (!(discriminant >= 0.0)) return longest;
    double const falling = std::sqrt(discriminant) - a;
    return 2.0 * speed < longest * falling ? 2.0 * speed / falling : longest;
  }
};
static_assert(DynamicModel<TripleIntegrator>);

}  // namespace cambium
