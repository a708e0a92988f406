#include "cambium/execution/tracking.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "cambium/dynamics/dynamic_set.hpp"
#include "cambium/dynamics/kinematic_point.hpp"
#include "cambium/dynamics/single_track_steering.hpp"
#include "cambium/dynamics/triple_integrator.hpp"
#include "cambium/execution/lqr.hpp"
#include "cambium/execution/stanley.hpp"

namespace cb = cambium;

namespace {

/// A lane change of 3.5 m in 4 s at 15 m/s, from 1 s on, by the quintic of least jerk.
template <class State>
State lane_change(double t) {
  double const u = std::clamp((t - 1.0) / 4.0, 0.0, 1.0), v = 15.0;
  double const y = 3.5 * u * u * u * (10 - 15 * u + 6 * u * u), dy = 3.5 * 30 * u * u * (1 - u) * (1 - u) / 4.0;
  State s{};
  s.time = t;
  s.x = v * t;
  s.y = y;
  s.heading = std::atan2(dy, v);
  s.speed = std::hypot(v, dy);
  return s;
}

/// A bend of 60 m radius at 10 m/s, with its beginning on the x axis.
template <class State>
State bend(double t) {
  State s{};
  double const angle = 10.0 * t / 60.0;
  s.time = t;
  s.x = 60.0 * std::sin(angle);
  s.y = 60.0 * (1 - std::cos(angle));
  s.heading = angle;
  s.speed = 10.0;
  return s;
}

struct Errors {
  double across = 0.0, along = 0.0, last_across = 0.0;
};

/// Follows `course` in steps of `dt`, `samples` states a step, and tells the largest distances from it. A plan reaches
/// `steps_ahead` steps.
template <class Execution, class Dynamics, class Course>
Errors follow(Execution const& execution, Dynamics const& dynamics, Course const& course, double duration,
              double offset = 0.0, double dt = 0.2, int samples = 2, int steps_ahead = 1) {
  using State = typename Dynamics::State;
  State x = course(0.0);
  x.y += offset;
  typename Execution::template Memory<State> memory;
  Errors errors;
  for (int step = 0; step * dt < duration; ++step) {
    cb::BasicPlan<State> plan;
    double const from = step * dt;
    for (int k = step == 0 ? 0 : 1; k <= samples * steps_ahead; ++k)
      plan.trajectory.push_back(course(from + dt * k / samples));
    cb::RandomStream random(3, 1, static_cast<std::uint32_t>(step));
    auto const executed = execution.execute(plan, x, dynamics, from + dt, memory, random);
    REQUIRE(executed.valid);
    x = executed.state;
    REQUIRE(cb::is_finite(x));
    auto const wanted = course(from + dt);
    double const dx = x.x - wanted.x, dy = x.y - wanted.y, c = std::cos(wanted.heading), s = std::sin(wanted.heading);
    errors.last_across = std::abs(dy * c - dx * s);
    errors.across = std::max(errors.across, errors.last_across);
    errors.along = std::max(errors.along, std::abs(dx * c + dy * s));
  }
  return errors;
}

/// A plan of one state.
cb::BasicPlan<cb::State> to(cb::State const& state) {
  cb::BasicPlan<cb::State> plan;
  plan.trajectory.push_back(state);
  return plan;
}

/// The states after `steps` steps of 0.1 s of holding 10 m/s straight on.
template <class Execution>
std::vector<cb::State> straight_on(Execution const& execution, int steps, std::uint64_t seed = 3) {
  cb::State x{.speed = 10.0};
  typename Execution::template Memory<cb::State> memory;
  std::vector<cb::State> states;
  for (int i = 0; i < steps; ++i) {
    auto const plan = to({.time = 0.1 * (i + 1), .x = 1.0 * (i + 1), .speed = 10.0});
    cb::RandomStream random(seed, 1, static_cast<std::uint32_t>(i));
    x = execution.execute(plan, x, cb::SingleTrack{}, 0.1 * (i + 1), memory, random).state;
    states.push_back(x);
  }
  return states;
}

}  // namespace

