#pragma once

#include <string>

#include "cambium/behavior/presets.hpp"
#include "cambium/core/distribution.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/random.hpp"

namespace cambium::inline v0_1 {

/// How the drivers of one kind of vehicle differ from each other: each parameter with its distribution. The defaults
/// are car drivers on motorways. "Fitted" are parameters that nobody observes as such: they were chosen so that traffic
/// comes into the bands of the sources named, see the table in behavior/README.md.
struct Population {
  Distribution desired_speed = TruncatedNormal{34.0, 7.0, 24.0, 56.0};          // fitted: Heidemann 1987; BASt 2010-14
  Distribution speed_factor = TruncatedNormal{1.06, 0.1, 0.8, 1.4};             // fitted: DfT 2019
  Distribution time_headway = TruncatedNormal{0.76, 0.44, 0.5, 2.5};            // fitted: Wasielewski 1979; HCM
  Distribution minimum_gap = TruncatedNormal{2.0, 0.5, 1.0, 4.0};               // Treiber, Kesting 2013; spread: own
  Distribution maximum_acceleration = TruncatedNormal{1.2, 0.25, 0.7, 2.0};     // Treiber, Kesting: MovSim's ACC cars
  Distribution comfortable_deceleration = TruncatedNormal{2.0, 0.4, 1.2, 3.0};  // the same
  Distribution politeness = Uniform{0.0, 0.1};                                  // fitted: Knoop et al. 2012
  Distribution threshold = Uniform{0.2, 0.35};                                  // fitted: Knoop et al. 2012
  Distribution change_duration = TruncatedNormal{5.8, 1.4, 3.0, 9.0};           // Toledo, Zohar 2007
  Distribution lateral_acceleration = TruncatedNormal{2.7, 0.4, 1.8, 4.0};      // own
  Distribution time_margin = TruncatedNormal{0.5, 0.15, 0.2, 1.0};              // fitted: HCM, exh. 20-17
  Distribution minor_road_margin = TruncatedNormal{3.0, 0.5, 1.5, 4.5};         // fitted: HCM, exh. 20-17
  Distribution reaction = TruncatedNormal{0.8, 0.2, 0.4, 1.2};                  // Gates et al. 2007
  Distribution rolling_speed = TruncatedNormal{2.4, 0.4, 0.0, 3.4};             // fitted: HCM, exh. 20-18
  Distribution signal_braking = TruncatedNormal{3.6, 0.3, 3.0, 4.5};            // Gates et al. 2007
  double bias = 0.2;
  double others_headway = 0.8;
  double lowest_acceleration = -8.0;
  double jerk = 2.5;

  static constexpr char const* name = "population";
  static constexpr auto parameters() {
    using P = Population;
    return parameter_list(
        parameter("desired_speed", &P::desired_speed, "m/s", {}, "where there is no limit"),
        parameter(
            "speed_factor", &P::speed_factor, "-", {},
            "speed on a free road, in shares of the limit; drawn together with desired_speed: fast drivers are fast "
            "at any limit"),
        parameter("time_headway", &P::time_headway, "s", {}, "time gap kept to the leader"),
        parameter("minimum_gap", &P::minimum_gap, "m", {}, "gap kept at standstill"),
        parameter("maximum_acceleration", &P::maximum_acceleration, "m/s^2", {}, "from rest on a free road"),
        parameter("comfortable_deceleration", &P::comfortable_deceleration, "m/s^2", {},
                  "that the driver finds normal"),
        parameter("politeness", &P::politeness, "-", {}, "of lane changes, see `MobilRule`"),
        parameter("threshold", &P::threshold, "m/s^2", {}, "advantage for which it changes lanes"),
        parameter("change_duration", &P::change_duration, "s", {}, "of a lane change"),
        parameter("lateral_acceleration", &P::lateral_acceleration, "m/s^2", {}, "highest in bends"),
        parameter("time_margin", &P::time_margin, "s", {}, "between two vehicles at one place in a junction"),
        parameter("minor_road_margin", &P::minor_road_margin, "s", {}, "more for those that come from a minor road"),
        parameter("reaction", &P::reaction, "s", {}, "to lights"),
        parameter("rolling_speed", &P::rolling_speed, "m/s", {}, "that counts as a stop at stop signs"),
        parameter("signal_braking", &P::signal_braking, "m/s^2", {}, "up to which they stop at yellow"),
        parameter("bias", &P::bias, "m/s^2", Range{-10, 10}, "in favour of the outer lane, see `MobilRule`"),
        parameter("others_headway", &P::others_headway, "s", Range{0, 20},
                  "time gap with which they expect others to put up after a lane change"),
        parameter("lowest_acceleration", &P::lowest_acceleration, "m/s^2", Range{-50, -0.01}, "hardest braking"),
        parameter("jerk", &P::jerk, "m/s^3", Range{0.1, 1e6},
                  "highest change of the acceleration, unless they have to brake hard"));
  }

