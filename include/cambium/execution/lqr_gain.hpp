#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace cambium {

/// Gain K of the input u = -K x that minimises the sum of x'Qx + u'Ru for x(k+1) = A x + B u: the discrete algebraic
/// Riccati equation, solved by the structure-preserving doubling algorithm (Chu, Fan, Lin, Wang 2004), which squares
/// its error in every iteration. A, B stabilisable, Q positive semidefinite, R positive definite. No allocation.
template <int n, int m>
[[nodiscard]] Eigen::Matrix<double, m, n> lqr_gain(Eigen::Matrix<double, n, n> A, Eigen::Matrix<double, n, m> const& B,
                                                   Eigen::Matrix<double, n, n> const& Q,
                                                   Eigen::Matrix<double, m, m> const& R) {
  using Square = Eigen::Matrix<double, n, n>;
  Square const start = A;
  Square G = B * R.inverse() * B.transpose(), H = Q;
  for (int i = 0; i < 40; ++i) {
    Square const W = (Square::Identity() + G * H).inverse(), AW = A * W;
    Square const more = A.transpose() * H * W * A;
    G += AW * G * A.transpose();
    A = AW * A;
    H += more;
    if (!(more.cwiseAbs().maxCoeff() > 1e-13 * H.cwiseAbs().maxCoeff())) break;
  }
  return (R + B.transpose() * H * B).inverse() * B.transpose() * H * start;
}

}  // namespace cambium