TEST_CASE_TEMPLATE("a lane change is tracked to a few centimetres", Execution, cb::StanleyExecution, cb::LqrExecution) {
  auto const errors = follow(Execution{}, cb::SingleTrack{}, lane_change<cb::State>, 8.0);
  MESSAGE(std::string(Execution::name) << ": across " << errors.across << " m, along " << errors.along << " m");
  CHECK(errors.across < 0.05);
  CHECK(errors.along < 0.05);
  CHECK(errors.last_across < 0.01);
  // However coarse the plan.
  CHECK(follow(Execution{}, cb::SingleTrack{}, lane_change<cb::State>, 8.0, 0.0, 0.2, 1).across < 0.06);
  CHECK(follow(Execution{}, cb::SingleTrack{}, lane_change<cb::State>, 8.0, 0.0, 0.5, 10).across < 0.06);
  // However far it reaches.
  auto const far = follow(Execution{}, cb::SingleTrack{}, lane_change<cb::State>, 8.0, 0.0, 0.2, 2, 4);
  CHECK(far.across == doctest::Approx(errors.across).epsilon(0.1));
  CHECK(far.along == doctest::Approx(errors.along).epsilon(0.1));
}

TEST_CASE_TEMPLATE("in a bend there is no lasting error, and a start beside the plan comes to it", Execution,
                   cb::StanleyExecution, cb::LqrExecution) {
  auto const errors = follow(Execution{}, cb::SingleTrack{}, bend<cb::State>, 12.0);
  MESSAGE(std::string(Execution::name) << ": across " << errors.across << " m, along " << errors.along << " m");
  CHECK(errors.across < 0.03);
  auto const beside = follow(Execution{}, cb::SingleTrack{}, bend<cb::State>, 12.0, 0.8);
  CHECK(beside.across <= 0.8);
  CHECK(beside.last_across < 0.03);
}

TEST_CASE_TEMPLATE("every vehicle model is tracked with", Model, cb::SingleTrack, cb::SingleTrackSteering,
                   cb::TripleIntegrator, cb::KinematicPoint, cb::DynamicSet<cb::SingleTrack, cb::KinematicPoint>) {
  Model model{};
  if constexpr (std::is_same_v<Model, cb::KinematicPoint>) model.highest_speed = 50;
  using State = typename Model::State;
  for (auto const& errors : {follow(cb::StanleyExecution{}, model, lane_change<State>, 9.0),
                             follow(cb::LqrExecution{}, model, lane_change<State>, 9.0)}) {
    CHECK(errors.across < 0.4);
    CHECK(errors.last_across < 0.05);
  }
}

TEST_CASE("the reference moves between states of a plan that are half a millisecond apart") {
  cb::State const start{.time = 1.0, .speed = 10.0};
  cb::BasicPlan<cb::State> plan;
  for (int i = 1; i <= 4; ++i) plan.trajectory.push_back({.time = 1.0 + 5e-4 * i, .x = 5e-3 * i, .speed = 10.0 + i});
  auto const at = cb::detail::reference_at(plan, start, 1.00125);
  CHECK(at.x == doctest::Approx(0.0125));
  CHECK(at.speed == doctest::Approx(12.5));
  CHECK(at.acceleration == doctest::Approx(2000.0));
}

TEST_CASE("nothing is tracked beyond the plan's end, and nothing without a plan") {
  cb::TrackingMemory<cb::State> memory;
  cb::RandomStream random(1, 1, 1);
  auto const is_tracked = [&](cb::BasicPlan<cb::State> const& plan, double time) {
    return cb::StanleyExecution{}.execute(plan, cb::State{}, cb::SingleTrack{}, time, memory, random).valid;
  };
  auto const plan = to({.time = 0.1, .x = 1.0, .speed = 10.0});
  CHECK_FALSE(is_tracked({}, 0.2));
  CHECK_FALSE(is_tracked(plan, 0.2));
  CHECK(is_tracked(plan, 0.1));
}

