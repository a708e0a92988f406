#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "cambium/core/constants.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/integration.hpp"
#include "cambium/execution/execution_model.hpp"
#include "cambium/geometry/angle.hpp"

namespace cambium::inline v0_1 {

/// Delay and noise between a controller's commands and the vehicle. With a delay, the controller acts four times per
/// delay, and a command takes effect when the fourth one after it is given:
///
///     commands   c0    c1    c2    c3    c4    c5 ...
///     in effect  none  none  none  none  c0    c1 ...
///                |<------- delay ------->|
///
/// The controller acts at least once per period, so the delay is at most four periods.
struct Actuation {
  static constexpr int waiting = 4;

  double period = 0.05;
  double delay = 0.0;
  Normal acceleration_noise{0.0, 0.0};
  Normal steering_noise{0.0, 0.0};

  static constexpr char const* name = "actuation";
  static constexpr char const* summary = "delayed commands; normal noise on acceleration and steering";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("period", &Actuation::period, "s", Range{1e-3, 1}, "the controller acts at least this often"),
        parameter("delay", &Actuation::delay, "s", Range{0, 5},
                  "from a command to its effect: at most 4 periods, none below 4 ms; no command holds before that"),
        parameter("acceleration_noise", &Actuation::acceleration_noise, "m/s^2", {},
                  "added to the acceleration, drawn once a step"),
        parameter("steering_noise", &Actuation::steering_noise, "rad", {},
                  "added to the steering angle, drawn once a step"));
  }

  void check(std::string const& where) const {
    if (!(delay <= waiting * period * (1.0 + 1e-9)))
      throw ParameterError(where + ".delay", "is longer than 4 periods, but at most 4 commands can wait",
                           "give a period of at least " + detail::with_unit(detail::number_text(delay / waiting), "s"));
  }

  /// Time that each delayed command is in effect [s]; 0 if there is no delay.
  [[nodiscard]] double slot() const {
    constexpr double shortest = 1e-3;
    return delay / waiting < shortest ? 0.0 : delay / waiting;
  }

  /// Time from one command to the next [s] in a step of `duration` [s]: `slot()`, or without delay an equal part of the
  /// step.
  [[nodiscard]] double interval(double duration) const {
    return slot() > 0.0 ? slot() : duration / std::max(1.0, std::ceil(duration / period - 1e-9));
  }
};

/// Motion to track at one moment.
struct Reference {
  double x{}, y{}, heading{}, speed{};
  double curvature{};     ///< of the path [1/m]
  double acceleration{};  ///< [m/s^2]
};

/// Deviation of a vehicle from its reference.
struct TrackingError {
  double along{};    ///< ahead of the reference [m]
  double left{};     ///< to the left of the reference [m]
  double heading{};  ///< heading minus that of the reference [rad]
  double speed{};    ///< speed minus that of the reference [m/s]
};

/// Where `x` is relative to the reference.
template <MotionState S>
[[nodiscard]] TrackingError tracking_error(Reference const& reference, S const& x) {
  auto const [sin, cos] = portable::sin_cos(reference.heading);
  double const dx = x.x - reference.x, dy = x.y - reference.y;
  return {dx * cos + dy * sin, dy * cos - dx * sin, geometry::angle_difference(x.heading, reference.heading),
          x.speed - reference.speed};
}

/// The memory of a tracking controller: the reference at the end of the last step, and the waiting commands.
template <MotionState S>
struct TrackingMemory {
  static constexpr std::size_t slots = Actuation::waiting + 1;  ///< the first in effect, the others waiting

  S reference{};
  std::array<float, slots> acceleration{}, steering{};
  float waited = 0.0f;  ///< since the last command was given [s]
  bool begun = false;

