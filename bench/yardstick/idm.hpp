#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

// Yardstick L0: what car following alone costs, with nothing around it. No map, no policies, no allocation in a step.

namespace yardstick {

inline constexpr std::size_t lane_count = 3;
inline constexpr double step_length = 0.2;       ///< [s]
inline constexpr double hardest_braking = -8.0;  ///< [m/s^2]
inline constexpr double mean_spacing = 30.0;     ///< between front bumpers in one lane [m]

/// Uniform numbers for set-up (SplitMix64; Steele, Lea, Flood 2014).
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : state_(seed) {}

  [[nodiscard]] double operator()(double low, double high) {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    z ^= z >> 31;
    return low + (high - low) * static_cast<double>(z >> 11) * 0x1.0p-53;
  }

 private:
  std::uint64_t state_;
};

/// IDM parameters of one vehicle, constants folded.
struct Driver {
  double inverse_desired_speed;  ///< [s/m]
  double time_headway;           ///< [s]
  double standstill_gap;         ///< [m]
  double acceleration;           ///< [m/s^2]
  double inverse_root;           ///< 1 / (2 sqrt(a b)) [s^2/m]
};

/// A driver with moderately scattered habits; desired speed between `slow` and `fast` [m/s].
[[nodiscard]] inline Driver sample_driver(Uniform& uniform, double slow, double fast) {
  double const acceleration = uniform(1.2, 1.8);
  double const braking = uniform(1.6, 2.4);
  return {1.0 / uniform(slow, fast), uniform(1.0, 1.4), uniform(1.5, 2.5), acceleration,
          0.5 / std::sqrt(acceleration * braking)};
}

/// Intelligent Driver Model (Treiber, Hennecke, Helbing 2000), gap [m] clamped from below, braking clamped [m/s^2].
[[nodiscard]] inline double idm_acceleration(Driver const& driver, double speed, double gap, double leader_speed) {
  double const dynamic = speed * driver.time_headway + speed * (speed - leader_speed) * driver.inverse_root;
  double const wanted = driver.standstill_gap + std::max(0.0, dynamic);
  double const interaction = wanted / std::max(gap, 0.1);
  double const freedom = speed * driver.inverse_desired_speed;
  double const square = freedom * freedom;
  return std::max(hardest_braking, driver.acceleration * (1.0 - square * square - interaction * interaction));
}

/// Vehicles on three rings; each lane sorted by position, IDM, trapezoidal position, one synchronous pass in place.
class IdmRing {
 public:
  explicit IdmRing(std::size_t vehicles, std::uint64_t seed = 1) {
    Uniform uniform(seed);
    std::size_t const longest = (vehicles + lane_count - 1) / lane_count;
    length_ = static_cast<double>(std::max<std::size_t>(longest, 2)) * mean_spacing;
    for (std::size_t i = 0; i < vehicles; ++i) {
      double const place = static_cast<double>(i / lane_count) * mean_spacing + uniform(0.0, 8.0);
      lanes_[i % lane_count].push_back({place, 8.0, uniform(4.2, 5.2), sample_driver(uniform, 11.0, 16.0)});
    }
  }

  /// Advances every vehicle by `step_length`. O(vehicles).
  void step() {
    for (auto& lane : lanes_) {
      if (lane.empty()) continue;
      if (lane.front().position >= length_) rebase(lane);
      double const first_rear = lane.front().position - lane.front().length + length_;
      double const first_speed = lane.front().speed;
      std::size_t const last = lane.size() - 1;
      for (std::size_t i = 0; i < last; ++i) {
        advance(lane[i], lane[i + 1].position - lane[i + 1].length, lane[i + 1].speed);
      }
      advance(lane[last], first_rear, first_speed);
    }
  }

  /// Mean speed [m/s].
  [[nodiscard]] double mean_speed() const {
    double sum = 0.0;
    double count = 0.0;
    for (auto const& lane : lanes_) {
      for (auto const& vehicle : lane) sum += vehicle.speed, count += 1.0;
    }
    return sum / count;
  }

  /// Smallest gap between bumpers [m].
  [[nodiscard]] double smallest_gap() const {
    double smallest = length_;
    for (auto const& lane : lanes_) {
      for (std::size_t i = 0; i < lane.size(); ++i) {
        auto const& leader = lane[(i + 1) % lane.size()];
        double const turn = i + 1 == lane.size() ? length_ : 0.0;
        smallest = std::min(smallest, leader.position + turn - leader.length - lane[i].position);
      }
    }
    return smallest;
  }

 private:
  struct Vehicle {
    double position;  // of the front bumper [m]
    double speed;
    double length;
    Driver driver;
  };

  static void advance(Vehicle& vehicle, double leader_rear, double leader_speed) {
    double const acceleration =
        idm_acceleration(vehicle.driver, vehicle.speed, leader_rear - vehicle.position, leader_speed);
    double const speed = std::max(0.0, vehicle.speed + acceleration * step_length);
    vehicle.position += 0.5 * (vehicle.speed + speed) * step_length;
    vehicle.speed = speed;
  }

  // Positions grow without wrapping, so the order never changes; once a turn all are set back together.
  void rebase(std::vector<Vehicle>& lane) const {
    for (auto& vehicle : lane) vehicle.position -= length_;
  }

  std::array<std::vector<Vehicle>, lane_count> lanes_;
  double length_ = 0.0;
};

}  // namespace yardstick