  /// Throws `ParameterError` if what is drawn can be out of the range of a driver's parameter.
  void check(std::string const& where) const {
    check_draws(desired_speed, {0.1, 100}, "desired_speed", "m/s", where);
    check_draws(speed_factor, {0.1, 3}, "speed_factor", "-", where);
    check_draws(time_headway, {0, 20}, "time_headway", "s", where);
    check_draws(minimum_gap, {0, 100}, "minimum_gap", "m", where);
    check_draws(maximum_acceleration, {0.01, 20}, "maximum_acceleration", "m/s^2", where);
    check_draws(comfortable_deceleration, {0.01, 20}, "comfortable_deceleration", "m/s^2", where);
    check_draws(politeness, {0, 1}, "politeness", "-", where);
    check_draws(threshold, {0, 20}, "threshold", "m/s^2", where);
    check_draws(change_duration, {0.5, 30}, "change_duration", "s", where);
    check_draws(lateral_acceleration, {0.1, 50}, "lateral_acceleration", "m/s^2", where);
    check_draws(time_margin, {0, 20}, "time_margin", "s", where);
    check_draws(minor_road_margin, {0, 20}, "minor_road_margin", "s", where);
    check_draws(reaction, {0, 10}, "reaction", "s", where);
    check_draws(rolling_speed, {0, 10}, "rolling_speed", "m/s", where);
    check_draws(signal_braking, {0.1, 20}, "signal_braking", "m/s^2", where);
  }

  /// The next of these people. Takes fourteen draws. Throws `ParameterError` if these are no people, see `check`.
  [[nodiscard]] presets::Temperament draw(RandomStream& random) const {
    check_parameters(*this);
    presets::Temperament one;
    auto same = random;  // one draw for both: fast is fast
    one.idm.desired_speed = desired_speed(same);
    one.speed_factor = speed_factor(random);
    one.idm.time_headway = time_headway(random);
    one.idm.minimum_gap = minimum_gap(random);
    one.idm.maximum_acceleration = maximum_acceleration(random);
    one.idm.comfortable_deceleration = comfortable_deceleration(random);
    one.idm.lowest_acceleration = lowest_acceleration;
    one.jerk = jerk;
    one.politeness = politeness(random);
    one.threshold = threshold(random);
    one.change_duration = change_duration(random);
    one.bias = bias;
    one.others_headway = others_headway;
    one.lateral_acceleration = lateral_acceleration(random);
    one.time_margin = time_margin(random);
    one.minor_road_margin = minor_road_margin(random);
    one.reaction = reaction(random);
    one.rolling_speed = rolling_speed(random);
    one.signal_braking = signal_braking(random);
    return one;
  }
};

namespace presets {

/// Drivers of cars on motorways.
[[nodiscard]] inline Population motorway_cars() { return {}; }

/// Drivers of lorries on motorways: speeds up to the limiter; the others around MovSim's lorries, spread: own.
[[nodiscard]] inline Population motorway_trucks() {
  Population p;
  p.desired_speed = TruncatedNormal{24.2, 1.0, 22.0, 26.0};
  p.bias = 0.6;
  p.speed_factor = TruncatedNormal{1.0, 0.04, 0.9, 1.1};
  p.time_headway = TruncatedNormal{1.7, 0.4, 0.9, 3.0};
  p.minimum_gap = TruncatedNormal{3.0, 0.7, 1.5, 5.0};
  p.maximum_acceleration = TruncatedNormal{0.8, 0.15, 0.5, 1.2};
  p.comfortable_deceleration = TruncatedNormal{1.6, 0.3, 1.0, 2.2};
  p.lateral_acceleration = TruncatedNormal{2.0, 0.2, 1.5, 2.6};
  p.signal_braking = TruncatedNormal{3.0, 0.3, 2.4, 3.6};
  p.lowest_acceleration = -6.0;
  return p;
}

/// Drivers of cars in town: headways fitted to Michael et al. 2000; accelerations fitted to HCM's saturation flow and
/// to Gates et al. 2007; speeds: DfT 2019.
[[nodiscard]] inline Population town_cars() {
  Population p;
  p.time_headway = TruncatedNormal{0.75, 1.05, 0.35, 3.3};
  p.maximum_acceleration = TruncatedNormal{2.3, 0.4, 1.3, 3.3};
  p.comfortable_deceleration = TruncatedNormal{2.6, 0.4, 1.4, 3.4};
  p.speed_factor = TruncatedNormal{1.02, 0.12, 0.7, 1.4};
  return p;
}

/// Drivers of lorries and buses in town: SUMO's acceleration of lorries, 1.3 m/s^2.
[[nodiscard]] inline Population town_trucks() {
  auto p = motorway_trucks();
  p.maximum_acceleration = TruncatedNormal{1.3, 0.2, 0.8, 1.8};
  return p;
}

}  // namespace presets

}  // namespace cambium::inline v0_1
