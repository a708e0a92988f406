#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "cambium/core/distributions.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/integration.hpp"
#include "cambium/execution/execution_model.hpp"
#include "cambium/geometry/angle.hpp"

namespace cambium {

/// How a vehicle carries out what its controller commands: late, and not quite. Where there is a delay, the controller
/// acts four times in its course, and each command takes effect when the fourth after it is given. As it acts at least
/// once a period, a delay may be four periods long.
struct Actuation {
  static constexpr int waiting = 4;

  double period = 0.05;
  double delay = 0.0;
  Normal acceleration_noise{0.0, 0.0};
  Normal steering_noise{0.0, 0.0};

  static constexpr char const* name = "actuation";
  static constexpr char const* summary = "delay of the commands, normal noise of acceleration and steering";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("period", &Actuation::period, "s", Range{1e-3, 1}, "the controller acts at least this often"),
        parameter("delay", &Actuation::delay, "s", Range{0, 5},
                  "from a command to its effect; at first there is none; below 4 ms at once; up to 4 periods"),
        parameter("acceleration_noise", &Actuation::acceleration_noise, "m/s^2", {},
                  "added to the acceleration, drawn once a step"),
        parameter("steering_noise", &Actuation::steering_noise, "rad", {},
                  "added to the steering angle, drawn once a step"));
  }

  void check(std::string const& where) const {
    if (!(delay <= waiting * period * (1.0 + 1e-9)))
      throw ParameterError(where + ".delay", "is longer than 4 periods: so many commands wait at most",
                           "give a period of at least " + detail::with_unit(detail::number_text(delay / waiting), "s"));
  }

  /// How long each waiting command is in effect [s]; 0 where none waits.
  [[nodiscard]] double slot() const {
    constexpr double shortest = 1e-3;
    return delay / waiting < shortest ? 0.0 : delay / waiting;
  }

  /// From one command to the next in a step of `duration` [s]: equal parts of it, or a waiting command's time [s].
  [[nodiscard]] double interval(double duration) const {
    return slot() > 0.0 ? slot() : duration / std::max(1.0, std::ceil(duration / period - 1e-9));
  }
};

/// What is to be tracked at a moment.
struct Reference {
  double x{}, y{}, heading{}, speed{};
  double curvature{};     ///< of the course [1/m]
  double acceleration{};  ///< [m/s^2]
};

/// Where a vehicle is relative to its reference.
struct TrackingError {
  double along{};    ///< how far it is ahead [m]
  double left{};     ///< how far to the left [m]
  double heading{};  ///< its heading minus that of the reference [rad]
  double speed{};    ///< its speed minus that of the reference [m/s]
};

template <MotionState S>
[[nodiscard]] TrackingError tracking_error(Reference const& reference, S const& x) {
  auto const [sin, cos] = geometry::sin_cos(reference.heading);
  double const dx = x.x - reference.x, dy = x.y - reference.y;
  return {dx * cos + dy * sin, dy * cos - dx * sin, geometry::angle_difference(x.heading, reference.heading),
          x.speed - reference.speed};
}

/// What a tracking controller remembers: where the last plan ended, and the commands on their way.
template <MotionState S>
struct TrackingMemory {
  static constexpr std::size_t slots = Actuation::waiting + 1;  ///< one in effect, the others waiting

  S reference{};
  float acceleration[slots]{}, steering[slots]{};
  float waited = 0.0f;  ///< since the last command was given [s]
  bool begun = false;

  friend bool operator==(TrackingMemory const&, TrackingMemory const&) = default;

  /// Gives a command; the oldest one that waits comes into effect.
  void give(Action const& command) {
    std::copy(acceleration + 1, acceleration + slots, acceleration);
    std::copy(steering + 1, steering + slots, steering);
    acceleration[slots - 1] = static_cast<float>(command.acceleration);
    steering[slots - 1] = static_cast<float>(command.steering);
    waited = 0.0f;
  }
};

