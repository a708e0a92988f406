#pragma once

#include <algorithm>
#include <cmath>
#include <deque>

#include "cambium/core/constants.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/evaluation/off_road.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/world/frame.hpp"

namespace cambium {

/// How well an agent drove, from 0 to 1: the closed-loop score of nuPlan (Karnchanachari et al. 2024, "Towards
/// learning-based planning: the nuPlan benchmark for real-world autonomous driving", with the thresholds of its
/// implementation). The product of four terms for what must not happen (collisions at fault, leaving the road, driving
/// against the direction, not coming forward), times the weighted mean of four for how it is done (time to collision,
/// progress, speed limit, comfort). nuPlan compares progress with a human driver's; here `expected_progress` takes the
/// place of that. Not judged: whether an object was hit that is no vehicle, which nuPlan punishes less.
struct ClosedLoopScore {
  double expected_progress = 0.0;
  double least_time_to_collision = 0.95;

  ClosedLoopScore() = default;
  /// `progress` [m] takes the place of a human driver's.
  explicit ClosedLoopScore(double progress) : expected_progress(progress) {}

  static constexpr char const* name = "closed_loop_score";
  static constexpr char const* summary = "nuPlan's closed-loop score of a run, 0 to 1";
  static constexpr char const* source = "Karnchanachari et al. 2024";
  static constexpr auto parameters() {
    using P = ClosedLoopScore;
    return parameter_list(parameter("expected_progress", &P::expected_progress, "m", non_negative,
                                    "way that a good driver makes in the time of the run; 0: progress is not judged"),
                          parameter("least_time_to_collision", &P::least_time_to_collision, "s", Range{0, 60},
                                    "a shorter time is dangerous"));
  }

  static constexpr bool needs_history = true;

  /// Precondition: the world keeps a history of one frame.
  template <class World>
  void observe(World& world, Slot slot, double dt) {
    auto const& record = world.frame().agents[slot];
    if (record.status != AgentStatus::driving) return;
    bool const collides = AtFaultCollision{}(world, slot);
    is_at_fault_ = is_at_fault_ || collides;
    is_off_road_ = is_off_road_ || OffRoad{}(world, slot);
    is_close_ =
        is_close_ || (record.state.speed > blameless_speed && TimeToCollision{}(world, slot) < least_time_to_collision);
    if (dt <= 0.0) return;
    duration_ += dt;
    double const way = record.state.speed * dt;
    progress_ += Progress{}(world, slot) * dt;
    excess_ += SpeedLimitExcess{}(world, slot) * dt;
    against_.push_back({world.time(), OncomingLane{}(world, slot) ? way : 0.0});
    while (world.time() - against_.front().time >= 1.0) against_.pop_front();
    double in_a_second = 0.0;
    for (auto const& step : against_) in_a_second += step.way;
    most_against_ = std::max(most_against_, in_a_second);
    is_uncomfortable_ = is_uncomfortable_ || !is_comfortable(world, slot, dt);
  }

  [[nodiscard]] double value() const {
    double const ratio = expected_progress > 0.0 ? std::clamp(progress_ / expected_progress, 0.0, 1.0) : 1.0;
    double const direction = most_against_ < 2.0 ? 1.0 : most_against_ < 6.0 ? 0.5 : 0.0;
    if (is_at_fault_ || is_off_road_ || ratio < 0.2) return 0.0;
    constexpr double most_excess = 2.23;  // [m/s] over the whole run: no points
    double const limit = duration_ > 0.0 ? std::max(0.0, 1.0 - excess_ / (most_excess * duration_)) : 1.0;
    double const weighted = 5.0 * !is_close_ + 5.0 * ratio + 4.0 * limit + 2.0 * !is_uncomfortable_;
    return direction * weighted / 16.0;
  }

 private:
  /// Bounds of nuPlan, taken from human drivers.
  template <class World>
  [[nodiscard]] bool is_comfortable(World& world, Slot slot, double dt) {
    double const along = Acceleration{}(world, slot), across = LateralAcceleration{}(world, slot);
    bool comfortable = along >= -comfort_deceleration && along <= comfort_acceleration &&
                       std::abs(across) <= comfort_lateral_acceleration;
    if (world.history_size() > 0) {
      auto const &now = world.frame().agents[slot].state, &before = world.history(1).agents[slot].state;
      double const turn = geometry::angle_difference(now.heading, before.heading) / dt;
      comfortable = comfortable && std::abs(turn) <= 0.95;
      if (has_turn_) comfortable = comfortable && std::abs(turn - turn_) / dt <= 1.93;
      if (has_turn_) comfortable = comfortable && std::abs(Jerk{}(world, slot)) <= 4.13;
      turn_ = turn;
      has_turn_ = true;
    }
    return comfortable;
  }

  struct Against {
    double time, way;
  };

  bool is_at_fault_ = false, is_off_road_ = false, is_close_ = false, is_uncomfortable_ = false, has_turn_ = false;
  double duration_ = 0.0, progress_ = 0.0, excess_ = 0.0, most_against_ = 0.0, turn_ = 0.0;
  std::deque<Against> against_;  ///< of the last second
};

}  // namespace cambium
