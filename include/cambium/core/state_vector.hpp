#pragma once

#include <Eigen/Core>

#include "cambium/core/state.hpp"

namespace cambium::inline v0_1 {

/// (time, x, y, heading, speed) as a fixed-size Eigen vector.
template <class Scalar>
[[nodiscard]] Eigen::Matrix<Scalar, 5, 1> to_vector(BasicState<Scalar> const& state) {
  return {state.time, state.x, state.y, state.heading, state.speed};
}

/// Inverse of `to_vector`.
template <class Scalar>
[[nodiscard]] BasicState<Scalar> from_vector(Eigen::Matrix<Scalar, 5, 1> const& v) {
  return {v[0], v[1], v[2], v[3], v[4]};
}

}  // namespace cambium::inline v0_1
