#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "idm.hpp"
#include "road.hpp"

// Yardstick L2: what a planner needs of a step. Neighbours by a persistent insertion sort, IDM, pure pursuit of a
// polyline with a cached cursor, a single track by Runge-Kutta 4 with the sines of libm, collisions of oriented boxes.

namespace yardstick {

/// A vehicle of the L2 world; reference point is the middle of the rear axle.
struct Vehicle {
  double time;     // [s]
  double x;        // [m]
  double y;        // [m]
  double heading;  // [rad]
  double speed;    // [m/s]
  double cosine;   // of the heading; pursuit, single track and boxes share them
  double sine;
  double position;      // arc length along its lane [m]
  double lateral;       // [m]
  double acceleration;  // [m/s^2]
  double front;         // reference point to bumper [m]
  double rear;
  double half_width;
  Driver driver;
  std::uint32_t lane;
  std::uint32_t segment;  // cursor on the lane's polyline
};

/// State (time, x, y, heading, speed) of the kinematic single track and its derivative.
using TrackState = std::array<double, 5>;

/// A heading's cosine and sine.
struct Direction {
  double cosine;
  double sine;
};

/// One call of libm's sincos.
[[nodiscard]] inline Direction direction_of(double heading) { return {std::cos(heading), std::sin(heading)}; }

/// Derivative for the path curvature [1/m] and acceleration [m/s^2] held over the step.
[[nodiscard]] inline TrackState derivative(TrackState const& x, Direction along, double curvature,
                                           double acceleration) {
  return {1.0, x[4] * along.cosine, x[4] * along.sine, x[4] * curvature, acceleration};
}

/// x + factor * slope.
[[nodiscard]] inline TrackState moved(TrackState const& x, TrackState const& slope, double factor) {
  TrackState result{};
  for (std::size_t i = 0; i < x.size(); ++i) result[i] = x[i] + factor * slope[i];
  return result;
}

/// Classic Runge-Kutta step of order 4. `along` is the direction at `x`, known from the step before: with the one that
/// the caller computes for the result, a step costs four pairs of sine and cosine.
[[nodiscard]] inline TrackState runge_kutta(TrackState const& x, Direction along, double curvature, double acceleration,
                                            double step) {
  TrackState const k1 = derivative(x, along, curvature, acceleration);
  TrackState const x2 = moved(x, k1, 0.5 * step);
  TrackState const k2 = derivative(x2, direction_of(x2[3]), curvature, acceleration);
  TrackState const x3 = moved(x, k2, 0.5 * step);
  TrackState const k3 = derivative(x3, direction_of(x3[3]), curvature, acceleration);
  TrackState const x4 = moved(x, k3, step);
  TrackState const k4 = derivative(x4, direction_of(x4[3]), curvature, acceleration);
  TrackState result{};
  for (std::size_t i = 0; i < x.size(); ++i) {
    result[i] = x[i] + step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
  }
  return result;
}

/// Do the boxes of two vehicles overlap? Separating axes, first those of `a`.
[[nodiscard]] inline bool overlap(Vehicle const& a, Vehicle const& b) {
  double const length_a = 0.5 * (a.front + a.rear);
  double const length_b = 0.5 * (b.front + b.rear);
  double const centre_a = 0.5 * (a.front - a.rear);
  double const centre_b = 0.5 * (b.front - b.rear);
  double const dx = b.x + centre_b * b.cosine - a.x - centre_a * a.cosine;
  double const dy = b.y + centre_b * b.sine - a.y - centre_a * a.sine;
  double const parallel = std::abs(a.cosine * b.cosine + a.sine * b.sine);
  double const crossed = std::abs(a.cosine * b.sine - a.sine * b.cosine);
  if (std::abs(dx * a.cosine + dy * a.sine) > length_a + length_b * parallel + b.half_width * crossed) return false;
  if (std::abs(dy * a.cosine - dx * a.sine) > a.half_width + b.half_width * parallel + length_b * crossed) return false;
  if (std::abs(dx * b.cosine + dy * b.sine) > length_b + length_a * parallel + a.half_width * crossed) return false;
  return std::abs(dy * b.cosine - dx * b.sine) <= b.half_width + a.half_width * parallel + length_a * crossed;
}

/// Vehicles on a winding road of three lanes whose end joins its start. Copy assignment between worlds of the same
/// number of vehicles allocates nothing: three copies of flat arrays, the road is shared.
class FullWorld {
 public:
  FullWorld(Road const& road, std::size_t vehicles, std::uint64_t seed = 1) : road_(&road) {
    Uniform uniform(seed);
    double const spacing = road.lanes[1].length() / static_cast<double>((vehicles + lane_count - 1) / lane_count);
    for (std::size_t i = 0; i < vehicles; ++i) {
      auto const lane = static_cast<std::uint32_t>(i % lane_count);
      double const place = static_cast<double>(i / lane_count) * spacing + uniform(0.0, 8.0);
      vehicles_.push_back(placed(lane, place, uniform));
      sweep_.push_back({0.0, 0.0, static_cast<std::uint32_t>(i)});
      order_.push_back(static_cast<std::uint32_t>(i));
    }
    auto const& all = vehicles_;
    std::sort(order_.begin(), order_.end(), [&all](auto a, auto b) { return before(all[a], all[b]); });
    for (auto& entry : sweep_) entry.low = all[entry.vehicle].x;
    std::sort(sweep_.begin(), sweep_.end(), [](auto const& a, auto const& b) { return a.low < b.low; });
  }

