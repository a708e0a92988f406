#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/behavior/driver/limits.hpp"
#include "cambium/core/described.hpp"

/// A law of a user's own: Gipps 1981, "A behavioural car-following model for computer simulation", eq. 11.
struct Gipps {
  double desired_speed = 15.0, time_headway = 1.0, minimum_gap = 2.0;
  double maximum_acceleration = 1.7, comfortable_deceleration = 2.0, lowest_acceleration = -8.0;

  static constexpr char const* name = "gipps";
  static constexpr auto parameters() {
    using P = Gipps;
    return cambium::parameter_list(
        cambium::parameter("desired_speed", &P::desired_speed, "m/s", cambium::Range{0.1, 100}, "on a free road"),
        cambium::parameter("time_headway", &P::time_headway, "s", cambium::Range{0.1, 10}, "reaction time"));
  }
  [[nodiscard]] double acceleration(double v, double desired, cambium::Constraint const& leader) const {
    double const t = time_headway, b = comfortable_deceleration, u = v / desired;
    double const free = 2.5 * maximum_acceleration * (1.0 - u) * std::sqrt(0.025 + u);
    if (std::isinf(leader.gap)) return free;
    double const root = b * (2.0 * (leader.gap - minimum_gap) - v * t) + leader.speed * leader.speed + b * b * t * t;
    return std::min(free, (-b * t + std::sqrt(std::max(0.0, root)) - v) / t);
  }
};
static_assert(cambium::CarFollowingLaw<Gipps>);