TEST_CASE("without delay the controller acts in equal parts of a step, none longer than the period") {
  std::vector<double> intervals;
  auto const law = [&](cb::Reference const&, cb::TrackingError const&, cb::State const&, double interval) {
    intervals.push_back(interval);
    return cb::Action{};
  };
  for (double const begin : {0.0, 7.0}) {
    intervals.clear();
    cb::TrackingMemory<cb::State> memory;
    cb::RandomStream random(1, 1, 1);
    cb::State const now{.time = begin, .speed = 10.0};
    auto const plan = to({.time = begin + 0.25, .x = 2.5, .speed = 10.0});
    (void)cb::track({.period = 0.1}, law, plan, now, cb::SingleTrack{}, begin + 0.25, memory, random);
    REQUIRE(intervals.size() == 3);
    for (double const interval : intervals) CHECK(interval == doctest::Approx(0.25 / 3.0));
  }
  // A delay is four commands long, if it is not so short that it has no effect.
  CHECK(cb::Actuation{.delay = 0.0039}.slot() == 0.0);
  CHECK(cb::Actuation{.delay = 0.0041}.slot() == doctest::Approx(0.0041 / 4.0));
}

TEST_CASE("commands come into effect after the delay, to the period in which they are given") {
  for (double const delay : {0.0, 0.1, 0.2, 0.4, 0.6}) {
    cb::StanleyExecution execution;
    execution.lag_gain = 0.0;
    execution.actuation = {.period = std::max(0.02, 0.25 * delay), .delay = delay};
    // Told to brake from the first moment on: the speed falls as soon as that comes into effect.
    cb::State x{.speed = 10.0};
    cb::TrackingMemory<cb::State> memory;
    double first = -1.0;
    for (int i = 0; i < 100 && first < 0.0; ++i) {
      double const t = 0.02 * (i + 1);
      auto const plan = to({.time = t, .x = 10.0 * t - t * t, .speed = 10.0 - 2.0 * t});
      cb::RandomStream random(1, 1, 1);
      x = execution.execute(plan, x, cb::SingleTrack{}, t, memory, random).state;
      if (x.speed < 10.0 - 1e-6) first = t - 0.02;
    }
    CAPTURE(delay);
    CHECK(std::abs(first - delay) < 0.021);
  }
}

TEST_CASE_TEMPLATE("a delay widens the error of a lane change, but it stays bounded", Execution, cb::StanleyExecution,
                   cb::LqrExecution) {
  Execution late;
  late.actuation.delay = 0.2;
  auto const at_once = follow(Execution{}, cb::SingleTrack{}, lane_change<cb::State>, 10.0);
  auto const delayed = follow(late, cb::SingleTrack{}, lane_change<cb::State>, 10.0);
  MESSAGE(std::string(Execution::name) << ": across " << at_once.across << " m at once, " << delayed.across
                                       << " m delayed by 0.2 s");
  CHECK(delayed.across > 1.2 * at_once.across);
  CHECK(delayed.across < 0.5);
}

TEST_CASE("the noise of the actuators has the moments asked for") {
  cb::StanleyExecution execution;
  execution.cross_track_gain = execution.speed_gain = execution.lag_gain = 0.0;
  execution.actuation = {.period = 0.1, .acceleration_noise = {0.1, 0.5}, .steering_noise = {0.005, 0.02}};
  int const steps = 20000;
  cb::TrackingMemory<cb::State> memory;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  for (int i = 0; i < steps; ++i) {
    auto const plan = to({.time = 0.1, .x = 1.0, .speed = 10.0});
    memory = {};
    cb::RandomStream random(3, 1, static_cast<std::uint32_t>(i));
    auto const x = execution.execute(plan, cb::State{.speed = 10.0}, cb::SingleTrack{}, 0.1, memory, random).state;
    double const way = 0.1 * 0.5 * (10.0 + x.speed);
    Eigen::Vector2d const noise((x.speed - 10.0) / 0.1, std::atan(x.heading * cb::SingleTrack{}.wheel_base / way));
    sum += noise;
    squares += noise * noise.transpose();
  }
  Eigen::Vector2d const mean = sum / steps, asked_mean(0.1, 0.005), asked(0.5, 0.02);
  Eigen::Matrix2d const covariance = squares / steps - mean * mean.transpose();
  for (int i = 0; i < 2; ++i) {
    CAPTURE(i);
    CHECK(std::abs(mean[i] - asked_mean[i]) < 4 * asked[i] / std::sqrt(steps));
    CHECK(std::abs(std::sqrt(covariance(i, i)) - asked[i]) < 4 * asked[i] / std::sqrt(2.0 * steps));
  }
  CHECK(std::abs(covariance(0, 1)) < 4 * asked[0] * asked[1] / std::sqrt(steps));  // the two are independent
}

