#include "cambium/behavior/wrap/rss.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "cambium/cambium.hpp"

namespace cb = cambium;

namespace {

/// Moves in one dimension with constant acceleration, then brakes, in tiny steps.
struct Mover {
  double position = 0.0, speed = 0.0;

  void step(double acceleration, double h) {
    position += speed * h + 0.5 * acceleration * h * h;
    speed += acceleration * h;
  }
  void brake(double deceleration, double h) {
    double const sign = speed < 0.0 ? -1.0 : 1.0, left = std::abs(speed) / deceleration;
    step(-sign * deceleration, std::min(h, left));
    if (left < h) speed = 0.0;
  }
};

constexpr double h = 1e-3;

/// Smallest gap if the rear vehicle responds after the response time and the front one brakes at once.
double smallest_gap(cb::RssParameters const& p, double rear_speed, double front_speed, double gap) {
  Mover rear{0.0, rear_speed}, front{gap, front_speed};
  double smallest = gap;
  for (double t = 0; t < 60 && (rear.speed > 0 || t < p.response_time); t += h) {
    if (t < p.response_time - 0.5 * h)
      rear.step(p.maximum_acceleration, h);
    else
      rear.brake(p.minimum_deceleration, h);
    front.brake(p.maximum_deceleration, h);
    smallest = std::min(smallest, front.position - rear.position);
  }
  return smallest;
}

}  // namespace

TEST_CASE("safe distances equal the published formulas") {
  // 20 m/s behind 10 m/s: 20 + 1.75 + 23.5^2 / 8 - 100 / 16.
  CHECK(cb::rss_same_direction(cb::RssParameters{}, 20.0, 10.0) == doctest::Approx(84.53125));
  CHECK(cb::rss_same_direction(cb::RssParameters{}, 0.0, 30.0) == 0.0);
  // 10 m/s against 5 m/s: 11.75 + 13.5^2 / 6 + 6.75 + 8.5^2 / 8.
  CHECK(cb::rss_opposite_direction(cb::RssParameters{}, 10.0, 5.0) == doctest::Approx(57.90625));
  // 0.5 m/s towards a standing vehicle: 0.1 + 0.6 + 0.7^2 / 1.6 + 0.1 + 0.2^2 / 1.6.
  CHECK(cb::rss_lateral(cb::RssParameters{}, -0.5, 0.0) == doctest::Approx(1.13125));
  CHECK(cb::rss_lateral(cb::RssParameters{}, 0.0, 0.5) == doctest::Approx(1.13125));
  CHECK(cb::rss_lateral(cb::RssParameters{}, 3.0, 0.0) == 0.1);  // away
  CHECK(cb::rss_same_direction(cb::RssParameters{}, 20.0f, 10.0f) == doctest::Approx(84.53125f));
}

TEST_CASE("from the safe distance the worst case just avoids a collision; from a shorter one it does not") {
  cb::RandomStream random(1, 0, 0);
  auto const between = [&](double a, double b) { return cb::Uniform{a, b}(random); };
  int exact = 0;
  for (int i = 0; i < 300; ++i) {
    cb::RssParameters const p{.response_time = h * std::round(between(0.1, 1.5) / h),
                              .maximum_acceleration = between(0.5, 4),
                              .maximum_deceleration = between(6, 9),
                              .minimum_deceleration = between(2, 5)};
    double const rear = between(0, 40), front = between(0, 40);
    double const safe = cb::rss_same_direction(p, rear, front);
    double const left = smallest_gap(p, rear, front, safe);
    CHECK(left > -0.05);
    if (safe > 0.0) {
      CHECK(left < 0.05);
      CHECK(smallest_gap(p, rear, front, safe - 0.1) < 0.0);
      ++exact;
    }
  }
  CHECK(exact > 150);
}

TEST_CASE("the lateral distance is what two vehicles need that approach each other until they respond") {
  cb::RandomStream random(2, 0, 0);
  auto const between = [&](double a, double b) { return cb::Uniform{a, b}(random); };
  for (int i = 0; i < 200; ++i) {
    cb::RssParameters const p{.response_time = h * std::round(between(0.1, 1.5) / h),
                              .lateral_acceleration = between(0.1, 1),
                              .lateral_deceleration = between(0.5, 2)};
    Mover left{0.0, between(-2, 2)}, right{0.0, between(-2, 2)};
    double const safe = cb::rss_lateral(p, left.speed, right.speed);
    for (double t = 0; t < 20; t += h)
      if (t < p.response_time - 0.5 * h) {
        left.step(-p.lateral_acceleration, h);
        right.step(p.lateral_acceleration, h);
      } else {
        left.brake(p.lateral_deceleration, h);
        right.brake(p.lateral_deceleration, h);
      }
    double const closer = right.position - left.position;
    CHECK(std::max(0.0, closer) + p.lateral_margin == doctest::Approx(safe).epsilon(0.01));
  }
}

TEST_CASE(
    "the proper response: the rear vehicle brakes, neither comes closer sideways, and vehicles beside each other do "
    "not brake") {
  cb::RssParameters const p;
  cb::RssSituation at{.gap = 20, .speed = 20, .other_speed = 20, .side_gap = -1.0};
  CHECK(cb::rss_response(p, at) == cb::RssResponse{.brake = true});
  at.is_ahead = false;
  CHECK_FALSE(cb::rss_response(p, at).any());
  at.gap = 200;
  at.is_ahead = true;
  CHECK_FALSE(cb::rss_response(p, at).any());
  at.gap = 20;
  at.side_gap = 0.2;
  CHECK(cb::rss_response(p, at) == cb::RssResponse{.brake = true, .keep_off_right = true});
  at.gap = -1;
  at.is_left = true;
  CHECK(cb::rss_response(p, at) == cb::RssResponse{.keep_off_left = true});
  at.side_gap = 1.7;
  CHECK_FALSE(cb::rss_response(p, at).any());
  at.lateral_speed = 1.5;
  CHECK(cb::rss_response(p, at) == cb::RssResponse{.keep_off_left = true});
  at = {.gap = 60, .speed = 10, .other_speed = -10, .side_gap = 0.0};
  CHECK(cb::rss_response(p, at).brake);
  at.gap = 100;
  CHECK_FALSE(cb::rss_response(p, at).any());
  at = {.gap = 5, .speed = 10, .other_speed = -10, .side_gap = 0.2, .is_ahead = false};
  CHECK_FALSE(cb::rss_response(p, at).any());  // it has passed
  // The vehicle in its own lane is expected to brake less hard.
  double const right = cb::rss_opposite_direction(p, 20.0, 10.0), wrong = cb::rss_opposite_direction(p, 10.0, 20.0);
  CHECK(right > wrong + 5.0);
  at = {.gap = 0.5 * (right + wrong), .speed = 20, .other_speed = -10, .side_gap = 0.0};
  CHECK(cb::rss_response(p, at).brake);
  at.in_own_lane = false;
  CHECK_FALSE(cb::rss_response(p, at).any());
}

TEST_CASE("any response differs from none") {
  for (bool const brake : {false, true})
    for (bool const left : {false, true})
      for (bool const right : {false, true}) {
        cb::RssResponse const response{brake, left, right};
        CHECK(response.any() == (response != cb::RssResponse{}));
      }
}

TEST_CASE("contradictory bounds of braking are errors") {
  cambium::RssParameters rss;
  rss.minimum_deceleration = rss.maximum_deceleration + 2.0;
  CHECK_THROWS_WITH_AS(check_parameters(rss, "driver"), doctest::Contains("minimum_deceleration"),
                       cambium::ParameterError);
}
