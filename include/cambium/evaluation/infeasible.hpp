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

namespace cambium::inline v0_1 {

/// Whether the motion of an agent's last step is one that no vehicle can make, by its states before and after it:
///
/// - `way`: it is longer or shorter than its speeds allow: mean speed times dt, and what the hardest braking and
///   throttle between the two speeds add or take;
/// - `sideways`: it leads off its headings, by more than a curvature that changes within grip can;
/// - `acceleration`: it changes its speed faster than its dynamics permits, where that has bounds, or than grip does;
/// - `turn`: it turns more than its way times tan(steering limit) / wheel base;
/// - `grip`: it turns harder than tyres can or its dynamics permits, or sqrt(a_along^2 + a_across^2) is more than tyres
///   can, or than its dynamics permits where that is more.
///
/// The reference point is the rear axle, as in `SingleTrack`. A speed, a place and a heading may each be off by a
/// tolerance in each step, but not in every step: with a `Drift` that the caller keeps, errors add up, and their sums
/// have bounds, too: 5 cm/s sideways pass, 6 cm/s do not. These are for steps of up to 0.25 s: within longer ones a
/// vehicle can swerve and return, or start and stop, and is then taken for one that drifts. True only right after a
/// step, see `World::before_step`; who enters or does not move is never infeasible. O(1).
struct Infeasible {
  /// What is wrong with a motion.
  enum class Flaw : std::uint8_t {
    none,
    way,
    sideways,
    acceleration,
    turn,
    grip,
    drift,
    side_drift,
    turn_drift,
    speed_drift
  };
  /// Sums of an agent's errors in its last steps; an error fades with a time constant of 2 s.
  struct Drift {
    double along = 0.0;   ///< by how much its way was longer than its speeds say [m]
    double across = 0.0;  ///< how far it led to the left of its headings [m]
    double turn = 0.0;    ///< by how much it turned more than it can [rad]
    double speed = 0.0;   ///< by how much it changed its speed more than it can [m/s]
  };
  /// The flaw, what was driven, and what would be possible.
  struct Finding {
    Flaw flaw = Flaw::none;
    double driven = 0.0, possible = 0.0;

    /// How far it is beyond what is possible, to compare findings.
    [[nodiscard]] double excess() const { return std::abs(driven - possible) / std::max(1.0, std::abs(possible)); }

    /// "changes its speed by -53 m/s^2, possible are -9 m/s^2".
    friend std::string to_string(Finding const& finding) {
      struct Words {
        char const *does, *unit;
      };
      constexpr Words words[] = {{"", ""},
                                 {"moves", " m in a step"},
                                 {"moves sideways by", " m in a step"},
                                 {"changes its speed by", " m/s^2"},
                                 {"turns by", " rad in a step"},
                                 {"needs", " m/s^2 of its tyres"},
                                 {"drifts from its speeds by", " m in 2 s"},
                                 {"drifts off its headings by", " m in 2 s"},
                                 {"turns more than it can, by", " rad in 2 s"},
                                 {"changes its speed more than it can, by", " m/s in 2 s"}};
      auto const& [does, unit] = words[static_cast<std::size_t>(finding.flaw)];
      if (finding.flaw == Flaw::none) return "moves as vehicles can";
      return std::string(does) + " " + detail::rounded_text(finding.driven) + unit + ", possible are " +
             detail::rounded_text(finding.possible);
    }
  };

  double grip = 10.0;
  double place = 0.05;
  double heading = 0.01;
  double speed = 0.05;
  double drift = 0.1;

