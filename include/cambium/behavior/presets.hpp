#pragma once

#include <algorithm>
#include <type_traits>

#include "cambium/behavior/drivers.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/kinematic_point.hpp"
#include "cambium/dynamics/single_track.hpp"

/// Drivers from the literature as parameters of the car-following models, and vehicle models of cyclists and
/// pedestrians. For vehicle shapes see geometry/shape.hpp. The numbers of the papers are quoted second-hand and not
/// compared with the papers' tables. The papers do not bound accelerations; the bounds are ours.
namespace cambium::inline v0_1::presets {

/// Treiber, Hennecke, Helbing 2000, "Congested traffic states in empirical observations and microscopic simulations",
/// table I: 120 km/h, 1.6 s, 0.73 m/s^2, 1.67 m/s^2, 2 m. String unstable in dense traffic, as the paper intends.
[[nodiscard]] constexpr Idm treiber_2000() {
  return {.desired_speed = 120 / 3.6,
          .time_headway = 1.6,
          .minimum_gap = 2.0,
          .maximum_acceleration = 0.73,
          .comfortable_deceleration = 1.67,
          .lowest_acceleration = -8.0};
}

/// Car of Kesting, Treiber, Helbing 2010, "Enhanced intelligent driver model to access the impact of driving strategies
/// on traffic capacity", table 1: 120 km/h, 1.5 s, 1.4 m/s^2, 2 m/s^2, 2 m; the ACC model adds coolness 0.99.
[[nodiscard]] constexpr Idm kesting_2010_car() {
  return {.desired_speed = 120 / 3.6,
          .time_headway = 1.5,
          .minimum_gap = 2.0,
          .maximum_acceleration = 1.4,
          .comfortable_deceleration = 2.0,
          .lowest_acceleration = -8.0};
}

/// Truck of the same table: 85 km/h, 2 s, 0.7 m/s^2, 2 m/s^2, 4 m.
[[nodiscard]] constexpr Idm kesting_2010_truck() {
  return {.desired_speed = 85 / 3.6,
          .time_headway = 2.0,
          .minimum_gap = 4.0,
          .maximum_acceleration = 0.7,
          .comfortable_deceleration = 2.0,
          .lowest_acceleration = -6.0};
}

/// BARK's defaults (bark/commons/params, BaseIDM).
[[nodiscard]] constexpr Idm bark() {
  return {.desired_speed = 15.0,
          .time_headway = 1.5,
          .minimum_gap = 2.0,
          .maximum_acceleration = 1.7,
          .comfortable_deceleration = 1.67,
          .exponent = 4.0,
          .lowest_acceleration = -5.0,
          .highest_acceleration = 8.0};
}

/// A usual driver of a car: about the means of `motorway_cars` and `town_cars`.
[[nodiscard]] constexpr Idm normal() {
  return {.desired_speed = 120 / 3.6,
          .time_headway = 1.2,
          .minimum_gap = 2.0,
          .maximum_acceleration = 1.8,
          .comfortable_deceleration = 2.3,
          .lowest_acceleration = -8.0};
}

/// A driver in a hurry: short headway, high acceleration, late and hard braking (Treiber, Kesting 2013, "Traffic Flow
/// Dynamics", section 11.3.1). The numbers are ours, chosen around `normal`.
[[nodiscard]] constexpr Idm aggressive() {
  return {.desired_speed = 140 / 3.6,
          .time_headway = 0.9,
          .minimum_gap = 1.5,
          .maximum_acceleration = 2.2,
          .comfortable_deceleration = 3.0,
          .lowest_acceleration = -8.0};
}

/// A careful driver; the opposite of `aggressive`, chosen likewise.
[[nodiscard]] constexpr Idm timid() {
  return {.desired_speed = 100 / 3.6,
          .time_headway = 2.1,
          .minimum_gap = 3.0,
          .maximum_acceleration = 1.0,
          .comfortable_deceleration = 1.3,
          .lowest_acceleration = -8.0};
}

/// Gives a law the parameters of `idm`; a law other than IDM those that every law has.
template <CarFollowingLaw Law>
constexpr void follow_as(Idm const& idm, Law& law) {
  if constexpr (std::is_same_v<Law, Idm>) {
    law = idm;
  } else {
    law.desired_speed = idm.desired_speed;
    law.time_headway = idm.time_headway;
    law.minimum_gap = idm.minimum_gap;
    law.maximum_acceleration = idm.maximum_acceleration;
    law.comfortable_deceleration = idm.comfortable_deceleration;
    law.lowest_acceleration = idm.lowest_acceleration;
  }
}

/// What a driver's temperament means for a whole driver; the defaults are those of `normal`. Car following as in the
/// presets of the same name; politeness, threshold and safe braking of lane changes around the values of Kesting,
/// Treiber, Helbing 2007 (politeness 0: egoistic, up to 0.5: cooperative; 0.1 m/s^2; 4 m/s^2); speeds around the limit
/// as in SUMO, whose drivers' speed factor is normal(1, 0.1). The other numbers, and where in these ranges a
/// temperament lies, are ours.
struct Temperament {
  Idm idm = normal();
  double politeness = 0.2;            ///< `MobilRule::politeness` [-]
  double threshold = 0.2;             ///< `MobilRule::threshold` [m/s^2]
  double lane_change_braking = 4.0;   ///< `ChangeLanes::safe_deceleration`; 0.5 m/s^2 more abort one [m/s^2]
  double lateral_acceleration = 3.0;  ///< `Bends::lateral_acceleration` [m/s^2]
  double signal_braking = 3.6;        ///< `Signals::safe_deceleration`: higher, it stops at yellow more often [m/s^2]
  double bias = 0.0;                  ///< `MobilRule::bias` [m/s^2]
  double change_duration = 4.0;       ///< `LaneChangeCourse::duration` [s]
  double others_headway = 1.5;        ///< `ChangeLanes::others`: the headway that it expects others to keep [s]
  double merging_headway = 1.0;       ///< `KeepLane::merging_headway` [s]
  double late_at_red = 0.0;           ///< `Signals::late_at_red` [s]
  double speed_factor = 1.0;          ///< `SpeedLimit::factor` [-]
  double time_margin = 0.5;           ///< `Conflicts::time_margin` [s]
  double jerk = 2.5;                  ///< `Driver::jerk` [m/s^3]
  double minor_road_margin = 3.0;     ///< `Conflicts::minor_road_margin` [s]
  double reaction = 0.8;              ///< `Signals::reaction` [s]
  double rolling_speed = 0.0;         ///< `Signals::rolling_speed` [m/s]

