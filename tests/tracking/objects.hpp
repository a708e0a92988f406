#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "cambium/tracking/tracked_object.hpp"

/// Lists for trackers.
namespace objects {

inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
inline constexpr std::int64_t system_clock = 1'764'580'000'000'000'000, cycle = 100'000'000;  // [ns]

inline cambium::TrackedObject object(std::uint64_t id, double x, double y, double heading, double speed) {
  return {.key = {0, id},
          .x = x,
          .y = y,
          .heading = heading,
          .vx = speed * std::cos(heading),
          .vy = speed * std::sin(heading)};
}

}  // namespace objects
