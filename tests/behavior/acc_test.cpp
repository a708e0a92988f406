// Laws of the car-following models, as properties over many samples.
#include "cambium/behavior/law/acc.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

cb::Idm any_driver(cb::RandomStream& random) {
  return {.desired_speed = between(15, 40, random),
          .time_headway = between(0.8, 2.2, random),
          .minimum_gap = between(1, 4, random),
          .maximum_acceleration = between(0.6, 2.5, random),
          .comfortable_deceleration = between(1, 3, random),
          .lowest_acceleration = -8.0};
}

cb::LinearFollowing linear(cb::Idm const& p, double speed) {
  auto const law = [&p](double v, double gap, double leader) { return cb::idm_acceleration(p, v, gap, leader); };
  return cb::linear_following(law, speed, cb::idm_equilibrium_gap(p, speed));
}

/// Ratio of a follower's oscillation to its leader's at the angular frequency `w` [rad/s].
double amplification(cb::LinearFollowing const& f, double w) {
  double const above = f.by_gap * f.by_gap + w * w * f.by_leader_speed * f.by_leader_speed;
  double const real = f.by_gap - w * w, imaginary = w * f.by_speed;
  return std::sqrt(above / (real * real + imaginary * imaginary));
}

/// The same for the last vehicle of a platoon, by simulation.
double simulated_amplification(cb::Idm const& p, double speed, double w, int followers) {
  double const dt = 0.05, period = 6.2831853 / w, amplitude = 0.01;
  auto const n = static_cast<std::size_t>(followers);
  std::vector<double> x(n), v(n, speed);
  for (std::size_t i = 0; i < n; ++i) x[i] = -static_cast<double>(i + 1) * cb::idm_equilibrium_gap(p, speed);
  double leader = 0.0, low = 1e9, high = -1e9;
  double const settled = 60.0 + 8.0 * followers, end = settled + 3.0 * period;
  for (double t = 0.0; t < end; t += dt) {
    // The middle of each step, because the leader's speed is constant over the step.
    double const front_speed = speed + amplitude * std::sin(w * (t + dt / 2));
    double ahead = leader, ahead_speed = front_speed;
    for (std::size_t i = 0; i < n; ++i) {
      double const own = x[i], before = v[i];
      auto const motion = cb::idm_motion(p, v[i], ahead - x[i], ahead_speed, dt, 1e-9);
      ahead = own;
      x[i] += motion.distance;
      v[i] = motion.speed;
      ahead_speed = 0.5 * (before + v[i]);
    }
    leader += front_speed * dt;
    if (t > settled) {
      low = std::min(low, v.back());
      high = std::max(high, v.back());
    }
  }
  return (high - low) / (2 * amplitude);
}

}  // namespace

TEST_CASE("platoons damp or amplify a small wave as linear theory predicts") {
  int stable = 0, unstable = 0;
  for (std::uint32_t seed = 0; seed < 24; ++seed) {
    cb::RandomStream random(seed, 0, 0);
    auto const p = any_driver(random);
    double const speed = between(0.3, 0.8, random) * p.desired_speed;
    auto const f = linear(p, speed);
    // String stable: no frequency is amplified (Treiber, Kesting 2013, section 15.4): f_v^2 - f_l^2 >= 2 f_s.
    double const margin = f.by_speed * f.by_speed - f.by_leader_speed * f.by_leader_speed - 2 * f.by_gap;
    double const w = margin < 0.0 ? std::sqrt(-margin / 2) : 0.3;
    if (w < 0.08) continue;  // near the limit: waves too long to simulate
    int const followers = 12;
    double const expected = std::pow(amplification(f, w), followers);
    double const measured = simulated_amplification(p, speed, w, followers);
    INFO("seed ", seed, ", margin ", margin);
    CHECK(measured == doctest::Approx(expected).epsilon(0.1));
    CHECK((measured < 1.0) == (margin > 0.0));
    CHECK(f.is_string_stable() == (margin >= 0.0));
    (margin > 0.0 ? stable : unstable)++;
  }
  MESSAGE(stable << " stable and " << unstable << " unstable drivers");
  CHECK(stable >= 3);
  CHECK(unstable >= 3);
}

TEST_CASE("followers settle at the closed-form gap") {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    cb::RandomStream random(seed, 1, 0);
    auto const p = any_driver(random);
    double const leader = between(0.2, 0.85, random) * p.desired_speed;
    double gap = between(20, 120, random), acc_gap = gap, v = between(0, 1, random) * p.desired_speed, acc_v = v;
    double const coolness = cb::uniform01(random);
    cb::AccLaw const law(p, coolness, 0.0, p.desired_speed, cb::Acc::Base::idm);
    for (int i = 0; i < 3000; ++i) {
      auto const m = cb::idm_motion(p, v, gap, leader, 0.2, 1e-6);
      gap += 0.2 * leader - m.distance;
      v = m.speed;
      auto const n = cb::follow_motion(law, acc_v, {acc_gap, leader, 0.0}, 0.2);
      acc_gap += 0.2 * leader - n.distance;
      acc_v = n.speed;
      REQUIRE(gap > 0.0);
      REQUIRE(acc_gap > 0.0);
    }
    CHECK(gap == doctest::Approx(cb::idm_equilibrium_gap(p, leader)).epsilon(1e-3));
    CHECK(acc_gap == doctest::Approx(cb::idm_equilibrium_gap(p, leader)).epsilon(1e-3));
  }
}

