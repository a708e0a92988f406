#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/state.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/world/frame.hpp"

namespace cambium {

/// Whether the motion of an agent's last step is one that no vehicle can make, by its states before and after it:
///
/// - `way`: it is longer or shorter than its speeds allow: mean speed times dt, and what the hardest braking and
///   throttle between the two speeds add or take;
/// - `sideways`: it leads off its headings, by more than a curvature that changes within grip can;
/// - `acceleration`: it changes its speed faster than its dynamics permits, where that has bounds, or than grip does;
/// - `turn`: it turns more than its way times tan(steering limit) / wheel base;
/// - `grip`: sqrt(a_along^2 + a_across^2) is more than tyres can, or than its dynamics permits where that is more;
/// - `drift`, `side_drift`: single steps are possible, but what they are too long or lead off the headings adds up,
/// over
///   about a second, to more than one step may be off. Only with a `Drift` that its caller keeps.
///
/// The reference point is the rear axle, as in `SingleTrack`. A speed, a place and a heading may each be off by a
/// tolerance in each step. True only right after a step, see `World::before_step`; who enters or stands still is never
/// infeasible. O(1).
struct Infeasible {
  /// What is wrong with a motion.
  enum class Flaw : std::uint8_t { none, way, sideways, acceleration, turn, grip, drift, side_drift };
  /// How far an agent's last steps were longer than its speeds say, and led to the left of its headings [m]; an error
  /// fades with a time constant of 1 s.
  struct Drift {
    double along = 0.0, across = 0.0;
  };
  /// The flaw, what was driven, and what would be possible.
  struct Finding {
    Flaw flaw = Flaw::none;
    double driven = 0.0, possible = 0.0;

    /// How far it is beyond what is possible, to compare findings.
    [[nodiscard]] double excess() const { return std::abs(driven - possible) / std::max(1.0, std::abs(possible)); }

    /// "changes its speed by -53 m/s^2, possible are -9 m/s^2".
    friend std::string to_string(Finding const& finding) {
      constexpr char const* does[] = {"",         "moves", "moves sideways by",         "changes its speed by",
                                      "turns by", "needs", "drifts from its speeds by", "drifts off its headings by"};
      constexpr char const* unit[] = {"",
                                      " m in a step",
                                      " m in a step",
                                      " m/s^2",
                                      " rad in a step",
                                      " m/s^2 of its tyres",
                                      " m in a second",
                                      " m in a second"};
      auto const which = static_cast<std::size_t>(finding.flaw);
      if (which == 0) return "moves as vehicles can";
      return std::string(does[which]) + " " + detail::rounded_text(finding.driven) + unit[which] + ", possible are " +
             detail::rounded_text(finding.possible);
    }
  };

  double grip = 10.0;
  double place = 0.05;
  double heading = 0.01;
  double speed = 0.05;