namespace detail {

/// The reference at `time` on the way from `a` to `b`, an arc.
template <MotionState S>
[[nodiscard]] Reference reference_between(S const& a, S const& b, double time) {
  double const duration = b.time - a.time, u = std::clamp((time - a.time) / duration, 0.0, 1.0);
  double const dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
  double const turn = std::remainder(b.heading - a.heading, 2.0 * geometry::pi);
  double const curvature = squared > 1e-4 ? turn / std::sqrt(squared) : 0.0;
  double const bulge = -0.5 * u * (1.0 - u) * turn;  // of the arc over its chord, per chord length
  return {a.x + u * dx - bulge * dy,
          a.y + u * dy + bulge * dx,
          a.heading + u * turn,
          a.speed + u * (b.speed - a.speed),
          curvature,
          (b.speed - a.speed) / duration};
}

/// The plan's reference at `time`; `start` is where it begins if its first sample is later.
template <MotionState S>
[[nodiscard]] Reference reference_at(BasicPlan<S> const& plan, S const& start, double time) {
  S const* before = &start;
  for (auto const& after : plan.trajectory) {
    if (after.time > before->time + 1e-9 && time <= after.time + 1e-9) return reference_between(*before, after, time);
    before = &after;
  }
  return {before->x, before->y, before->heading, before->speed, 0.0, 0.0};
}

}  // namespace detail

/// Tracks a plan through the vehicle model from `now` to `time` [s] by a controller
/// `law(Reference, TrackingError, state, interval)` that returns an `Action` to be held for `interval` [s]. The
/// reference runs through the plan's states, from the end of the last plan on; a plan that does not reach `time` is
/// invalid. O(control periods).
template <class Law, MotionState S, class Dynamics>
[[nodiscard]] Executed<S> track(Actuation const& actuation, Law const& law, BasicPlan<S> const& plan, S const& now,
                                Dynamics const& dynamics, double time, TrackingMemory<S>& memory,
                                RandomStream& random) {
  if (plan.trajectory.empty() || !(plan.trajectory.back().time >= time - 1e-9)) return {};
  bool const goes_on = memory.begun && std::abs(memory.reference.time - now.time) < 1e-6;
  S const start = goes_on ? memory.reference : now;
  auto const draw = [&random](Normal const& noise) { return noise.deviation > 0.0 ? noise(random) : noise.mean; };
  Action const noise{draw(actuation.acceleration_noise), draw(actuation.steering_noise)};
  double const slot = actuation.slot(), interval = actuation.interval(time - now.time);
  S x = now;
  x.speed = std::max(0.0, x.speed);
  double h = 0.0;
  for (double left = time - now.time; left > 1e-9; left -= h) {
    h = std::min(left, interval);
    bool const gives = slot == 0.0 || !memory.begun || memory.waited >= static_cast<float>(slot - 1e-6);
    Action command{};
    if (gives) {
      auto const reference = detail::reference_at(plan, start, time - left);
      command = law(reference, tracking_error(reference, x), x, interval);
      if (slot > 0.0) memory.give(command);
    }
    if (slot > 0.0) {
      h = std::min(h, std::max(1e-6, slot - static_cast<double>(memory.waited)));
      memory.waited += static_cast<float>(h);
      command = {memory.acceleration[0], memory.steering[0]};
    }
    memory.begun = true;
    x = drive(dynamics, x, {command.acceleration + noise.acceleration, command.steering + noise.steering}, h);
  }
  auto const end = detail::reference_at(plan, start, time);
  memory.reference = plan.trajectory.back();  // whatever the state holds beside its motion
  memory.reference.x = end.x;
  memory.reference.y = end.y;
  memory.reference.heading = end.heading;
  memory.reference.speed = end.speed;
  memory.reference.time = x.time = time;
  return {x, true};
}

}  // namespace cambium