  static constexpr char const* name = "infeasible";
  static constexpr char const* summary = "makes a motion that no vehicle can make";
  static constexpr auto parameters() {
    using P = Infeasible;
    return parameter_list(parameter("grip", &P::grip, "m/s^2", Range{0.1, 100}, "of the tyres, along and across"),
                          parameter("place", &P::place, "m", Range{0, 10}, "tolerance of positions in a step"),
                          parameter("heading", &P::heading, "rad", Range{0, 1}, "tolerance of headings"),
                          parameter("speed", &P::speed, "m/s", Range{0, 10}, "tolerance of speeds"),
                          parameter("drift", &P::drift, "m", Range{0, 10}, "tolerance of positions in 2 s"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    return finding(world, slot).flaw != Flaw::none;
  }

  /// What is wrong with the last step of the agent at `slot`; brings its sums of errors up to date.
  template <class World>
  [[nodiscard]] Finding finding(World const& world, Slot slot, Drift& drifts) const {
    auto const* const before = world.before_step();
    auto const& now = world.frame().agents[slot];
    if (before != nullptr && drove((*before)[slot].status, now.status))
      return between((*before)[slot].state, now.state, world.roster().agents[slot].dynamics, drifts);
    drifts = {};
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
  [[nodiscard]] Finding between(S const& before, S const& now, Dynamics const& dynamics, Drift& drifts) const {
    auto const earlier = std::exchange(drifts, {});  // a step that is impossible by itself starts it anew
    double const dt = now.time - before.time;
    if (!(dt > 0.0)) return {};
    if (double const sum = now.x + now.y + now.heading + now.speed; !std::isfinite(sum)) return {Flaw::way, sum, 0.0};
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
    double const way = mean * dt, slack = spare + speed * dt + place, farthest = std::abs(way) + slack;
    if (along > way + slack) return {Flaw::way, along, way + slack};
    if (along < chord * way - slack) return {Flaw::way, along, chord * way - slack};
    double const bend = largest_bend_of(dynamics);
    bool const steers = std::isfinite(bend);  // others turn on the spot, and then go anywhere
    double const swing = steers ? std::min(most * dt, bend * farthest * farthest) / 6.0
                                : most * dt / 6.0 + std::abs(portable::sin_cos(0.5 * turn).sin) * farthest;
    bool const rests = std::max(before.speed, now.speed) <= speed;
    double const off = (rests ? place * std::min(1.0, 0.25 * dt) : place) + 0.5 * heading * std::abs(along) + swing;
    if (std::abs(across) > off) return {Flaw::sideways, across, std::copysign(off, across)};
    double const slowest = std::min(before.speed, mean);  // dynamics ask for limits at the begin of a step
    double const turned = std::max(0.0, std::abs(turn) - heading), moving = std::max(0.0, slowest - speed);
    if (turned > bend * farthest) return {Flaw::turn, turn, std::copysign(bend * farthest, turn)};
    double const lateral = moving * turned / dt, most_lateral = largest_lateral_of(dynamics);
    if (lateral > most_lateral) return {Flaw::grip, lateral, most_lateral};
    double const braked = std::max(0.0, std::abs(a) - inexact), used = portable::hypot(lateral, braked);
    double const most_used = std::max(grip, portable::hypot(lowest, most_lateral));
    if (used > most_used) return {Flaw::grip, used, most_used};

    double const faded = portable::exp(-dt / fading);
    double const grips = moving > 0.0 ? most_lateral * dt / moving : std::numeric_limits<double>::infinity();
    drifts = {faded * earlier.along + along - chord * way, steers ? faded * earlier.across + across : 0.0,
              faded * earlier.turn + std::max(0.0, std::abs(turn) - std::min(bend * std::abs(way), grips)),
              faded * earlier.speed + std::max({0.0, change - highest * dt, lowest * dt - change})};
    double const far = drift + most * dt / 8.0, aside = drift + most * dt / 24.0;  // a stop within a step adds to these
    if (std::abs(drifts.along) > far) return {Flaw::drift, drifts.along, std::copysign(far, drifts.along)};
    if (std::abs(drifts.across) > aside) return {Flaw::side_drift, drifts.across, std::copysign(aside, drifts.across)};
    double const round = 2.0 * heading + (steers ? bend * far : 0.0);
    if (drifts.turn > round) return {Flaw::turn_drift, drifts.turn, round};
    if (drifts.speed > 2.0 * speed) return {Flaw::speed_drift, drifts.speed, 2.0 * speed};
    return {};
  }

 private:
  static constexpr double fading = 2.0;  ///< time constant [s]

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
  /// Largest acceleration across the heading, of what the dynamics permits and grip.
  template <class Dynamics>
  [[nodiscard]] double largest_lateral_of(Dynamics const& dynamics) const {
    if constexpr (requires { dynamics.visit([](auto const&) {}); })
      return dynamics.visit([&](auto const& one) { return largest_lateral_of(one); });
    else if constexpr (requires { dynamics.lateral_acceleration_limit; })
      return std::min(grip, dynamics.lateral_acceleration_limit);
    else
      return grip;
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

}  // namespace cambium::inline v0_1
