#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "cambium/core/ids.hpp"
#include "cambium/tracking/tracked_object.hpp"

namespace cambium::inline v0_1 {

/// Where a tracked object is at one time: of the point that its host gives (`TrackedObject::point`), in the map frame.
struct PredictedState {
  double x = 0.0, y = 0.0;  ///< [m]
  double heading = 0.0;     ///< of its front [rad]
  double speed = 0.0;       ///< along the heading; negative where it reverses [m/s]

  friend bool operator==(PredictedState const&, PredictedState const&) = default;
};

/// What sets a mode of an object apart from those along other ways.
enum class Maneuver : std::uint8_t {
  as_expected,    ///< drives, stands or walks on as the tracker's model of it does
  changes_left,   ///< into the lane to its left
  changes_right,  ///< likewise
  keeps_lane,     ///< although it has begun to change
  goes_first,     ///< heeds nobody at junctions, although it has to yield
  brakes_on,      ///< as hard as measured, to a standstill
  starts,         ///< although it stands for no reason
  given,          ///< a trajectory of the host
  none,           ///< the object has no mode of this number, or is not tracked
};

/// One of the ways in which an object may go on. One that the object does not have has the maneuver `none`, the
/// probability 0, and the states of what is expected.
struct PredictedMode {
  double probability = 0.0;  ///< among the modes that were asked for: they sum to 1 per object, joint ones over all
  Maneuver maneuver = Maneuver::none;
  LaneId lane = none<LaneId>;  ///< in which it is at the end; none off the lanes

  friend bool operator==(PredictedMode const&, PredictedMode const&) = default;
};

/// A trajectory by which the host predicts an object itself, for instance learned, or of its own vehicle as planned.
/// Where it ends, or a position is not finite, the model that the tracker has for the object goes on. Several of one
/// object are its modes.
struct GivenTrajectory {
  ObjectKey key{};
  /// After one step, two steps, ... of the prediction; where the heading or the speed is not finite, those that the
  /// positions have. A vehicle that moves against its heading reverses.
  std::span<PredictedState const> states;
  double probability = 1.0;
};

/// What to predict.
struct PredictionRequest {
  std::size_t steps = 30;
  double step = 0.1;      ///< [s], at least 0.001
  std::size_t modes = 1;  ///< per object; of the world, if `joint`
  /// Marginal: mode m of each object is its m-th most probable one, and their probabilities are its own. The objects'
  /// modes of one number happen together: mode 1 is what each does if all others do their second best, too.
  /// Joint: mode m is the m-th most probable combination of all objects' modes, taken as independent.
  bool joint = false;
  std::span<ObjectKey const> objects{};  ///< that are asked for; all others do as expected. Empty: all
  std::span<GivenTrajectory const> given{};
};

/// The result of a prediction; the states are in the caller's array `[mode, object, step]`. Valid until the next one,
/// or the next update.
struct PredictedModes {
  std::span<ObjectKey const> objects;
  std::span<PredictedMode const> modes;  ///< [mode, object]
  std::size_t steps = 0;

  /// Mode `mode` of the object at `object` of `objects`.
  [[nodiscard]] PredictedMode const& mode(std::size_t mode, std::size_t object) const {
    return modes[mode * objects.size() + object];
  }
  /// Place of a state in the caller's array; `step` 0 is after one step.
  [[nodiscard]] std::size_t at(std::size_t mode, std::size_t object, std::size_t step) const {
    return (mode * objects.size() + object) * steps + step;
  }
};

/// In words.
[[nodiscard]] constexpr char const* to_string(Maneuver maneuver) {
  constexpr char const* names[] = {"as expected", "changes left", "changes right", "keeps its lane", "goes first",
                                   "brakes on",   "starts",       "given",         "no such mode"};
  return names[static_cast<std::uint8_t>(maneuver)];
}

}  // namespace cambium::inline v0_1
