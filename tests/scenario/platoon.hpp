#pragma once

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/scenario/lane_traffic.hpp"

/// Traffic of one lane from town to country road, from dense to loose.
struct Platoon {
  double free_speed{};  ///< [m/s]
  cambium::LaneTraffic traffic{};
};

/// Draws one from 20 m to `end` [m].
inline Platoon draw_platoon(cambium::RandomStream& random, double end, cambium::VehicleMix const& mix = {}) {
  using cambium::Uniform;
  double const free_speed = Uniform{8.0, 30.0}(random);
  return {free_speed,
          {.begin = 20.0,
           .end = end,
           .speed = Uniform{Uniform{0.0, 0.8}(random)*free_speed, free_speed},
           .desired_speed = Uniform{0.85 * free_speed, 1.15 * free_speed},
           .headway = Uniform{0.8, Uniform{0.8, 2.5}(random)},
           .mix = mix}};
}
