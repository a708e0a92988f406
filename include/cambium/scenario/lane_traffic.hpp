#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/presets.hpp"
#include "cambium/core/distribution.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/random.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/scenario/vehicle_mix.hpp"

namespace cambium::inline v0_1 {

/// A vehicle sampled for a lane corridor.
struct LaneVehicle {
  double s{};      ///< corridor position of its reference point [m]
  double speed{};  ///< [m/s]
  geometry::Shape shape;
  IdmClassic driver;
};

/// Random traffic on a stretch of a lane corridor. Draws size, driver, speed and gap of each vehicle. By default every
/// gap is large enough for the follower to stay behind its leader by comfortable braking; given a distribution of gaps,
/// they are as drawn.
struct LaneTraffic {
  double begin = 0.0;
  double end = 200.0;
  Distribution speed = Uniform{8.0, 14.0};
  Distribution desired_speed = Uniform{11.0, 16.0};
  Distribution headway = Uniform{0.8, 2.5};
  std::optional<Distribution> gap{};
  VehicleMix mix{};

  static constexpr char const* name = "lane_traffic";
  static constexpr auto parameters() {
    using P = LaneTraffic;
    return parameter_list(
        parameter("begin", &P::begin, "m", Range{-1e6, 1e6}, "first position on the corridor that a vehicle may cover"),
        parameter("end", &P::end, "m", Range{-1e6, 1e6}, "last position that a vehicle may cover"),
        parameter("speed", &P::speed, "m/s", {}, "at the start, but no more than the desired one"),
        parameter("desired_speed", &P::desired_speed, "m/s", {}, "of the drivers; trucks: 85 % of it"),
        parameter("headway", &P::headway, "s", {},
                  "time gap to the leader, besides the minimum gap and what braking to "
                  "its speed takes"),
        parameter("gap", &P::gap, "m", {}, "instead of headway: bumper to bumper"),
        parameter("mix", &P::mix, "which vehicles"));
  }

  /// Throws `ParameterError` if what is drawn can be out of range.
  void check(std::string const& where) const {
    check_draws(speed, {0, 100}, "speed", "m/s", where);
    check_draws(desired_speed, {0.1, 100}, "desired_speed", "m/s", where);
    check_draws(headway, {0, 60}, "headway", "s", where);
    if (gap) check_draws(*gap, {0, 1e4}, "gap", "m", where);
  }

  /// Samples vehicles from the front of the stretch to its rear. Throws `ParameterError` if a parameter is out of
  /// range. O(vehicles).
  [[nodiscard]] std::vector<LaneVehicle> sample(RandomStream& random) const { return sample(random, mix); }

  /// As above; `draw_shape(random)` returns the next vehicle's shape.
  template <class DrawShape>
  [[nodiscard]] std::vector<LaneVehicle> sample(RandomStream& random, DrawShape const& draw_shape) const {
    check_parameters(*this);
    std::vector<LaneVehicle> vehicles;
    double front_end = end;  // the next vehicle must stay behind this position
    double leader_speed = speed.highest();
    while (true) {
      LaneVehicle v;
      v.shape = draw_shape(random);
      bool const heavy = v.shape.length() > 7.5;
      v.driver.law.desired_speed = desired_speed(random) * (heavy ? 0.85 : 1.0);
      v.driver.law.time_headway = Uniform{1.0, 1.8}(random);
      v.driver.law.minimum_gap = Uniform{1.5, 2.5}(random);
      v.driver.law.maximum_acceleration = heavy ? 0.8 : Uniform{1.2, 2.0}(random);
      if (v.shape == geometry::bicycle()) {
        v.driver = {.law = presets::cyclist(), .lateral = presets::cyclist_lane()};
      }
      v.speed = std::min(speed(random), v.driver.law.desired_speed);
      double const drawn = gap ? (*gap)(random) : headway(random);
      double const room = vehicles.empty() ? (gap ? drawn * uniform01(random) : 0.0)
                          : gap            ? drawn
                                           : safe_gap(v.driver, v.speed, leader_speed, drawn);
      v.s = front_end - room - v.shape.front;
      if (v.s - v.shape.rear < begin) return vehicles;
      vehicles.push_back(v);
      front_end = v.s - v.shape.rear;
      leader_speed = v.speed;
    }
  }

  /// Gap [m] at which the follower can stay behind a leader of constant speed by braking no harder than its comfortable
  /// deceleration. `headway` [s]: additional time gap.
  [[nodiscard]] static double safe_gap(IdmClassic const& driver, double speed, double leader_speed, double headway) {
    double const closing = std::max(0.0, speed - leader_speed);
    return driver.law.minimum_gap + speed * headway + closing * closing / (2 * driver.law.comfortable_deceleration);
  }
};

}  // namespace cambium::inline v0_1