TEST_CASE_TEMPLATE("noise is the same for the same seed, another one for another, and the controller bounds it",
                   Execution, cb::StanleyExecution, cb::LqrExecution) {
  Execution noisy;
  noisy.actuation.acceleration_noise = {0.0, 0.3};
  noisy.actuation.steering_noise = {0.0, 0.01};
  CHECK(straight_on(noisy, 50) == straight_on(noisy, 50));
  CHECK(straight_on(noisy, 50) != straight_on(noisy, 50, 4));
  double worst = 0.0;
  for (auto const& s : straight_on(noisy, 2000)) worst = std::max(worst, std::abs(s.y));
  MESSAGE(std::string(Execution::name) << ": largest offset in 200 s " << worst << " m");
  CHECK(worst > 0.001);
  CHECK(worst < 0.5);
  for (auto const& s : straight_on(Execution{}, 200)) CHECK(std::abs(s.y) < 1e-12);
}

TEST_CASE(
    "the regulator's gains are those for the interval that it acts at, whatever the step, the period and the delay") {
  cb::LqrExecution lqr;
  cb::SingleTrack const car;
  cb::State const start{.y = 0.4, .heading = 0.02, .speed = 10.0};
  for (double const delay : {0.0, 0.1})
    for (double const step : {0.02, 0.05, 0.06, 0.2}) {
      lqr.actuation = {.period = 0.05, .delay = delay};
      double const interval = delay > 0.0 ? 0.25 * delay : step / std::ceil(step / 0.05 - 1e-9);
      CHECK(lqr.actuation.interval(step) == doctest::Approx(interval));
      auto plan = to({.speed = 10.0});
      plan.trajectory.push_back({.time = step, .x = 10.0 * step, .speed = 10.0});
      cb::TrackingMemory<cb::State> memory;
      cb::RandomStream random(1, 1, 1);
      auto const end = lqr.execute(plan, start, car, step, memory, random).state;
      auto const gain = lqr.lateral_gain(10.0, car.wheel_base, interval);
      if (delay > 0.0) {
        auto const first =
            cb::TrackingMemory<cb::State>::slots - static_cast<std::size_t>(std::ceil(step / interval - 1e-9));
        if (step > delay) continue;
        CHECK(static_cast<double>(memory.steering[first]) ==
              doctest::Approx(-gain.first * 0.4 - gain.second * 0.02).epsilon(1e-6));
        continue;
      }
      auto const along = lqr.longitudinal_gain(interval);
      auto twin = start;
      for (double t = 0.0; t < step - 1e-9; t += interval) {
        double const lag = twin.x - 10.0 * t, faster = twin.speed - 10.0;
        twin = cb::drive(
            car, twin, {-along.first * lag - along.second * faster, -gain.first * twin.y - gain.second * twin.heading},
            interval);
      }
      CHECK(end.y == doctest::Approx(twin.y).epsilon(1e-9));
      CHECK(end.heading == doctest::Approx(twin.heading).epsilon(1e-9));
    }
}

TEST_CASE("a delay of more than four periods is an error that says which period it takes") {
  CHECK_NOTHROW(cb::check_parameters(cb::LqrExecution{.actuation = {.period = 0.05, .delay = 0.2}}));
  CHECK_THROWS_WITH_AS(cb::check_parameters(cb::LqrExecution{.actuation = {.period = 0.05, .delay = 0.4}}),
                       "lqr.actuation.delay: is longer than 4 periods, but at most 4 commands can wait; give a period "
                       "of at least 0.1 s",
                       cb::ParameterError);
}
