#include "cambium/planner/frenet/frenet_motion.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/planner/frenet/frenet_candidate.hpp"
#include "cambium/planner/frenet/quintic.hpp"

using namespace cambium;

TEST_CASE_TEMPLATE("quintics and quartics keep their boundary conditions", Scalar, double, float) {
  RandomStream random(1, 0, 0);
  auto const draw = [&](double low, double high) { return static_cast<Scalar>(Uniform{low, high}(random)); };
  double const tolerance = sizeof(Scalar) == 8 ? 1e-9 : 2e-3;
  for (int i = 0; i < 200; ++i) {
    PointMotion<Scalar> const start{draw(-50, 50), draw(-20, 20), draw(-5, 5)},
        end{draw(-50, 50), draw(-20, 20), draw(-5, 5)};
    Scalar const duration = draw(0.5, 6);
    auto const same = [&](Scalar a, Scalar b) {
      return std::abs(double(a) - double(b)) < tolerance * (1.0 + std::abs(double(b)));
    };
    auto const five = quintic(start, end, duration), four = quartic(start, end, duration);
    for (auto const& course : {five, four}) {
      CHECK(course.at(Scalar(0)).position == start.position);
      CHECK(course.at(Scalar(0)).speed == start.speed);
      CHECK(same(course.at(Scalar(0)).acceleration, start.acceleration));
      CHECK(same(course.at(duration).speed, end.speed));
      CHECK(same(course.at(duration).acceleration, end.acceleration));
    }
    CHECK(same(five.at(duration).position, end.position));
    CHECK(four.c[5] == Scalar(0));
  }
}

TEST_CASE("derivatives and the integral of the squared jerk agree with finite differences and sums") {
  auto const course = quintic<double>({1.0, -2.0, 0.7}, {8.0, 3.0, -1.0}, 3.0);
  double const h = 1e-5;
  double sum = 0.0;
  int const parts = 30000;
  for (int i = 0; i < parts; ++i) {
    double const t = 3.0 * (i + 0.5) / parts;
    sum += course.jerk(t) * course.jerk(t) * 3.0 / parts;
    if (i % 1000 != 0) continue;
    CHECK((course.at(t + h).position - course.at(t - h).position) / (2 * h) == doctest::Approx(course.at(t).speed));
    CHECK((course.at(t + h).speed - course.at(t - h).speed) / (2 * h) == doctest::Approx(course.at(t).acceleration));
    CHECK((course.at(t + h).acceleration - course.at(t - h).acceleration) / (2 * h) == doctest::Approx(course.jerk(t)));
  }
  CHECK(course.squared_jerk(3.0) == doctest::Approx(sum));
  // No other course between the same ends has a smaller integral. Vary it by a function that vanishes at both ends,
  // with its first two derivatives.
  for (double const more : {-1e-3, 1e-3}) {
    double other = 0.0;
    for (int i = 0; i < parts; ++i) {
      double const t = 3.0 * (i + 0.5) / parts, u = t - 3.0;  // the third derivative of (t u)^3 is below
      double const bump = 6.0 * u * u * u + 54.0 * t * u * u + 54.0 * t * t * u + 6.0 * t * t * t;
      double const jerk = course.jerk(t) + more * bump;
      other += jerk * jerk * 3.0 / parts;
    }
    CHECK(other > sum);
  }
}

namespace {

struct XY {
  double x, y;
};

/// The point at `s` of a line whose curvature grows linearly, integrated in small steps.
struct Clothoid {
  double curvature, change;
  [[nodiscard]] double heading(double s) const { return s * (curvature + 0.5 * change * s); }
  [[nodiscard]] XY point(double s, double offset) const {
    XY p{0.0, 0.0};
    int const steps = 2000;
    for (int i = 0; i < steps; ++i) {  // Simpson's rule
      double const a = s * i / steps, b = s * (i + 1) / steps, m = 0.5 * (a + b);
      p.x += (b - a) / 6 * (std::cos(heading(a)) + 4 * std::cos(heading(m)) + std::cos(heading(b)));
      p.y += (b - a) / 6 * (std::sin(heading(a)) + 4 * std::sin(heading(m)) + std::sin(heading(b)));
    }
    return {p.x - offset * std::sin(heading(s)), p.y + offset * std::cos(heading(s))};
  }
};

}  // namespace

