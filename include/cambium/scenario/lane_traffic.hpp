#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cambium/behavior/following/idm_classic.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/random.hpp"
#include "cambium/geometry/shape.hpp"

namespace cambium {

/// A vehicle sampled for a lane corridor.
struct LaneVehicle {
  double s{};      ///< corridor position of its reference point [m]
  double speed{};  ///< [m/s]
  geometry::Shape shape;
  IdmClassic driver;
};

/// Random traffic on a stretch of a lane corridor. Draws speed, headway, driver and size of each vehicle. Every gap is
/// large enough for the follower to stay behind its leader by comfortable braking.
struct LaneTraffic {
  double begin = 0.0;
  double end = 200.0;
  double lowest_speed = 8.0;
  double highest_speed = 14.0;
  double lowest_desired_speed = 11.0;
  double highest_desired_speed = 16.0;
  double shortest_headway = 0.8;
  double longest_headway = 2.5;
  double truck_share = 0.1;

  static constexpr char const* name = "lane_traffic";
  static constexpr auto parameters() {
    using P = LaneTraffic;
    return parameter_list(
        parameter("begin", &P::begin, "m", Range{-1e6, 1e6}, "first position on the corridor that a vehicle may cover"),
        parameter("end", &P::end, "m", Range{-1e6, 1e6}, "last position that a vehicle may cover"),
        parameter("lowest_speed", &P::lowest_speed, "m/s", Range{0, 100}, "lowest initial speed"),
        parameter("highest_speed", &P::highest_speed, "m/s", Range{0, 100}, "highest initial speed"),
        parameter("lowest_desired_speed", &P::lowest_desired_speed, "m/s", Range{0.1, 100},
                  "of the drivers; trucks: 85 % of it"),
        parameter("highest_desired_speed", &P::highest_desired_speed, "m/s", Range{0.1, 100},
                  "of the drivers; trucks: 85 % of it"),
        parameter("shortest_headway", &P::shortest_headway, "s", Range{0, 60},
                  "shortest initial time gap to the leader"),
        parameter("longest_headway", &P::longest_headway, "s", Range{0, 60}, "longest initial time gap to the leader"),
        parameter("truck_share", &P::truck_share, "-", Range{0, 1}, "share of trucks"));
  }

  /// Throws `ParameterError` if a lowest or shortest value is above its highest or longest.
  void check(std::string const& where) const {
    if (!(lowest_speed <= highest_speed && lowest_desired_speed <= highest_desired_speed &&
          shortest_headway <= longest_headway))
      throw ParameterError(where, "a lowest or shortest value is above its highest or longest", "swap them");
  }

  /// Samples vehicles from the front of the stretch to its rear. Throws `ParameterError` if a parameter is out of
  /// range. O(vehicles).
  [[nodiscard]] std::vector<LaneVehicle> sample(RandomStream& random) const {
    check_parameters(*this);
    std::vector<LaneVehicle> vehicles;
    double front_end = end;  // the next vehicle must stay behind this position
    double leader_speed = highest_speed;
    while (true) {
      LaneVehicle v;
      bool const truck = uniform01(random) < truck_share;
      v.shape = truck ? geometry::truck() : geometry::car();
      v.driver.desired_speed = between(lowest_desired_speed, highest_desired_speed, random) * (truck ? 0.85 : 1.0);
      v.driver.time_headway = between(1.0, 1.8, random);
      v.driver.minimum_gap = between(1.5, 2.5, random);
      v.driver.maximum_acceleration = truck ? 0.8 : between(1.2, 2.0, random);
      v.speed = std::min(between(lowest_speed, highest_speed, random), v.driver.desired_speed);
      double const headway = between(shortest_headway, longest_headway, random);
      double const gap = vehicles.empty() ? 0.0 : safe_gap(v.driver, v.speed, leader_speed, headway);
      v.s = front_end - gap - v.shape.front;
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
    return driver.minimum_gap + speed * headway + closing * closing / (2 * driver.comfortable_deceleration);
  }

 private:
  [[nodiscard]] static double between(double low, double high, RandomStream& random) {
    return Uniform{low, high}(random);
  }
};

}  // namespace cambium