  /// Advances every vehicle by `step_length` and returns the number of pairs that overlap now. O(vehicles).
  std::size_t step() {
    sort_neighbours();
    accelerate();
    return advance();
  }

  /// The same where vehicle 0 accelerates as told [m/s^2].
  std::size_t step_with(double acceleration) {
    sort_neighbours();
    accelerate();
    vehicles_[0].acceleration = std::max(acceleration, -vehicles_[0].speed / step_length);
    return advance();
  }

  [[nodiscard]] std::vector<Vehicle> const& vehicles() const { return vehicles_; }

  /// Mean speed [m/s].
  [[nodiscard]] double mean_speed() const {
    double sum = 0.0;
    for (auto const& vehicle : vehicles_) sum += vehicle.speed;
    return sum / static_cast<double>(vehicles_.size());
  }

 private:
  std::size_t advance() {
    for (auto& vehicle : vehicles_) drive(vehicle);
    return collisions();
  }

  struct Extent {
    double low;  // along x [m]
    double high;
    std::uint32_t vehicle;
  };

  [[nodiscard]] Vehicle placed(std::uint32_t lane, double place, Uniform& uniform) const {
    LaneLine const& line = road_->lanes[lane];
    auto const pose = line.ahead(place, 0);
    Vehicle vehicle{};
    vehicle.x = pose.x;
    vehicle.y = pose.y;
    auto const projection = line.project(pose, vehicle.segment);
    auto const direction = line.segment(vehicle.segment).direction;
    vehicle.position = projection.position;
    vehicle.heading = std::atan2(direction.y, direction.x);
    vehicle.cosine = direction.x;
    vehicle.sine = direction.y;
    vehicle.speed = 8.0;
    vehicle.front = uniform(3.3, 4.1);
    vehicle.rear = 1.0;
    vehicle.half_width = uniform(0.85, 0.98);
    vehicle.driver = sample_driver(uniform, 11.0, 16.0);
    vehicle.lane = lane;
    return vehicle;
  }

  [[nodiscard]] static bool before(Vehicle const& a, Vehicle const& b) {
    return a.lane != b.lane ? a.lane < b.lane : a.position < b.position;
  }

  // Insertion sort of nearly sorted vehicles: one comparison each while nobody passes the end of the road.
  void sort_neighbours() {
    for (std::size_t i = 1; i < order_.size(); ++i) {
      std::uint32_t const moving = order_[i];
      std::size_t k = i;
      for (; k > 0 && before(vehicles_[moving], vehicles_[order_[k - 1]]); --k) order_[k] = order_[k - 1];
      order_[k] = moving;
    }
  }

