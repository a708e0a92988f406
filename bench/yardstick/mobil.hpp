#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "idm.hpp"

// Yardstick L1: IDM and MOBIL (Kesting, Treiber, Helbing 2007) on a ring of three lanes, an array of structs per lane.

namespace yardstick {

inline constexpr double politeness = 0.3;
inline constexpr double change_threshold = 0.15;  ///< [m/s^2]
inline constexpr double safe_braking = -3.0;      ///< [m/s^2]
inline constexpr double cool_down = 5.0;          ///< no second change within this time [s]

/// Vehicles on three rings that change lanes at once when MOBIL advises it; all decide on the same state.
class MobilRing {
 public:
  explicit MobilRing(std::size_t vehicles, std::uint64_t seed = 1) {
    Uniform uniform(seed);
    std::size_t const longest = (vehicles + lane_count - 1) / lane_count;
    length_ = static_cast<double>(std::max<std::size_t>(longest, 2)) * mean_spacing;
    for (auto& lane : lanes_) lane.reserve(vehicles);
    changes_.reserve(vehicles);
    for (std::size_t i = 0; i < vehicles; ++i) {
      double const place = static_cast<double>(i / lane_count) * mean_spacing + uniform(0.0, 8.0);
      lanes_[i % lane_count].push_back({place, 8.0, uniform(4.2, 5.2), 0.0, 0.0, sample_driver(uniform, 11.0, 16.0)});
    }
  }

  /// Advances every vehicle by `step_length`. O(vehicles) but for the rare moves between and around the lanes.
  void step() {
    for (auto& lane : lanes_) accelerate(lane);
    changes_.clear();
    for (std::size_t lane = 0; lane < lane_count; ++lane) decide(lane);
    for (auto const& change : changes_) apply(change);
    for (auto& lane : lanes_) move(lane);
  }

