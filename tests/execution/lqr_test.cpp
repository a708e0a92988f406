#include "cambium/execution/lqr.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include <Eigen/Dense>

namespace cb = cambium;

namespace {

using Gain = Eigen::Matrix<double, 1, 2>;

/// The gain by plain iteration of the Riccati equation: a twin.
Gain iterated(Eigen::Matrix2d const& A, Eigen::Vector2d const& B, Eigen::Matrix2d const& Q, double R) {
  Eigen::Matrix2d P = Q;
  Gain K;
  for (int i = 0; i < 200000; ++i) {
    K = (B.transpose() * P * A) / (R + B.dot(P * B));
    Eigen::Matrix2d const next = Q + A.transpose() * P * (A - B * K);
    if ((next - P).cwiseAbs().maxCoeff() < 1e-14 * P.cwiseAbs().maxCoeff()) break;
    P = next;
  }
  return K;
}

}  // namespace

TEST_CASE("the doubling algorithm finds the gain that plain iteration finds") {
  for (double const speed : {1.0, 5.0, 15.0, 40.0})
    for (double const h : {0.01, 0.05, 0.2}) {
      cb::LqrExecution const lqr;
      double const turn = speed * h / 2.7;
      Eigen::Matrix2d A, Q = Eigen::Vector2d(lqr.offset_weight, lqr.heading_weight).asDiagonal();
      A << 1.0, speed * h, 0.0, 1.0;
      auto const twin = iterated(A, Eigen::Vector2d(0.5 * speed * h * turn, turn), Q, lqr.steering_weight);
      auto const gain = lqr.lateral_gain(speed, 2.7, h);
      CHECK(gain.first == doctest::Approx(twin[0]).epsilon(1e-8));
      CHECK(gain.second == doctest::Approx(twin[1]).epsilon(1e-8));
    }
}

TEST_CASE("for short periods the gain is the continuous regulator's closed form, whatever the speed") {
  cb::LqrExecution const lqr{.offset_weight = 2.0, .heading_weight = 0.5, .steering_weight = 3.0};
  double const offset = std::sqrt(2.0 / 3.0), heading = std::sqrt(0.5 / 3.0 + 2.0 * 2.7 * offset);
  for (double const speed : {2.0, 10.0, 30.0}) {
    auto const gain = lqr.lateral_gain(speed, 2.7, 1e-4);
    CHECK(gain.first == doctest::Approx(offset).epsilon(2e-3));
    CHECK(gain.second == doctest::Approx(heading).epsilon(2e-3));
  }
}

TEST_CASE("the closed loop is stable for all speeds and periods") {
  cb::LqrExecution const lqr;
  for (double speed = 0.0; speed < 70.0; speed += 0.7)
    for (double const h : {0.01, 0.05, 0.2, 1.0}) {
      double const v = std::max(1.0, speed), turn = v * h / 2.7;
      Eigen::Matrix2d A;
      A << 1.0, v * h, 0.0, 1.0;
      auto const gain = lqr.lateral_gain(speed, 2.7, h);
      Eigen::Matrix2d const closed = A - Eigen::Vector2d(0.5 * v * h * turn, turn) * Gain(gain.first, gain.second);
      // Both eigenvalues are within the unit circle (Jury's criterion).
      CHECK(std::abs(closed.trace()) < 1.0 + closed.determinant());
      CHECK(closed.determinant() < 1.0);
    }
}
