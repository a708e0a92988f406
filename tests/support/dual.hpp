#pragma once

#include <cmath>
#include <compare>

namespace support {

/// A number with its derivative: forward-mode automatic differentiation.
struct Dual {
  double v = 0.0, d = 0.0;

  Dual() = default;
  Dual(double value, double derivative = 0.0) : v(value), d(derivative) {}

  Dual& operator+=(Dual const& o) { return *this = {v + o.v, d + o.d}; }
  Dual& operator-=(Dual const& o) { return *this = {v - o.v, d - o.d}; }
  friend Dual operator+(Dual const& a, Dual const& b) { return {a.v + b.v, a.d + b.d}; }
  friend Dual operator-(Dual const& a, Dual const& b) { return {a.v - b.v, a.d - b.d}; }
  friend Dual operator-(Dual const& a) { return {-a.v, -a.d}; }
  friend Dual operator*(Dual const& a, Dual const& b) { return {a.v * b.v, a.d * b.v + a.v * b.d}; }
  friend Dual operator/(Dual const& a, Dual const& b) {
    return {a.v / b.v, std::isinf(b.v) ? 0.0 : (a.d - a.v / b.v * b.d) / b.v};
  }
  friend auto operator<=>(Dual const& a, Dual const& b) { return a.v <=> b.v; }
  friend bool operator==(Dual const& a, Dual const& b) { return a.v == b.v; }
  friend Dual pow(Dual const& x, Dual const& p) { return {std::pow(x.v, p.v), p.v * std::pow(x.v, p.v - 1) * x.d}; }
  friend Dual cos(Dual const& x) { return {std::cos(x.v), -std::sin(x.v) * x.d}; }
  friend Dual sin(Dual const& x) { return {std::sin(x.v), std::cos(x.v) * x.d}; }
  friend Dual tan(Dual const& x) { return {std::tan(x.v), x.d / (std::cos(x.v) * std::cos(x.v))}; }
  friend Dual sqrt(Dual const& x) { return {std::sqrt(x.v), x.d / (2 * std::sqrt(x.v))}; }
  friend Dual exp(Dual const& x) { return {std::exp(x.v), std::exp(x.v) * x.d}; }
  friend Dual abs(Dual const& x) { return x.v < 0 ? -x : x; }
};

}  // namespace support
