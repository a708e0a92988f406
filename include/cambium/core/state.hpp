#pragma once

#include <cmath>
#include <concepts>
#include <type_traits>

#include "cambium/core/described.hpp"
#include "cambium/core/macros.hpp"

namespace cambium::inline v0_1 {

/// Planar motion state of an agent's reference point (vehicles: centre of the rear axle), in the map frame.
template <class Scalar>
struct BasicState {
  Scalar time{};     ///< [s]
  Scalar x{};        ///< [m]
  Scalar y{};        ///< [m]
  Scalar heading{};  ///< counter-clockwise from +x [rad]
  Scalar speed{};    ///< along the heading [m/s]

  static constexpr char const* name = "state";
  static constexpr auto parameters() {
    using S = BasicState;
    return parameter_list(parameter("time", &S::time, "s", any_finite, "of the state"),
                          parameter("x", &S::x, "m", any_finite, "of the reference point, map frame"),
                          parameter("y", &S::y, "m", any_finite, "likewise"),
                          parameter("heading", &S::heading, "rad", any_finite, "counter-clockwise from +x"),
                          parameter("speed", &S::speed, "m/s", any_finite, "along the heading"));
  }

  friend bool operator==(BasicState const&, BasicState const&) = default;
};

/// The state that most vehicle models have.
using State = BasicState<double>;

/// A state that a world can step: trivially copyable, with the named fields of `BasicState` and any fields that the
/// dynamics add.
template <class S>
concept MotionState = std::copyable<S> && std::is_trivially_copyable_v<S> && requires(S s) {
  s.time;
  s.x;
  s.y;
  s.heading;
  s.speed;
};
static_assert(MotionState<State>);

/// The fields of `BasicState` alone.
template <MotionState S>
[[nodiscard]] auto plain_state(S const& s) {
  return BasicState<decltype(s.time + s.speed)>{s.time, s.x, s.y, s.heading, s.speed};
}

/// True if all fields of `BasicState` are finite.
template <MotionState S>
[[nodiscard]] bool is_finite(S const& s) {
  // One sum instead of five tests: it is finite if and only if every term is, because no state is near overflow.
  return std::isfinite(s.time + s.x + s.y + s.heading + s.speed);
}

}  // namespace cambium::inline v0_1
