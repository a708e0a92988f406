#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/dynamics/single_track.hpp"

namespace cambium::inline v0_1 {

/// A motion state with its acceleration.
template <class Scalar>
struct BasicAcceleratedState {
  Scalar time{}, x{}, y{}, heading{}, speed{};  ///< as in `BasicState`
  Scalar acceleration{};                        ///< along the heading [m/s^2]
  Scalar lateral_acceleration{};                ///< across the heading, left positive [m/s^2]

  static constexpr char const* name = "accelerated_state";
  static constexpr auto parameters() {
    using S = BasicAcceleratedState;
    return parameter_list(
        parameter("time", &S::time, "s", any_finite, "of the state"),
        parameter("x", &S::x, "m", any_finite, "of the reference point, map frame"),
        parameter("y", &S::y, "m", any_finite, "likewise"),
        parameter("heading", &S::heading, "rad", any_finite, "counter-clockwise from +x"),
        parameter("speed", &S::speed, "m/s", any_finite, "along the heading"),
        parameter("acceleration", &S::acceleration, "m/s^2", any_finite, "along the heading"),
        parameter("lateral_acceleration", &S::lateral_acceleration, "m/s^2", any_finite, "left positive"));
  }

  friend bool operator==(BasicAcceleratedState const&, BasicAcceleratedState const&) = default;
};

/// Jerk, the rate of change of the acceleration vector, in the map frame.
template <class Scalar>
struct JerkInput {
  Scalar x{}, y{};  ///< [m/s^3]
};

/// Planar triple integrator: the input is the jerk, x''' and y'''. The state holds heading, speed and the accelerations
/// along and across the path, which describe the same motion in path coordinates.
///
/// The acceleration is a vector in the map frame. While the vehicle turns, part of the jerk is spent on turning this
/// vector along with the path; otherwise lateral acceleration would become acceleration along the path. At low speed,
/// the path turns so fast that the limited jerk cannot keep up. The model then gives up lateral acceleration
/// (`held_lateral`), so that a braking vehicle never speeds up. Below `lowest_turning_speed`, the heading stays
/// constant and lateral acceleration has no effect.
struct TripleIntegrator {
  using State = BasicAcceleratedState<double>;
  using Input = JerkInput<double>;

  double jerk_limit = 10.0;
  double response_time = 0.2;
  double wheel_base = car_wheel_base;
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
        parameter("jerk_limit", &Self::jerk_limit, "m/s^3", Range{0.01, 1000}, "largest magnitude of the jerk"),
        parameter("response_time", &Self::response_time, "s", Range{0.01, 10},
                  "time constant of the acceleration's response to the driver"),
        parameter("wheel_base", &Self::wheel_base, "m", Range{0.1, 20},
                  "translates the driver's steering angle to curvature"),
        parameter("lowest_acceleration", &Self::lowest_acceleration, "m/s^2", Range{-50, 0},
                  "hardest braking by the driver"),
        parameter("highest_acceleration", &Self::highest_acceleration, "m/s^2", Range{0, 50},
                  "fullest throttle by the driver"),
        parameter("lateral_acceleration_limit", &Self::lateral_acceleration_limit, "m/s^2", Range{0.1, 1000},
                  "largest lateral acceleration by the driver"),
        parameter("lowest_turning_speed", &Self::lowest_turning_speed, "m/s", Range{1e-6, 10},
                  "the heading is constant up to this speed"));
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
    double const length = portable::hypot(u.x, u.y);
    if (!(length > jerk_limit)) return u;
    return {u.x * (jerk_limit / length), u.y * (jerk_limit / length)};
  }

  /// The jerk that brings the accelerations along and across the path to the action's. Turning the acceleration vector
  /// along with the vehicle has priority within the jerk limit, so that braking stays braking.
  [[nodiscard]] Input input(Action const& action, State const& x) const {
    double const tangent = portable::tan(std::clamp(action.steering, -steepest, steepest));
    double const wanted = std::clamp(action.acceleration, lowest_acceleration, highest_acceleration);
    double const across = held_lateral(x.speed * x.speed * tangent / wheel_base, x.speed, x.acceleration);
    double const forward = (wanted - x.acceleration) / response_time,
                 left = (across - x.lateral_acceleration) / response_time;
    double const yaw_rate = x.speed > lowest_turning_speed ? x.lateral_acceleration / x.speed : 0.0;
    double const turn_along = -x.lateral_acceleration * yaw_rate, turn_across = x.acceleration * yaw_rate;
    double const share = share_within(turn_along, turn_across, forward, left);
    double const along_jerk = turn_along + share * forward, across_jerk = turn_across + share * left;
    auto const [sin, cos] = portable::sin_cos(x.heading);
    return limited({along_jerk * cos - across_jerk * sin, along_jerk * sin + across_jerk * cos}, x);
  }

  /// State after the driver has held `action` for `dt` [s], which must not exceed `response_time`. The accelerations
  /// along and across the path change linearly, so the speed is a parabola; the vehicle stops where it reaches 0.
  /// Heading and position follow by Simpson's rule.
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

  /// The state without acceleration, as for a vehicle that has stopped.
  [[nodiscard]] State stopped(State x) const {
    x.acceleration = x.lateral_acceleration = 0.0;
    return x;
  }

 private:
  static constexpr double steepest = 1.5;  // largest steering angle of a driver's action [rad]

  /// Limits a lateral acceleration so that the turn is no tighter than at the steepest steering and at most half of the
  /// jerk is needed to turn the acceleration vector along with the vehicle.
  [[nodiscard]] double held_lateral(double lateral, double speed, double acceleration) const {
    if (!(speed > lowest_turning_speed)) return 0.0;
    // a_lat sqrt(a_lat^2 + a^2) / v = jerk / 2, solved for a_lat^2.
    double const square = acceleration * acceleration, jerk = jerk_limit * speed * jerk_limit * speed;
    double const turned = std::sqrt(0.5 * jerk / (square + std::sqrt(square * square + jerk)));
    double const most =
        std::min({lateral_acceleration_limit, turned, speed * speed * portable::tan(steepest) / wheel_base});
    return std::clamp(lateral, -most, most);
  }

  /// The largest factor up to 1 by which (x, y) may be scaled so that (along, across) plus it stays within the jerk
  /// limit.
  [[nodiscard]] double share_within(double along, double across, double x, double y) const {
    double const square = x * x + y * y, inner = along * x + across * y;
    double const room = jerk_limit * jerk_limit - along * along - across * across;
    if (square + 2.0 * inner <= room) return 1.0;
    if (!(room > 0.0)) return 0.0;
    return std::clamp((std::sqrt(inner * inner + room * square) - inner) / square, 0.0, 1.0);
  }

  /// Time until the speed reaches 0, at most `longest` [s]; `a` is the acceleration and `change` its rate [m/s^3].
  [[nodiscard]] static double time_to_stand(double speed, double a, double change, double longest) {
    if (!(speed > 0.0)) return a > 0.0 || (a == 0.0 && change > 0.0) ? longest : 0.0;
    double const discriminant = a * a - 2.0 * change * speed;
    if (!(discriminant >= 0.0)) return longest;
    double const falling = std::sqrt(discriminant) - a;
    return 2.0 * speed < longest * falling ? 2.0 * speed / falling : longest;
  }
};
static_assert(DynamicModel<TripleIntegrator>);

}  // namespace cambium::inline v0_1