  /// A temperament near this one: most numbers are drawn evenly within 25 % of their own, the speed factor within 10 %.
  /// Not drawn are `bias`, `jerk`, and the desired speed, the exponent, and the lowest and highest acceleration of
  /// `idm`. What is 0 stays 0.
  [[nodiscard]] Temperament drawn_around(RandomStream& random) const {
    auto one = *this;
    auto const vary = [&](double& number, double share = 0.25) {
      number *= 1.0 - share + 2.0 * share * uniform01(random);
    };
    for (auto* const number :
         {&one.idm.time_headway, &one.idm.minimum_gap, &one.idm.maximum_acceleration, &one.idm.comfortable_deceleration,
          &one.politeness, &one.threshold, &one.lane_change_braking, &one.lateral_acceleration, &one.signal_braking,
          &one.change_duration, &one.others_headway, &one.merging_headway, &one.late_at_red, &one.time_margin,
          &one.minor_road_margin, &one.reaction, &one.rolling_speed})
      vary(*number);
    vary(one.speed_factor, 0.1);
    return one;
  }

  /// `driver` with this temperament: sets those of the above that its parts have. A law other than IDM gets what every
  /// law has.
  template <class Law, class Lateral, class... Heeds>
  [[nodiscard]] constexpr Driver<Law, Lateral, Heeds...> of(Driver<Law, Lateral, Heeds...> driver) const {
    give(driver.law);
    give(driver.lateral);
    driver.jerk = jerk;
    if constexpr (Heeding<Heeds...>::template contains<Bends>)
      driver.template heed<Bends>().lateral_acceleration = lateral_acceleration;
    if constexpr (Heeding<Heeds...>::template contains<Signals>) {
      driver.template heed<Signals>().safe_deceleration = signal_braking;
      driver.template heed<Signals>().late_at_red = late_at_red;
      driver.template heed<Signals>().reaction = reaction;
      driver.template heed<Signals>().rolling_speed = rolling_speed;
    }
    if constexpr (Heeding<Heeds...>::template contains<SpeedLimit>)
      driver.template heed<SpeedLimit>().factor = speed_factor;
    if constexpr (Heeding<Heeds...>::template contains<Conflicts>) {
      driver.template heed<Conflicts>().time_margin = time_margin;
      driver.template heed<Conflicts>().minor_road_margin = minor_road_margin;
    }
    return driver;
  }
  /// The same for the driver in a wrapper, its `nominal`; one that responds late does so within half of the headway.
  template <class Wrapper>
  [[nodiscard]] constexpr Wrapper of(Wrapper wrapper) const requires requires {
    wrapper.nominal;
  }
  {
    wrapper.nominal = of(wrapper.nominal);
    if constexpr (requires { wrapper.reaction_time; })  // who is close pays attention
      wrapper.reaction_time = std::min(wrapper.reaction_time, 0.5 * idm.time_headway);
    return wrapper;
  }

