#include "cambium/behavior/pedestrian/social_force.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "cambium/cambium.hpp"

#include "../support/dual.hpp"

namespace cb = cambium;
using Vector = cb::PlaneVector<double>;

namespace {

/// V0 exp(-b / sigma), directly from eqs. 3 and 4 of the paper.
double potential(cb::SocialForceParameters const& p, double x, double y, Vector const& stride) {
  double const sum = std::hypot(x, y) + std::hypot(x - stride.x, y - stride.y);
  double const b = std::sqrt(sum * sum - stride.x * stride.x - stride.y * stride.y) / 2;
  return p.repulsion * std::exp(-b / p.repulsion_range);
}

}  // namespace

TEST_CASE("the repulsion is the negative gradient of the elliptical potential") {
  cb::SocialForceParameters const p;
  cb::RandomStream random(3, 0, 0);
  cb::Uniform const place{-3.0, 3.0};
  for (int i = 0; i < 1000; ++i) {
    Vector const apart{place(random), place(random)}, stride{place(random), place(random)};
    if (apart.norm() < 0.1 || (apart - stride).norm() < 0.1) continue;
    auto const force = cb::social_repulsion(p, apart, stride);
    double const h = 1e-6;
    double const gx =
        (potential(p, apart.x + h, apart.y, stride) - potential(p, apart.x - h, apart.y, stride)) / (2 * h);
    double const gy =
        (potential(p, apart.x, apart.y + h, stride) - potential(p, apart.x, apart.y - h, stride)) / (2 * h);
    CHECK(force.x == doctest::Approx(-gx).epsilon(1e-4));
    CHECK(force.y == doctest::Approx(-gy).epsilon(1e-4));
  }
}

TEST_CASE("a standing pedestrian repels by exp(-r / sigma); the repulsion is 0 at the foci, not infinite") {
  cb::SocialForceParameters const p;
  auto const force = cb::social_repulsion(p, Vector{0.3, 0.4}, Vector{});
  CHECK(force.norm() == doctest::Approx(7.0 * std::exp(-0.5 / 0.3)));
  CHECK(force.y / force.x == doctest::Approx(4.0 / 3));
  for (auto const& apart : {Vector{}, Vector{1.0, 0.0}, Vector{2.0, 0.0}}) {
    auto const at = cb::social_repulsion(p, apart, Vector{2.0, 0.0});
    CHECK(at.x == 0.0);
    CHECK(at.y == 0.0);
  }
}

TEST_CASE("the repulsion of borders and bodies decreases with distance and is bounded at contact") {
  cb::SocialForceParameters const p;
  CHECK(cb::border_repulsion(p, 0.0) == doctest::Approx(50.0));
  CHECK(cb::border_repulsion(p, 0.2) == doctest::Approx(50.0 / std::exp(1.0)));
  CHECK(cb::border_repulsion(p, -3.0) == cb::border_repulsion(p, 0.0));
  CHECK(cb::contact_repulsion(p, 0.08) == doctest::Approx(25.0 / std::exp(1.0)));
  CHECK(cb::contact_repulsion(p, -1.0) == doctest::Approx(25.0));
}

TEST_CASE("forces from behind count half: the field of view is 200 degrees wide") {
  cb::SocialForceParameters const p;
  Vector const ahead{2.0, 0.0};
  for (int degrees = -180; degrees <= 180; degrees += 5) {
    double const angle = degrees * cb::geometry::pi / 180;
    Vector const force{-std::cos(angle), -std::sin(angle)};  // from a source in that direction
    if (std::abs(degrees) == 100) continue;
    CHECK(cb::sight_weight(p, std::cos(0.5 * p.sight_angle), ahead, force) == (std::abs(degrees) < 100 ? 1.0 : 0.5));
  }
}

TEST_CASE("the speed approaches the desired one with tau, for any step") {
  cb::SocialForceParameters const p;
  for (double const h : {0.01, 0.1, 0.5}) {
    Vector v{0.2, -0.1};
    int const steps = static_cast<int>(std::lround(1.0 / h));
    for (int i = 0; i < steps; ++i) v = cb::social_velocity(p, v, {1.3, 0.0}, {}, h);
    CHECK(v.x == doctest::Approx(1.3 + (0.2 - 1.3) * std::exp(-2.0)));
    CHECK(v.y == doctest::Approx(-0.1 * std::exp(-2.0)));
  }
  // Equals Euler's rule with small steps when a force is added.
  Vector fine{0.5, 0.5}, coarse = fine;
  for (int i = 0; i < 100000; ++i) {
    fine.x += 1e-5 * ((1.0 - fine.x) / p.relaxation_time + 0.7);
    fine.y += 1e-5 * ((0.0 - fine.y) / p.relaxation_time - 0.3);
  }
  for (int i = 0; i < 4; ++i) coarse = cb::social_velocity(p, coarse, {1.0, 0.0}, {0.7, -0.3}, 0.25);
  CHECK(coarse.x == doctest::Approx(fine.x).epsilon(1e-4));
  CHECK(coarse.y == doctest::Approx(fine.y).epsilon(1e-4));
  CHECK(cb::social_velocity(p, {0.0, 0.0}, {1.34, 0.0}, {100.0, 0.0}, 10.0).norm() == doctest::Approx(1.3 * 1.34));
}

TEST_CASE("with dual numbers the repulsion yields its derivative by the place") {
  using support::Dual;
  cb::SocialForceParameters const p;
  cb::PlaneVector<Dual> const apart{Dual(0.7, 1.0), Dual(0.4)}, stride{Dual(1.0), Dual(0.2)};
  auto const force = cb::social_repulsion(p, apart, stride);
  auto const at = [&](double x) { return cb::social_repulsion(p, Vector{x, 0.4}, Vector{1.0, 0.2}); };
  CHECK(force.x.d == doctest::Approx((at(0.7 + 1e-6).x - at(0.7 - 1e-6).x) / 2e-6).epsilon(1e-6));
  CHECK(force.y.d == doctest::Approx((at(0.7 + 1e-6).y - at(0.7 - 1e-6).y) / 2e-6).epsilon(1e-6));
}