TEST_CASE("heading, curvature, speed and acceleration of a course beside a line agree with finite differences") {
  for (auto const& line : {Clothoid{0.0, 0.0}, Clothoid{0.03, 0.0}, Clothoid{-0.05, 0.002}}) {
    // s = 10 + 8 t + 0.6 t^2, offset = 0.3 + 0.1 s - 0.004 s^2
    auto const s = [](double t) { return 10.0 + 8.0 * t + 0.6 * t * t; };
    auto const offset = [](double at) { return 0.3 + 0.1 * at - 0.004 * at * at; };
    auto const point = [&](double t) { return line.point(s(t), offset(s(t))); };
    double const t = 0.4, h = 1e-3, at = s(t);
    FrenetMotion<double> const motion{at, 8.0 + 1.2 * t, 1.2, offset(at), 0.1 - 0.008 * at, -0.008};
    LineBend<double> const bend{line.curvature + line.change * at, line.change};
    auto const course = course_motion(motion, bend);
    auto const a = point(t - h), b = point(t), c = point(t + h);
    double const vx = (c.x - a.x) / (2 * h), vy = (c.y - a.y) / (2 * h);
    double const ax = (c.x - 2 * b.x + a.x) / (h * h), ay = (c.y - 2 * b.y + a.y) / (h * h), v = std::hypot(vx, vy);
    CHECK(course.speed == doctest::Approx(v).epsilon(1e-5));
    CHECK(course.heading_error == doctest::Approx(std::atan2(vy, vx) - line.heading(at)).epsilon(1e-5));
    CHECK(course.acceleration == doctest::Approx((vx * ax + vy * ay) / v).epsilon(1e-4));
    CHECK(course.curvature == doctest::Approx((vx * ay - vy * ax) / (v * v * v)).epsilon(1e-4));
    auto const back = frenet_motion(course, at, motion.offset, bend);
    CHECK(back.speed == doctest::Approx(motion.speed).epsilon(1e-12));
    CHECK(back.acceleration == doctest::Approx(motion.acceleration).epsilon(1e-12));
    CHECK(back.slope == doctest::Approx(motion.slope).epsilon(1e-12));
    CHECK(back.bend == doctest::Approx(motion.bend).epsilon(1e-12));
  }
}

TEST_CASE("slope and bend of a candidate are the derivatives of its offset, by way and over time") {
  RandomStream random(5, 0, 0);
  int by_way = 0, checked = 0;
  for (int i = 0; i < 200; ++i) {
    auto const draw = [&](double low, double high) { return Uniform{low, high}(random); };
    double const speed = i % 2 == 0 ? draw(1.0, 3.0) : draw(6.0, 20.0), duration = draw(2.0, 5.0);
    FrenetMotion<double> const start{draw(0, 50), speed,           draw(-0.5, 0.5),
                                     draw(-1, 1), draw(-0.1, 0.1), draw(-0.01, 0.01)};
    auto const course = frenet_candidate(start, {std::numeric_limits<double>::infinity(), speed + draw(0.0, 2.0)},
                                         draw(-2, 2), duration, 15.0, 4.0, FrenetCosts{});
    by_way += course.by_way;
    CHECK(course.at(0.0).offset == doctest::Approx(start.offset));
    CHECK(course.at(0.0).slope == doctest::Approx(start.slope));
    CHECK(course.at(0.0).bend == doctest::Approx(start.bend));
    for (double t = 0.1; t < duration - 0.1; t += 0.3) {
      double const h = 1e-4;
      auto const a = course.at(t - h), b = course.at(t), c = course.at(t + h);
      if (course.by_way && c.s - start.s >= course.way) break;
      CHECK(b.slope == doctest::Approx((c.offset - a.offset) / (c.s - a.s)).epsilon(1e-5).scale(1.0));
      CHECK(b.bend == doctest::Approx((c.slope - a.slope) / (c.s - a.s)).epsilon(1e-5).scale(1.0));
      ++checked;
    }
  }
  CHECK(by_way == 100);
  CHECK(checked > 1000);
}
