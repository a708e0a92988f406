// Stops and bends for drivers whose acceleration changes no faster than a bound on the jerk.
#include "cambium/behavior/law/slowing.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "cambium/behavior/driver/limits.hpp"
#include "cambium/behavior/law/braking.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"

using namespace cambium;

namespace {

double between(double low, double high, RandomStream& random) { return low + (high - low) * uniform01(random); }

/// The distance in small steps: brakes harder as long as the end still leads to `target`.
double integrated(double speed, double a, double target, double deceleration, double jerk) {
  constexpr double h = 1e-4;
  double distance = 0.0;
  double const floor = std::min(a, -deceleration);
  bool ends = false;
  for (int i = 0; i < 1'000'000 && (speed > target || a > 0.0); ++i) {
    ends = ends || (a < 0.0 && speed - target <= a * a / (2.0 * jerk));
    double const next = ends ? std::min(0.0, a + jerk * h) : std::max(floor, a - jerk * h);
    distance += h * (speed + 0.25 * h * (a + next));
    speed += 0.5 * h * (a + next);
    a = next;
    if (ends && a >= 0.0) break;
  }
  return distance;
}

/// One that drives `left` [m] before a stop (`target` 0) or a bend, in closed loop.
struct Approach {
  double speed, left, target, deceleration, hardest, dt;
  double jerk = 2.5;
  double acceleration = 0.0;

  double highest_jerk = 0.0, most_braking = 0.0, slow_time = 0.0;

  /// Drives one step; at most at `cruise` [m/s].
  void step(double cruise) {
    Idm const law{.comfortable_deceleration = deceleration, .lowest_acceleration = -hardest};
    Limits<Idm> limits(law, speed, 20.0);
    limits.jerk_bound = {jerk, acceleration};
    if (target == 0.0)
      limits.stop_within(left, deceleration, dt);
    else
      limits.bound(motion_before_bend(speed, left, target, deceleration, hardest, dt, limits.jerk_bound));
    double const end = std::clamp(cruise, speed - dt, speed + dt);
    auto const motion = limits.within({0.5 * (speed + end) * dt, end}, dt);
    double const a = (motion.speed - speed) / dt;
    highest_jerk = std::max(highest_jerk, std::abs(a - acceleration) / dt);
    most_braking = std::max(most_braking, -a);
    if (motion.speed > 0.0 && motion.speed < 0.5) slow_time += dt;
    acceleration = a;
    speed = motion.speed;
    left -= motion.distance;
  }
};

}  // namespace

TEST_CASE(
    "the distance to slow down is that of ramps and even braking, and its derivatives are those of the distance") {
  RandomStream random(1, 0, 0);
  for (int run = 0; run < 300; ++run) {
    double const speed = between(0.1, 20.0, random), target = run % 2 ? 0.0 : between(0.0, 12.0, random);
    double const a = between(-4.0, 2.0, random), b = between(1.0, 3.0, random), jerk = between(1.0, 4.0, random);
    CAPTURE(speed);
    CAPTURE(target);
    CAPTURE(a);
    CAPTURE(b);
    CAPTURE(jerk);
    auto const at = [&](double v, double acceleration) { return slowing_distance(v, acceleration, target, b, jerk); };
    auto const found = at(speed, a);
    bool const ends_too_soon = a < 0.0 && 2.0 * jerk * (speed - target) < a * a;
    bool const is_fast = speed > target || speed + a * std::abs(a) / (2.0 * jerk) > target;
    if (!is_fast) CHECK(found.distance == 0.0);
    if (is_fast && !ends_too_soon)
      CHECK(found.distance == doctest::Approx(integrated(speed, a, target, b, jerk)).epsilon(2e-2));
    constexpr double h = 1e-5;
    if (std::abs(speed - target) < 0.01 || std::abs(a + b) < 0.01) continue;
    CHECK(found.by_speed ==
          doctest::Approx((at(speed + h, a).distance - at(speed - h, a).distance) / (2 * h)).epsilon(1e-3));
    CHECK(found.by_acceleration ==
          doctest::Approx((at(speed, a + h).distance - at(speed, a - h).distance) / (2 * h)).epsilon(1e-3));
  }
}