  static constexpr char const* name = "infeasible";
  static constexpr char const* summary = "makes a motion that no vehicle can make";
  static constexpr auto parameters() {
    using P = Infeasible;
    return parameter_list(parameter("grip", &P::grip, "m/s^2", Range{0.1, 100}, "of the tyres, along and across"),
                          parameter("place", &P::place, "m", Range{0, 10}, "tolerance of positions in a step"),
                          parameter("heading", &P::heading, "rad", Range{0, 1}, "tolerance of headings"),
                          parameter("speed", &P::speed, "m/s", Range{0, 10}, "tolerance of speeds"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    return finding(world, slot).flaw != Flaw::none;
  }

  /// What is wrong with the last step of the agent at `slot`; brings its `drift` up to date.
  template <class World>
  [[nodiscard]] Finding finding(World const& world, Slot slot, Drift& drift) const {
    auto const* const before = world.before_step();
    auto const& now = world.frame().agents[slot];
    if (before != nullptr && now.status == AgentStatus::driving && (*before)[slot].status == AgentStatus::driving)
      return between((*before)[slot].state, now.state, world.roster().agents[slot].dynamics, drift);
    drift = {};
    return {};
  }
  /// The same of a step alone.
  template <class World>
  [[nodiscard]] Finding finding(World const& world, Slot slot) const {
    Drift none;
    return finding(world, slot, none);
  }

  /// The same for two states of a vehicle.
  template <MotionState S, class Dynamics>
  [[nodiscard]] Finding between(S const& before, S const& now, Dynamics const& dynamics, Drift& drift) const {
    auto const earlier = std::exchange(drift, {});  // a step that is impossible by itself starts it anew
    double const dt = now.time - before.time;
    if (!(dt > 0.0)) return {};
    double const turn = geometry::angle_difference(now.heading, before.heading);
    double const mean = 0.5 * (before.speed + now.speed), change = now.speed - before.speed;
    double const a = change / dt, inexact = speed / dt;
    auto const [lowest, highest] = accelerations_of(dynamics);
    if (a < lowest - inexact) return {Flaw::acceleration, a, lowest};
    if (a > highest + inexact) return {Flaw::acceleration, a, highest};
    // The way at these two speeds: from braking first and then going, to the reverse, by what grip allows.
    double const most = grip * dt, spare = std::max(0.0, (most * most - change * change) / (4.0 * grip));
    double const chord = std::abs(turn) > 1e-6 ? 2.0 * portable::sin_cos(0.5 * turn).sin / turn : 1.0;
    auto const middle = portable::sin_cos(before.heading + 0.5 * turn);
    double const dx = now.x - before.x, dy = now.y - before.y;
    double const along = dx * middle.cos + dy * middle.sin, across = dy * middle.cos - dx * middle.sin;
    double const way = mean * dt, slack = spare + speed * dt + place;
    if (along > way + slack) return {Flaw::way, along, way + slack};
    if (along < chord * way - slack) return {Flaw::way, along, chord * way - slack};
    double const off = place + 0.5 * heading * std::abs(along) + grip * dt * dt / 6.0;
    if (std::abs(across) > off) return {Flaw::sideways, across, std::copysign(off, across)};
    double const bend = largest_bend_of(dynamics), turned = std::max(0.0, std::abs(turn) - heading);
    if (turned > bend * (std::abs(way) + slack)) return {Flaw::turn, turn, bend * (std::abs(way) + slack)};
    double const lateral = std::max(0.0, mean - speed) * turned / dt, braked = std::max(0.0, std::abs(a) - inexact);
    double const used = std::sqrt(lateral * lateral + braked * braked);
    double const most_grip = std::max(grip, portable::hypot(lowest, largest_lateral_of(dynamics)));
    if (used > most_grip) return {Flaw::grip, used, most_grip};
    double const faded = portable::exp(-dt);
    drift = {faded * earlier.along + along - chord * way, faded * earlier.across + across};
    if (std::abs(drift.along) > slack) return {Flaw::drift, drift.along, std::copysign(slack, drift.along)};
    if (std::abs(drift.across) > off) return {Flaw::side_drift, drift.across, std::copysign(off, drift.across)};
    return {};
  }

 private:
  struct Accelerations {
    double lowest, highest;
  };
  /// Of what the dynamics permits and grip: dynamics without such bounds have grip's.
  template <class Dynamics>
  [[nodiscard]] Accelerations accelerations_of(Dynamics const& dynamics) const {
    if constexpr (requires { dynamics.visit([](auto const&) {}); })
      return dynamics.visit([&](auto const& one) { return accelerations_of(one); });
    else if constexpr (requires { dynamics.lowest_acceleration + dynamics.highest_acceleration; })
      return {std::max(-grip, dynamics.lowest_acceleration), std::min(grip, dynamics.highest_acceleration)};
    else
      return {-grip, grip};
  }
  /// Largest acceleration across the heading that the dynamics permits; 0 where it has no such bound.
  template <class Dynamics>
  [[nodiscard]] static double largest_lateral_of(Dynamics const& dynamics) {
    if constexpr (requires { dynamics.visit([](auto const&) {}); })
      return dynamics.visit([](auto const& one) { return largest_lateral_of(one); });
    else if constexpr (requires { dynamics.lateral_acceleration_limit; })
      return dynamics.lateral_acceleration_limit;
    else
      return 0.0;
  }
  /// Largest curvature [1/m] that the steering permits; infinite where the dynamics has none.
  template <class Dynamics>
  [[nodiscard]] double largest_bend_of(Dynamics const& dynamics) const {
    if constexpr (requires { dynamics.visit([](auto const&) {}); })
      return dynamics.visit([&](auto const& one) { return largest_bend_of(one); });
    else if constexpr (requires { dynamics.steering_limit / dynamics.wheel_base; })
      return portable::tan(dynamics.steering_limit) / dynamics.wheel_base;
    else
      return std::numeric_limits<double>::infinity();
  }
};

}  // namespace cambium
