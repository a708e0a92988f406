#pragma once

/// Quantities of traffic that several rooms need. What one model chooses for itself stands with that model.
namespace cambium::inline v0_1 {

/// A vehicle slower than this counts as stopped, for drivers and for the rules of the road [m/s]. SUMO counts a slower
/// vehicle as halting.
inline constexpr double standing_speed = 0.1;

/// A vehicle slower than this counts as stopped where a metric asks whether it is to blame [m/s]; as in the at-fault
/// collisions of nuPlan's metrics (second-hand). It is below `standing_speed`, so that creeping into somebody counts.
inline constexpr double blameless_speed = 0.05;

/// Distance between the axles of `geometry::car` [m]: for models of vehicles that name none of their own.
inline constexpr double car_wheel_base = 2.7;

/// Times that differ by at most this count as equal [s]: sums of steps differ by rounding.
inline constexpr double same_time = 1e-9;

/// Bounds of comfort of nuPlan's metrics, from human drivers [m/s^2] (Karnchanachari et al. 2024).
inline constexpr double comfort_deceleration = 4.05, comfort_acceleration = 2.4, comfort_lateral_acceleration = 4.89;

}  // namespace cambium::inline v0_1
