#pragma once

#include <algorithm>
#include <cmath>

namespace cambium::inline v0_1 {

/// A 2 x 2 matrix: all that LQR needs here, and faster to compile than a matrix library.
struct Matrix2 {
  double a{}, b{}, c{}, d{};  ///< first row (a, b), second row (c, d)

  friend constexpr Matrix2 operator+(Matrix2 const& l, Matrix2 const& r) {
    return {l.a + r.a, l.b + r.b, l.c + r.c, l.d + r.d};
  }
  friend constexpr Matrix2 operator*(Matrix2 const& l, Matrix2 const& r) {
    return {l.a * r.a + l.b * r.c, l.a * r.b + l.b * r.d, l.c * r.a + l.d * r.c, l.c * r.b + l.d * r.d};
  }
  [[nodiscard]] constexpr Matrix2 transposed() const { return {a, c, b, d}; }
  /// Precondition: the determinant is not 0.
  [[nodiscard]] constexpr Matrix2 inverse() const {
    double const k = 1.0 / (a * d - b * c);
    return {k * d, -k * b, -k * c, k * a};
  }
  [[nodiscard]] double largest() const { return std::max({std::abs(a), std::abs(b), std::abs(c), std::abs(d)}); }
};

/// Gain (k1, k2) of the feedback u = -(k1 x1 + k2 x2).
struct LqrGain {
  double first{}, second{};
};

/// The gain that minimises the sum of x'Qx + r u^2 over time for x(k+1) = A x + (b1, b2) u, with Q = diag(q1, q2).
/// Solves the discrete algebraic Riccati equation by the structure-preserving doubling algorithm (Chu, Fan, Lin, Wang
/// 2004), which converges quadratically; H converges to the solution. Preconditions: (A, B) stabilisable, q1 and q2 not
/// negative, r positive. No allocation.
[[nodiscard]] inline LqrGain lqr_gain(Matrix2 A, double b1, double b2, double q1, double q2, double r) {
  Matrix2 const start = A;
  Matrix2 G{b1 * b1 / r, b1 * b2 / r, b1 * b2 / r, b2 * b2 / r}, H{q1, 0.0, 0.0, q2};
  for (int i = 0; i < 40; ++i) {
    Matrix2 const W = (Matrix2{1.0, 0.0, 0.0, 1.0} + G * H).inverse(), AW = A * W;
    Matrix2 const more = A.transposed() * H * W * A;
    G = G + AW * G * A.transposed();
    A = AW * A;
    H = H + more;
    if (!(more.largest() > 1e-13 * H.largest())) break;
  }
  double const h1 = b1 * H.a + b2 * H.c, h2 = b1 * H.b + b2 * H.d;  // B'H
  double const k = 1.0 / (r + h1 * b1 + h2 * b2);
  return {k * (h1 * start.a + h2 * start.c), k * (h1 * start.b + h2 * start.d)};
}

}  // namespace cambium::inline v0_1