  void accelerate() {
    std::size_t first = 0;  // of the lane
    for (std::size_t i = 0; i < order_.size(); ++i) {
      Vehicle& self = vehicles_[order_[i]];
      bool const is_last = i + 1 == order_.size() || vehicles_[order_[i + 1]].lane != self.lane;
      Vehicle const& leader = vehicles_[order_[is_last ? first : i + 1]];
      double const turn = is_last ? road_->lanes[self.lane].length() : 0.0;
      double const gap = leader.position + turn - leader.rear - self.position - self.front;
      double const wanted = idm_acceleration(self.driver, self.speed, gap, leader.speed);
      self.acceleration = std::max(wanted, -self.speed / step_length);
      if (is_last) first = i + 1;
    }
  }

  // Pure pursuit, single track, projection of the new place.
  void drive(Vehicle& vehicle) const {
    LaneLine const& lane = road_->lanes[vehicle.lane];
    Point const aim = lane.ahead(vehicle.position + 4.0 + 0.6 * vehicle.speed, vehicle.segment);
    double const dx = aim.x - vehicle.x;
    double const dy = aim.y - vehicle.y;
    double const left = dy * vehicle.cosine - dx * vehicle.sine;
    double const curvature = std::clamp(2.0 * left / (dx * dx + dy * dy), -0.2, 0.2);
    TrackState const now{vehicle.time, vehicle.x, vehicle.y, vehicle.heading, vehicle.speed};
    Direction const along{vehicle.cosine, vehicle.sine};
    TrackState const next = runge_kutta(now, along, curvature, vehicle.acceleration, step_length);
    vehicle.time = next[0];
    vehicle.x = next[1];
    vehicle.y = next[2];
    vehicle.heading = next[3];
    vehicle.speed = std::max(0.0, next[4]);
    Direction const direction = direction_of(vehicle.heading);
    vehicle.cosine = direction.cosine;
    vehicle.sine = direction.sine;
    auto const projection = lane.project({vehicle.x, vehicle.y}, vehicle.segment);
    vehicle.position = projection.position;
    vehicle.lateral = projection.lateral;
    if (vehicle.position >= lane.length()) restart(vehicle, lane);
  }

  void restart(Vehicle& vehicle, LaneLine const& lane) const {
    vehicle.x += road_->shift.x;
    vehicle.y += road_->shift.y;
    vehicle.position -= lane.length();
    vehicle.segment -= lane.period();
  }

  // Sweep and prune along x; the order is kept between steps. Pairs across the end of the road are not looked at.
  [[nodiscard]] std::size_t collisions() {
    for (std::size_t i = 0; i < sweep_.size(); ++i) {
      Extent const moving = extent(sweep_[i].vehicle);
      std::size_t k = i;
      for (; k > 0 && moving.low < sweep_[k - 1].low; --k) sweep_[k] = sweep_[k - 1];
      sweep_[k] = moving;
    }
    std::size_t count = 0;
    for (std::size_t i = 0; i < sweep_.size(); ++i) {
      for (std::size_t k = i + 1; k < sweep_.size() && sweep_[k].low <= sweep_[i].high; ++k) {
        if (overlap(vehicles_[sweep_[i].vehicle], vehicles_[sweep_[k].vehicle])) ++count;
      }
    }
    return count;
  }

  [[nodiscard]] Extent extent(std::uint32_t i) const {
    Vehicle const& vehicle = vehicles_[i];
    double const centre = vehicle.x + 0.5 * (vehicle.front - vehicle.rear) * vehicle.cosine;
    double const half =
        0.5 * (vehicle.front + vehicle.rear) * std::abs(vehicle.cosine) + vehicle.half_width * std::abs(vehicle.sine);
    return {centre - half, centre + half, i};
  }

  std::vector<Vehicle> vehicles_;
  std::vector<std::uint32_t> order_;  // by lane, then by position; kept from step to step
  std::vector<Extent> sweep_;         // by lower end along x; kept from step to step
  Road const* road_;
};

}  // namespace yardstick