TEST_CASE("the ACC model lies between IDM and the heuristic, closer to the heuristic the cooler the driver") {
  auto const base = cb::Acc::Base::idm;
  cb::RandomStream random(7, 0, 0);
  int cooler = 0;
  for (int i = 0; i < 50000; ++i) {
    auto const p = any_driver(random);
    double const v = between(0, 40, random);
    cb::Constraint const leader{between(0.5, 100, random), between(0, 40, random), between(-8, 3, random)};
    double const idm = cb::AccLaw(p, 0.0, v, p.desired_speed, base)(leader),
                 cah = cb::cah_acceleration(v, leader, p.maximum_acceleration);
    double const low = std::max(p.lowest_acceleration, std::min(idm, cah)), high = std::max(idm, cah);
    double previous = idm;
    for (double const coolness : {0.3, 0.6, 0.99, 1.0}) {
      double const a = cb::AccLaw(p, coolness, v, p.desired_speed, base)(leader);
      REQUIRE(std::isfinite(a));
      CHECK(a >= low - 1e-9);
      CHECK(a <= high + 1e-9);
      CHECK(a >= previous - 1e-9);
      cooler += a > previous + 1e-9;
      previous = a;
    }
    if (idm >= cah) CHECK(previous == doctest::Approx(idm));
  }
  CHECK(cooler > 20000);
}

TEST_CASE("behind an equally fast vehicle that cuts in, IDM brakes hard and the ACC model calmly") {
  auto const p = cb::presets::kesting_2010_car();
  auto const base = cb::Acc::Base::idm;
  cb::Constraint const leader{10.0, 25.0, 0.0};
  double const idm = cb::AccLaw(p, 0.0, 25.0, p.desired_speed, base)(leader),
               acc = cb::AccLaw(p, 0.99, 25.0, p.desired_speed, base)(leader);
  MESSAGE("IDM " << idm << " m/s^2, ACC " << acc << " m/s^2");
  CHECK(idm < -5.0);
  CHECK(acc > -2.5);
  CHECK(acc < 0.0);
}

TEST_CASE("from safe gaps the ACC model does not collide with a leader that brakes to a standstill") {
  double hardest = 0.0;
  for (std::uint32_t seed = 0; seed < 2000; ++seed) {
    cb::RandomStream random(seed, 2, 0);
    auto p = any_driver(random);
    p.lowest_acceleration = -9.0;
    double const coolness = cb::uniform01(random), dt = 0.1 * (1 + cb::uniform_index(random, 3));
    double v = between(0.1, 0.9, random) * p.desired_speed, leader = v;
    double gap = cb::idm_equilibrium_gap(p, v), braking = -between(0.5, 6.0, random);
    for (int i = 0; i * dt < 150.0; ++i) {
      cb::Constraint const seen{gap, leader, i > 0 && leader > 0.0 ? braking : 0.0};
      double const next = std::max(0.0, leader + braking * dt);
      cb::AccLaw const law(p, coolness, 0.0, p.desired_speed, cb::Acc::Base::idm);
      auto const m = cb::follow_motion(law, v, seen, dt);
      hardest = std::min(hardest, (m.speed - v) / dt);
      gap += 0.5 * (leader + next) * dt - m.distance;
      v = m.speed;
      leader = next;
      CAPTURE(seed);
      REQUIRE(gap > 0.0);
      REQUIRE(v >= 0.0);
    }
    CHECK(v < 0.1);
  }
  MESSAGE("hardest braking " << -hardest << " m/s^2");
}

TEST_CASE("an ACC driver brakes for what comes towards it, whether that accelerates or brakes") {
  cb::RandomStream random(4, 0, 0, 0);
  for (int i = 0; i < 10'000; ++i) {
    auto const driver = any_driver(random);
    double const speed = between(0.5, 30, random), gap = between(0.5, 60, random);
    cb::AccLaw const law(driver, 0.99, speed, driver.desired_speed, cb::Acc::Base::idm);
    double const standing = law({gap, 0.0, 0.0});
    double const oncoming = law({gap, between(-20, -0.1, random), between(-5, 5, random)});
    CAPTURE(speed);
    CAPTURE(gap);
    CHECK(oncoming <= standing + 1e-9);
  }
}

TEST_CASE(
    "on the Improved IDM the ACC model keeps its headway up to the desired speed, and stays calm after a cut-in") {
  cb::Acc const improved{}, classic{.base = cb::Acc::Base::idm};
  for (double const speed : {5.0, 10.0, 14.0, 14.9}) {
    CAPTURE(speed);
    cb::Constraint const leader{improved.minimum_gap + speed * improved.time_headway, speed, 0.0};
    CHECK(improved.acceleration(speed, improved.desired_speed, leader) == doctest::Approx(0.0));
    CHECK(classic.acceleration(speed, classic.desired_speed, leader) < -0.01);
  }
  cb::ImprovedIdm const law;
  cb::Constraint const cut_in{6.0, 14.0, 0.0};
  CHECK(law.acceleration(14.0, law.desired_speed, cut_in) == law.lowest_acceleration);
  CHECK(improved.acceleration(14.0, improved.desired_speed, cut_in) > -1.1 * improved.comfortable_deceleration);
}

TEST_CASE("extreme inputs give finite accelerations within the bounds") {
  cb::Idm const p;
  for (double const v : {0.0, 1e-9, 30.0, 1000.0})
    for (double const gap : {-10.0, 0.0, 1e-12, 1.0, 1e9})
      for (double const leader : {0.0, 1e-9, 1000.0})
        for (double const a : {-50.0, 0.0, 1e-9, 50.0})
          for (double const coolness : {0.0, 0.5, 1.0})
            for (auto const base : {cb::Acc::Base::idm, cb::Acc::Base::improved_idm}) {
              double const result = cb::AccLaw(p, coolness, v, p.desired_speed, base)({gap, leader, a});
              CHECK(result >= p.lowest_acceleration);
              CHECK(result <= p.highest_acceleration);
            }
}