  /// Lane changes since the start.
  [[nodiscard]] std::uint64_t change_count() const { return change_count_; }

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
      for (std::size_t i = 0; i < lane.size(); ++i) smallest = std::min(smallest, gap(lane[i], leader(lane, i + 1)));
    }
    return smallest;
  }

 private:
  struct Vehicle {
    double position;  // of the front bumper, in [0, length of the ring)
    double speed;
    double length;
    double acceleration;
    double rest;  // time until the next change is allowed [s]
    Driver driver;
  };
  using Lane = std::vector<Vehicle>;

  // A vehicle seen from another one: unrolled once round the ring where needed.
  struct View {
    Vehicle const* vehicle;
    double position;
  };

  struct Change {
    std::uint32_t from;
    std::uint32_t to;
    double position;  // finds the vehicle again when earlier changes have shifted it
  };

  [[nodiscard]] View leader(Lane const& lane, std::size_t i) const {
    return i < lane.size() ? View{&lane[i], lane[i].position} : View{&lane[0], lane[0].position + length_};
  }

  // The vehicle before index `i`.
  [[nodiscard]] View follower(Lane const& lane, std::size_t i) const {
    return i > 0 ? View{&lane[i - 1], lane[i - 1].position} : View{&lane.back(), lane.back().position - length_};
  }

  [[nodiscard]] static double gap(Vehicle const& vehicle, View const& leader) {
    return leader.position - leader.vehicle->length - vehicle.position;
  }

  [[nodiscard]] static double acceleration(Vehicle const& vehicle, double gap, Vehicle const& leader) {
    return idm_acceleration(vehicle.driver, vehicle.speed, gap, leader.speed);
  }

  void accelerate(Lane& lane) const {
    for (std::size_t i = 0; i < lane.size(); ++i) {
      View const ahead = leader(lane, i + 1);
      lane[i].acceleration = acceleration(lane[i], gap(lane[i], ahead), *ahead.vehicle);
    }
  }

  // Merge walk: as the vehicles of a lane come in order, so do their neighbours in the lanes beside it.
  void decide(std::size_t from) {
    Lane const& lane = lanes_[from];
    std::array<std::size_t, 2> next{0, 0};
    for (std::size_t i = 0; i < lane.size(); ++i) {
      if (lane[i].rest > 0.0) continue;
      View const behind = follower(lane, i);
      View const ahead = leader(lane, i + 1);
      double const gap_closed = ahead.position - ahead.vehicle->length - behind.position;
      double const relief = acceleration(*behind.vehicle, gap_closed, *ahead.vehicle) - behind.vehicle->acceleration;
      double best = change_threshold;
      std::size_t target = from;
      for (std::size_t side = 0; side < 2; ++side) {
        std::size_t const to = from + 2 * side - 1;  // wraps below zero to a large number
        if (to >= lane_count) continue;
        while (next[side] < lanes_[to].size() && lanes_[to][next[side]].position < lane[i].position) ++next[side];
        double const gain = incentive(lane[i], lanes_[to], next[side], relief);
        if (gain > best) best = gain, target = to;
      }
      if (target != from) {
        changes_.push_back({static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(target), lane[i].position});
      }
    }
  }

  // MOBIL's gain of joining `lane` before index `next`; a large negative number when there is no room or no safety.
  [[nodiscard]] double incentive(Vehicle const& self, Lane const& lane, std::size_t next, double relief) const {
    if (lane.empty()) return acceleration(self, length_ - self.length, self) - self.acceleration + politeness * relief;
    View const ahead = leader(lane, next);
    View const behind = follower(lane, next);
    double const gap_ahead = gap(self, ahead);
    double const gap_behind = self.position - self.length - behind.position;
    if (gap_ahead < 1.0 || gap_behind < 1.0) return hardest_braking;
    double const follows = acceleration(*behind.vehicle, gap_behind, self);
    if (follows < safe_braking) return hardest_braking;
    double const cost = follows - behind.vehicle->acceleration;
    return acceleration(self, gap_ahead, *ahead.vehicle) - self.acceleration + politeness * (cost + relief);
  }

  // Looks at the gap again, for a vehicle from the other side may have taken it; mends the accelerations around.
  void apply(Change const& change) {
    auto const before = [](Vehicle const& vehicle, double position) { return vehicle.position < position; };
    Lane& from = lanes_[change.from];
    Lane& to = lanes_[change.to];
    auto const old_place = std::lower_bound(from.begin(), from.end(), change.position, before);
    auto const new_place = std::lower_bound(to.begin(), to.end(), change.position, before);
    auto const next = static_cast<std::size_t>(new_place - to.begin());
    auto const left = static_cast<std::size_t>(old_place - from.begin());
    if (incentive(*old_place, to, next, 0.0) <= hardest_braking) return;
    Vehicle self = *old_place;
    self.rest = cool_down;
    from.erase(old_place);
    to.insert(new_place, self);
    mend(to, next + 1);
    mend(to, next);
    if (!from.empty()) mend(from, left);
    ++change_count_;
  }

  // Recomputes the acceleration of the vehicle before index `i`.
  void mend(Lane& lane, std::size_t i) const {
    Vehicle& vehicle = lane[(i + lane.size() - 1) % lane.size()];
    View ahead = leader(lane, i);
    if (i == 0) ahead.position += length_;
    vehicle.acceleration = acceleration(vehicle, gap(vehicle, ahead), *ahead.vehicle);
  }

  void move(Lane& lane) const {
    for (auto& vehicle : lane) {
      double const speed = std::max(0.0, vehicle.speed + vehicle.acceleration * step_length);
      vehicle.position += 0.5 * (vehicle.speed + speed) * step_length;
      vehicle.speed = speed;
      vehicle.rest -= step_length;
    }
    while (!lane.empty() && lane.back().position >= length_) {
      lane.back().position -= length_;
      std::rotate(lane.begin(), lane.end() - 1, lane.end());
    }
  }

  std::array<Lane, lane_count> lanes_;
  std::vector<Change> changes_;
  double length_ = 0.0;
  std::uint64_t change_count_ = 0;
};

}  // namespace yardstick