 private:
  template <CarFollowingLaw Law>
  constexpr void give(Law& law) const {
    follow_as(idm, law);
  }
  constexpr void give(KeepLane& lateral) const { lateral.merging_headway = merging_headway; }
  constexpr void give(TrackLine& lateral) const { give(lateral.keep); }
  template <class Rule>
  constexpr void give(ChangeLanes<Rule>& lateral) const {
    give(lateral.keep);
    give(lateral.rule);
    lateral.course.duration = change_duration;
    lateral.others.time_headway = others_headway;
    lateral.safe_deceleration = lane_change_braking;
    lateral.abort_deceleration = lane_change_braking + 0.5;
  }
  template <class... Filters>
  constexpr void give(MobilRule<Filters...>& rule) const {
    rule.politeness = politeness;
    rule.threshold = threshold;
    rule.bias = bias;
  }
  template <class Other>
  constexpr void give(Other&) const {}
};

[[nodiscard]] constexpr Temperament timid_temperament() {
  return {.idm = timid(),
          .politeness = 0.5,
          .threshold = 0.3,
          .lane_change_braking = 2.0,
          .lateral_acceleration = 2.0,
          .signal_braking = 4.0,
          .merging_headway = 2.0,
          .speed_factor = 0.95,
          .time_margin = 2.0,
          .minor_road_margin = 4.0};
}
[[nodiscard]] constexpr Temperament aggressive_temperament() {
  return {.idm = aggressive(),
          .politeness = 0.0,
          .threshold = 0.1,
          .lane_change_braking = 5.0,
          .lateral_acceleration = 4.0,
          .signal_braking = 2.0,
          .merging_headway = 0.5,
          .late_at_red = 1.0,
          .speed_factor = 1.1,
          .time_margin = 0.3,
          .minor_road_margin = 2.0,
          .rolling_speed = 3.0};
}

/// A whole driver of that temperament, such as `timid<Mobil>()`, `aggressive<HumanDriver<Intersection>>()`. Its desired
/// speed is that of a motorway: set another one elsewhere, or let it heed `SpeedLimit`.
template <class Driver>
[[nodiscard]] constexpr Driver timid() {
  return timid_temperament().of(Driver{});
}
/// A driver of usual temperament: the parameters of `Temperament{}`.
template <class Driver>
[[nodiscard]] constexpr Driver normal() {
  return Temperament{}.of(Driver{});
}
/// A driver who keeps short gaps and changes lanes for small advantages.
template <class Driver>
[[nodiscard]] constexpr Driver aggressive() {
  return aggressive_temperament().of(Driver{});
}

/// A cyclist, to be combined with `bicycle_dynamics`. The numbers are ours: 18 km/h, slightly below SUMO's default
/// maximum speed of bicycles (20 km/h), gentle acceleration and braking, short gaps.
[[nodiscard]] constexpr Idm cyclist() {
  return {.desired_speed = 18 / 3.6,
          .time_headway = 1.0,
          .minimum_gap = 1.0,
          .maximum_acceleration = 0.8,
          .comfortable_deceleration = 1.5,
          .lowest_acceleration = -5.0};
}

/// How a cyclist keeps its lane: at the side. Drivers pass it within the lane where that is wide enough, see
/// `KeepLane`.
[[nodiscard]] constexpr KeepLane cyclist_lane() { return {.keep_to_side = true}; }

/// Vehicle model of a bicycle (`geometry::bicycle`). It is a single track, because a bicycle steers and cannot turn on
/// the spot. It brakes by at most 5 m/s^2, before its rear wheel lifts off (centre of mass 1.1 m high, 0.6 m behind the
/// front axle), and leans by at most 27 degrees.
[[nodiscard]] constexpr SingleTrack bicycle_dynamics() {
  return {.wheel_base = 1.1,
          .steering_limit = 0.8,
          .lowest_acceleration = -5.0,
          .highest_acceleration = 1.5,
          .lateral_acceleration_limit = 5.0};
}

/// Vehicle model of a pedestrian whose plans are executed through the dynamics: reaches 1.3 times the desired speed of
/// Helbing and Molnár 1995, and the accelerations of the social forces.
[[nodiscard]] constexpr KinematicPoint pedestrian_dynamics() {
  return {.wheel_base = 0.5,
          .yaw_rate_limit = 10.0,
          .lowest_acceleration = -10.0,
          .highest_acceleration = 10.0,
          .lateral_acceleration_limit = 10.0,
          .highest_speed = 3.0};
}

/// A driver with its name and the source of its numbers.
struct Preset {
  char const* name;
  char const* source;
  Idm parameters;
};

/// All drivers.
inline constexpr Preset all[] = {
    {"treiber_2000", "Treiber, Hennecke, Helbing 2000, table I (second-hand); bounds of acceleration: own",
     treiber_2000()},
    {"kesting_2010_car", "Kesting, Treiber, Helbing 2010, table 1 (second-hand); bounds of acceleration: own",
     kesting_2010_car()},
    {"kesting_2010_truck", "Kesting, Treiber, Helbing 2010, table 1 (second-hand); bounds of acceleration: own",
     kesting_2010_truck()},
    {"bark", "BARK's defaults", bark()},
    {"normal", "about the means of presets::motorway_cars and town_cars", normal()},
    {"aggressive", "own numbers; direction: Treiber, Kesting 2013, section 11.3.1", aggressive()},
    {"timid", "own numbers, likewise", timid()},
    {"cyclist", "own numbers, near SUMO's default speed of bicycles", cyclist()}};

}  // namespace cambium::inline v0_1::presets