TEST_CASE("a stop that is seen in time is smooth, exact and not slow, for any step, speed and comfort") {
  RandomStream random(2, 0, 0);
  for (double const dt : {0.05, 0.1, 0.2, 0.4})
    for (int run = 0; run < 100; ++run) {
      double const speed = between(1.0, 25.0, random), b = between(1.0, 3.0, random);
      Approach at{speed, 0.0, 0.0, b, 8.0, dt};
      at.left = stopping_distance(speed, 0.0, b, {at.jerk}) + between(0.0, 60.0, random) + speed * dt;
      CAPTURE(dt);
      CAPTURE(speed);
      CAPTURE(b);
      for (int k = 0; k < 5000 && at.speed > 0.0; ++k) at.step(speed);
      CHECK(at.speed == 0.0);
      CHECK(std::abs(at.left) < 0.005);
      CHECK(at.highest_jerk < 1.3 * at.jerk);  // the last step ends anywhere in it
      CHECK(at.most_braking < b + 0.05);
      CHECK(at.slow_time < 1.2);
    }
}

TEST_CASE("a stop that is seen late is made, if the brakes suffice") {
  RandomStream random(3, 0, 0);
  for (double const dt : {0.05, 0.1, 0.2, 0.4})
    for (int run = 0; run < 200; ++run) {
      double const speed = between(1.0, 25.0, random), needed = between(1.5, 7.0, random);
      Approach at{speed, speed * speed / (2.0 * needed), 0.0, 2.0, 8.0, dt};
      at.acceleration = between(-2.0, 1.0, random);
      CAPTURE(dt);
      CAPTURE(speed);
      CAPTURE(needed);
      for (int k = 0; k < 500 && at.speed > 0.0; ++k) at.step(speed);
      CHECK(at.speed == 0.0);
      CHECK(at.left > -0.05);
    }
}

TEST_CASE("a bend that is seen in time is entered at its speed, smoothly, and driven through at that") {
  RandomStream random(4, 0, 0);
  for (double const dt : {0.05, 0.1, 0.2, 0.4})
    for (int run = 0; run < 100; ++run) {
      double const speed = between(6.0, 25.0, random), b = between(1.0, 3.0, random);
      Approach at{speed, 0.0, between(2.0, speed, random), b, 8.0, dt};
      double const way = slowing_distance(speed, 0.0, at.target, b, 0.8 * at.jerk).distance;
      at.left = way + between(0.0, 60.0, random) + speed * dt;
      CAPTURE(dt);
      CAPTURE(speed);
      CAPTURE(at.target);
      while (at.left > 0.0) at.step(speed);
      CHECK(at.speed < at.target + 0.1);
      CHECK(at.speed > at.target - 0.8);
      CHECK(at.most_braking < b + 0.05);
      for (int k = 0; k < 100; ++k) at.step(speed);
      CHECK(at.speed == doctest::Approx(at.target).epsilon(1e-3));
      CHECK(at.highest_jerk < 1.1 * at.jerk);
    }
}

TEST_CASE("one who sees a bend late brakes no harder than it takes, and not below the bend's speed") {
  RandomStream random(5, 0, 0);
  for (double const jerk : {2.5, 1e6})
    for (int run = 0; run < 200; ++run) {
      double const speed = between(8.0, 20.0, random), target = between(3.0, 0.8 * speed, random), dt = 0.1;
      double const needed = between(2.0, 5.0, random);
      double const left = (speed * speed - target * target) / (2.0 * needed);
      auto const motion = motion_before_bend(speed, left, target, 2.0, 8.0, dt, {jerk});
      double const softly = jerk < 1e3 ? std::sqrt(1.6 * jerk * (speed - target)) - 0.4 * jerk * dt : needed;
      CHECK((speed - motion.speed) / dt == doctest::Approx(std::min(needed, softly)).epsilon(1e-3));
      CHECK(motion_before_bend(target + 0.01, 0.5, target, 2.0, 8.0, dt, {jerk}).speed >= target);
    }
}