  static constexpr char const* name = "tracking_memory";
  static constexpr auto parameters() {
    using P = TrackingMemory;
    return parameter_list(
        parameter("reference", &P::reference, "where the plan is now"),
        parameter("acceleration", &P::acceleration, "m/s^2", any_finite, "commands, the first in effect"),
        parameter("steering", &P::steering, "rad", any_finite, "likewise"),
        parameter("waited", &P::waited, "s", any_finite, "since the last command"),
        parameter("begun", &P::begun, "a command was given"));
  }

  friend bool operator==(TrackingMemory const&, TrackingMemory const&) = default;

  /// Adds a command; the oldest waiting one takes effect.
  void give(Action const& command) {
    std::copy(acceleration.begin() + 1, acceleration.end(), acceleration.begin());
    std::copy(steering.begin() + 1, steering.end(), steering.begin());
    acceleration[slots - 1] = static_cast<float>(command.acceleration);
    steering[slots - 1] = static_cast<float>(command.steering);
    waited = 0.0f;
  }
};

namespace detail {

/// The reference at `time` on the arc from `a` to `b`.
template <MotionState S>
[[nodiscard]] Reference reference_between(S const& a, S const& b, double time) {
  double const duration = b.time - a.time, u = std::clamp((time - a.time) / duration, 0.0, 1.0);
  double const dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
  double const turn = std::remainder(b.heading - a.heading, 2.0 * geometry::pi);
  double const curvature = squared > 1e-4 ? turn / std::sqrt(squared) : 0.0;
  double const bulge = -0.5 * u * (1.0 - u) * turn;  // height of the arc over its chord, per chord length
  return {a.x + u * dx - bulge * dy,
          a.y + u * dy + bulge * dx,
          a.heading + u * turn,
          a.speed + u * (b.speed - a.speed),
          curvature,
          (b.speed - a.speed) / duration};
}

/// The plan's reference at `time`. `start` is the state that precedes the plan's first sample.
template <MotionState S>
[[nodiscard]] Reference reference_at(BasicPlan<S> const& plan, S const& start, double time) {
  S const* before = &start;
  for (auto const& after : plan.trajectory) {
    if (after.time > before->time + same_time && time <= after.time + same_time)
      return reference_between(*before, after, time);
    before = &after;
  }
  return {before->x, before->y, before->heading, before->speed, 0.0, 0.0};
}

}  // namespace detail

/// Tracks a plan through the vehicle model from `now` to `time` [s]. The controller
/// `law(Reference, TrackingError, state, interval)` returns an `Action` to hold for `interval` [s]. The reference runs
/// through the plan's states and continues that of the last step, so that an error does not vanish with each new plan.
/// A plan that does not reach `time` is invalid. O(control periods).
template <class Law, MotionState S, class Dynamics>
[[nodiscard]] Executed<S> track(Actuation const& actuation, Law const& law, BasicPlan<S> const& plan, S const& now,
                                Dynamics const& dynamics, double time, TrackingMemory<S>& memory,
                                RandomStream& random) {
  if (plan.trajectory.empty() || !(plan.trajectory.back().time >= time - same_time)) return {};
  bool const goes_on = memory.begun && std::abs(memory.reference.time - now.time) < 1e-6;
  S const start = goes_on ? memory.reference : now;
  auto const draw = [&random](Normal const& noise) { return noise.deviation > 0.0 ? noise(random) : noise.mean; };
  Action const noise{draw(actuation.acceleration_noise), draw(actuation.steering_noise)};
  double const slot = actuation.slot(), interval = actuation.interval(time - now.time);
  S x = now;
  x.speed = std::max(0.0, x.speed);
  double h = 0.0;
  for (double left = time - now.time; left > same_time; left -= h) {
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
  memory.reference = plan.trajectory.back();  // for the fields that the dynamics add to the state
  memory.reference.x = end.x;
  memory.reference.y = end.y;
  memory.reference.heading = end.heading;
  memory.reference.speed = end.speed;
  memory.reference.time = x.time = time;
  return {x, true};
}

}  // namespace cambium::inline v0_1
