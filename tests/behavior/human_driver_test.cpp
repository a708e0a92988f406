// Drivers with reaction time, estimation errors, anticipation and inattention (Treiber, Kesting, Helbing 2006).
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <variant>
#include <vector>

#include "cambium/cambium.hpp"

#include "lane_traffic_fixtures.hpp"

namespace {

using namespace lane_traffic;

/// Swings about a speed.
struct Swinging {
  double speed = 20.0, amplitude = 0.5, frequency = 0.3;  // [m/s], [m/s], [rad/s]
  template <class View>
  cb::Plan<View> plan(View const& view, cb::NoMemory&, double dt) const {
    double const t = view.time(), next = t + dt, w = frequency;
    double const way = speed * dt + amplitude / w * (std::cos(w * t) - std::cos(w * next));
    return cb::plan_along_lane(view, {way, speed + amplitude * std::sin(w * next)}, dt);
  }
};

/// Brakes once, for a second from 50 s on.
struct Braking {
  double speed = 20.0;
  template <class View>
  cb::Plan<View> plan(View const& view, cb::NoMemory&, double dt) const {
    double const now = view.state().speed, t = view.time() + 0.5 * dt;
    double const next = std::max(0.0, now - (t > 50.0 && t < 51.0 ? 3.0 * dt : 0.0));
    return cb::plan_along_lane(view, {0.5 * (now + next) * dt, next}, dt);
  }
};

using Human = cb::HumanDriver<cb::IdmClassic>;
using Platoon = Traffic<Human, Swinging, Braking, cb::IdmClassic>;

cb::Idm const driver = cb::presets::kesting_2010_car();
constexpr double speed = 20.0;

/// A human without errors.
Human precise(double reaction_time, bool anticipates) {
  return {.nominal = cb::IdmClassic{.law = driver},
          .reaction_time = reaction_time,
          .gap_error = 0.0,
          .rate_error = 0.0,
          .anticipates = anticipates,
          .noise = 0.0};
}

/// Humans behind a leader, in equilibrium at its speed; agent 0 leads.
template <class Leader, class Follower>
Platoon platoon(Leader const& leader, Follower const& follower, int followers, std::uint64_t seed = 1) {
  static auto const road = straight_road(1, 20'000.0);
  Platoon world(road, {.seed = seed});
  double const apart = cb::idm_equilibrium_gap(driver, speed) + cb::geometry::car().length();
  for (int i = 0; i <= followers; ++i) {
    Platoon::AgentSpec spec{.position = {apart * (followers - i) + 10.0, -1.75}, .speed = speed};
    if (i == 0)
      spec.behavior = leader;
    else
      spec.behavior = follower;
    world.add(spec);
  }
  return world;
}

/// How much larger (complex: and how much later) a small wave of the leader's speed is behind one follower. From the
/// Fourier transform of the linear law with delay T, where the speeds v and u of follower and leader go as
/// exp(i w t): i w v = exp(-i w T) (f_s s + f_v v + f_u u), s = (u - v) / (i w). A driver that anticipates knows its
/// own place and speed at t, and extrapolates the leader's from t - T at constant acceleration.
std::complex<double> gain(double frequency, double delay, bool anticipates) {
  auto const law = [](double v, double s, double u) { return cb::idm_acceleration(driver, v, s, u); };
  auto const f = cb::linear_following(law, speed, cb::idm_equilibrium_gap(driver, speed));
  std::complex<double> const iw(0.0, frequency), late = std::exp(-iw * delay);
  auto const own = anticipates ? 1.0 : late;
  double const ahead = anticipates ? delay : 0.0;
  auto const place = late * (1.0 / iw + ahead + 0.5 * iw * ahead * ahead), leader_speed = late * (1.0 + iw * ahead);
  return (f.by_gap * place + f.by_leader_speed * leader_speed) / (iw + own * (f.by_gap / iw - f.by_speed));
}

double largest_gain(double delay, bool anticipates) {
  double largest = 0.0;
  for (double w = 0.01; w < 6.0; w += 0.01) largest = std::max(largest, std::abs(gain(w, delay, anticipates)));
  return largest;
}

/// Amplitudes of the speeds' waves of this frequency, by agent, over some periods after they have settled.
std::vector<double> amplitudes(Platoon world, double frequency, double dt) {
  double const from = 150.0, until = from + 5 * 2 * cb::geometry::pi / frequency;
  std::vector<std::complex<double>> sums(world.size());
  for (double t = 0.0; t < until; t += dt) {
    REQUIRE(world.step(dt));
    if (t < from) continue;
    for (std::size_t i = 0; i < sums.size(); ++i)
      sums[i] += std::polar(1.0, -frequency * world.time()) * (world.frame().agents[i].state.speed - speed);
  }
  std::vector<double> result;
  for (auto const& sum : sums) result.push_back(std::abs(sum));
  return result;
}

/// Time [s] at which agent 1 first brakes harder than 0.5 m/s^2; infinite if it does not within 70 s.
double braking_time(Platoon world, double dt) {
  while (world.time() < 70.0) {
    REQUIRE(world.step(dt));
    if (world.frame().agents[1].action.acceleration < -0.5) return world.time();
  }
  return std::numeric_limits<double>::infinity();
}

template <class Nominal>
using Twins = Traffic<Nominal, cb::HumanDriver<Nominal>>;

}  // namespace

TEST_CASE_TEMPLATE("a human without imperfections drives as the nominal behaviour, to the last bit", Nominal,
                   cb::IdmClassic, cb::IdmStochastic, cb::IdmLaneTracking, cb::AdaptiveCruiseControl, cb::Mobil,
                   cb::Intersection) {
  Twins<Nominal> nominal(straight_road(3, 1000.0), {.seed = 3});
  for (int i = 0; i < 12; ++i) {
    Nominal behavior{};
    if constexpr (requires { behavior.law; }) behavior.law.desired_speed = 10.0 + i;
    nominal.add({.position = {15.0 * i + 5.0, i % 3 == 0   ? -5.25
                                              : i % 3 == 1 ? -1.75
                                                           : -8.75},
                 .speed = 8.0 + i % 5,
                 .behavior = behavior});
  }
  nominal.add_object(cb::geometry::Polygon({{300, -3}, {301, -3}, {301, -0.5}, {300, -0.5}}));
  auto human = nominal;
  for (std::size_t i = 0; i < human.size(); ++i) {
    auto const id = human.roster().agents[i].id;
    human.set_behavior(id, cb::HumanDriver<Nominal>{.nominal = std::get<Nominal>(human.roster().agents[i].behavior),
                                                    .reaction_time = 0.0,
                                                    .gap_error = 0.0,
                                                    .rate_error = 0.0,
                                                    .noise = 0.0});
  }
  step_all(150, 0.2, nominal, human);
  for (std::size_t i = 0; i < human.size(); ++i)
    CHECK(human.frame().agents[i].state == nominal.frame().agents[i].state);
}

TEST_CASE("a human without imperfections does so among cyclists, and where it observes with errors") {
  using Noisy = cb::World<cb::BehaviorSet<cb::IdmClassic, Human>, cb::InterpolateExecution, cb::SingleTrack,
                          cb::ParametricObserver>;
  cb::ObservationNoise const noise{.along = 0.3, .across = 0.1, .speed = 0.2};
  auto const drive = [&](bool human) {
    Noisy world(straight_road(1, 1000.0), {.seed = 3});
    cb::IdmClassic const exact{.law = {.desired_speed = 12.0}};
    Noisy::Behaviors::Any behavior = exact;
    if (human)
      behavior = Human{.nominal = exact, .reaction_time = 0.0, .gap_error = 0.0, .rate_error = 0.0, .noise = 0.0};
    for (int i = 0; i < 8; ++i) {
      bool const cycles = i % 2 == 1;
      world.add({.position = {20.0 + 25.0 * i, cycles ? -3.0 : -1.75},
                 .speed = cycles ? 5.0 : 10.0,
                 .shape = cycles ? cb::geometry::bicycle() : cb::geometry::car(),
                 .behavior = cycles ? Noisy::Behaviors::Any(cb::IdmClassic{.law = {.desired_speed = 5.0},
                                                                           .lateral = cb::presets::cyclist_lane()})
                                    : behavior,
                 .observer = {.others = noise}});
    }
    for (int k = 0; k < 150; ++k) REQUIRE(world.step(0.2));
    return world;
  };
  auto const nominal = drive(false), human = drive(true);
  for (cb::Slot slot{}; cb::index_of(slot) < human.size(); ++slot)
    CHECK(human.frame().agents[slot].state == nominal.frame().agents[slot].state);
}

TEST_CASE("a decision takes effect one reaction time later, however long the steps") {
  struct Case {
    double reaction_time, dt;
  };
  for (auto const [reaction_time, dt] : {Case{0.8, 0.1}, Case{1.0, 0.1}, Case{2.0, 0.5}, Case{1.5, 0.02}}) {
    CAPTURE(reaction_time);
    double const at_once = braking_time(platoon(Braking{}, cb::IdmClassic{.law = driver}, 1), dt);
    double const later = braking_time(platoon(Braking{}, precise(reaction_time, false), 1), dt);
    CHECK(at_once > 50.0);
    CHECK(at_once < 51.5);
    // Nothing is lost when steps are so short that it does not decide in each of them.
    CHECK(later - at_once == doctest::Approx(reaction_time).epsilon(dt < 0.05 ? 0.07 : 1e-6));
  }
}

TEST_CASE("small waves grow or fade from driver to driver as the linear theory of the delayed law says") {
  for (double const reaction_time : {0.0, 0.5, 1.0})
    for (bool const anticipates : {false, true})
      for (double const frequency : {0.3, 0.8}) {
        CAPTURE(reaction_time);
        CAPTURE(anticipates);
        CAPTURE(frequency);
        auto const world =
            platoon(Swinging{.amplitude = 0.05, .frequency = frequency}, precise(reaction_time, anticipates), 1);
        auto const of = amplitudes(world, frequency, 0.05);
        CHECK(of[1] / of[0] == doctest::Approx(std::abs(gain(frequency, reaction_time, anticipates))).epsilon(0.015));
      }
}

TEST_CASE("a reaction time makes a platoon unstable that is stable without, and anticipation makes it stable again") {
  CHECK(largest_gain(0.0, false) < 1.001);
  CHECK(largest_gain(0.7, false) < 1.001);
  CHECK(largest_gain(1.1, false) > 1.08);
  CHECK(largest_gain(1.1, true) < 1.02);
  constexpr double frequency = 0.85;
  constexpr int followers = 12;
  auto const growth = [](double reaction_time, bool anticipates) {
    Swinging const leader{.amplitude = 0.02, .frequency = frequency};
    auto const of = amplitudes(platoon(leader, precise(reaction_time, anticipates), followers), frequency, 0.1);
    return of[followers] / of[1];
  };
  CHECK(growth(0.0, false) < 0.01);
  CHECK(growth(1.1, false) > 2.0);
  CHECK(growth(1.1, true) < 1.0);
}

TEST_CASE("reaction time and anticipation do not change the gap that a driver keeps at constant speed") {
  for (bool const anticipates : {false, true}) {
    auto world = platoon(Swinging{.amplitude = 0.0}, precise(0.9, anticipates), 1);
    world.set_behavior(static_cast<cb::AgentId>(0), Swinging{.speed = 18.0, .amplitude = 0.0});
    for (int k = 0; k < 1500; ++k) REQUIRE(world.step(0.2));
    auto const leader = world.observe(static_cast<cb::AgentId>(1)).ahead();
    REQUIRE(leader);
    CHECK(leader->gap == doctest::Approx(cb::idm_equilibrium_gap(driver, 18.0)).epsilon(1e-4));
  }
}

TEST_CASE("errors are normal, last, and show in the gaps that drivers keep") {
  Human const erring{.nominal = cb::IdmClassic{.law = driver},
                     .reaction_time = 0.6,
                     .gap_error = 0.1,
                     .rate_error = 0.0,
                     .persistence = 2000.0,
                     .noise = 0.0};
  double sum = 0.0, squares = 0.0, product = 0.0, variance = 0.0;
  int n = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    auto world = platoon(Swinging{.amplitude = 0.0}, erring, 1, seed);
    auto const id = static_cast<cb::AgentId>(1);
    for (int k = 0; k < 500; ++k) REQUIRE(world.step(0.2));
    double const error = static_cast<double>(world.memory<Human>(id).gap_error);
    double const kept = std::log(world.observe(id).ahead()->gap / cb::idm_equilibrium_gap(driver, speed));
    // It keeps the estimated gap: the gap times exp(0.1 error). The error still drifts, the gap a little behind it.
    CHECK(kept == doctest::Approx(-0.1 * error).epsilon(0.04).scale(1.0));
    sum += error;
    squares += error * error;
    ++n;
  }
  CHECK(std::abs(sum / n) < 0.15);
  CHECK(squares / n == doctest::Approx(1.0).epsilon(0.2));
  // One persistence time later, e^-1 of an error is left on average.
  Human const usual{.nominal = cb::IdmClassic{.law = driver}, .persistence = 20.0};
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    auto world = platoon(Swinging{.amplitude = 0.0}, usual, 2, seed);
    auto const errors = [&] {
      std::vector<double> result;
      for (auto const id : {static_cast<cb::AgentId>(1), static_cast<cb::AgentId>(2)})
        for (float const e : {world.memory<Human>(id).gap_error, world.memory<Human>(id).rate_error})
          result.push_back(static_cast<double>(e));
      return result;
    };
    REQUIRE(world.step(0.2));
    auto const before = errors();
    for (int k = 0; k < 100; ++k) REQUIRE(world.step(0.2));
    auto const after = errors();
    for (std::size_t i = 0; i < 4; ++i) {
      product += before[i] * after[i] / 1600.0;
      variance += after[i] * after[i] / 1600.0;
    }
  }
  CHECK(variance == doctest::Approx(1.0).epsilon(0.1));
  CHECK(product == doctest::Approx(std::exp(-1.0)).epsilon(0.2));
}

TEST_CASE("a driver decides in every step, or as often as its memory of 16 decisions spans a reaction time") {
  for (double const dt : {0.05, 0.1, 0.5})
    for (double const reaction_time : {0.3, 1.2, 2.0}) {
      int pause = 1;  // [steps]
      while (15 * pause * dt < reaction_time - 1e-9) ++pause;
      auto world = platoon(Swinging{}, precise(reaction_time, true), 1);
      double oldest = 0.0;
      for (int k = 0; k < 60; ++k) {
        REQUIRE(world.step(dt));
        oldest = std::max(oldest, static_cast<double>(world.memory<Human>(cb::AgentId{1}).age));
      }
      CAPTURE(dt);
      CAPTURE(reaction_time);
      CHECK(oldest == doctest::Approx((pause - 1) * dt).epsilon(1e-5).scale(1.0));
    }
}

TEST_CASE("a driver errs about the speeds of vehicles, but knows that objects stand") {
  Platoon world(straight_road(2, 500.0));
  auto const id = add(world, 1, 100.0, 20.0, precise(0.0, false));
  world.add_object(cb::geometry::Polygon({{150, -2}, {152, -2}, {152, -1}, {150, -1}}));
  auto const view = world.observe(id);
  cb::HumanView const mistaken(view, cb::HumanEstimate{.rate_error = 0.1});
  REQUIRE(mistaken.ahead());
  CHECK(mistaken.ahead()->speed == 0.0);
  add(world, 1, 130.0, 20.0, cb::IdmClassic{});
  auto const now = world.observe(id);
  double const gap = now.ahead()->gap;
  CHECK(cb::HumanView(now, cb::HumanEstimate{.rate_error = 0.1}).ahead()->speed == doctest::Approx(20.0 + 0.1 * gap));
}

TEST_CASE("from vehicle to vehicle a human view finds each one once, whatever it expects of them") {
  Platoon world(straight_road(1, 500.0));
  auto const id = add(world, 1, 50.0, 12.0, Swinging{});
  std::vector<cb::AgentId> const others{add(world, 1, 65.0, 6.0, Swinging{}), add(world, 1, 110.0, 0.0, Swinging{}),
                                        add(world, 1, 160.0, 14.0, Swinging{})};
  auto const view = world.observe(id);
  for (double const gap_factor : {0.7, 1.0, 1.4})
    for (double const way : {0.0, 3.0, 14.0, 24.0}) {
      cb::HumanView const human(view, {.gap_factor = gap_factor, .reach = way / 12.0, .way = way, .speed = 12.0});
      std::vector<cb::AgentId> found;
      auto at = human.place();
      while (auto const next = human.ahead(at)) {
        found.push_back(next->agent);
        at.s = next->s + 0.01;
        REQUIRE(found.size() < 9);
      }
      CHECK(found == others);
      // Who is ahead stays ahead.
      CHECK(human.ahead()->gap >= 0.0);
    }
}

TEST_CASE("a step of any length takes the same time") {
  auto world = platoon(Swinging{}, precise(0.6, true), 1);
  for (double const dt : {0.1, 1e-9, 1e-14, 1e-300, 0.1}) CHECK(world.step(dt));
}

TEST_CASE("an oncoming vehicle is expected to keep its acceleration along its own heading") {
  Traffic<Human, cb::StaticTrajectory> world(straight_road(1, 500.0));
  auto const id = add(world, 1, 50.0, 12.0, precise(0.6, true));
  std::vector<cb::State> states;  // brakes by 1 m/s^2
  for (double t = 0.0; t < 5.0; t += 0.1)
    states.push_back({t, 150.0 - 10.0 * t + 0.5 * t * t, -1.75, cb::geometry::pi, 10.0 - t});
  world.add({.position = {150.0, -1.75}, .speed = 10.0, .behavior = cb::StaticTrajectory(states)});
  for (int k = 0; k < 3; ++k) REQUIRE(world.step(0.1));
  auto const view = world.observe(id);
  auto const now = view.ahead();
  REQUIRE(now);
  CHECK(now->speed == doctest::Approx(-9.7));
  auto const then = cb::HumanView(view, {.rate_error = 0.01, .reach = 2.0, .way = 24.0, .speed = 12.0}).ahead();
  REQUIRE(then);
  double const seen = -9.7 + 0.01 * now->gap;
  CHECK(then->speed == doctest::Approx(seen + 2.0));
  CHECK(then->gap == doctest::Approx(now->gap + 2.0 * seen + 2.0 - 24.0));
}

TEST_CASE("a human driver waits for a pedestrian ahead and passes one beside it") {
  for (double const gap : {-2.5, -1.0, 6.0, 40.0}) {
    CAPTURE(gap);
    Traffic<Human, cb::ConstantAcceleration> world(straight_road(1, 500.0));
    auto const pedestrian = cb::geometry::pedestrian();
    auto const id = add(world, 1, 50.0, 14.0, precise(0.6, true));
    double const x = 50.0 + cb::geometry::car().front + gap + pedestrian.rear;
    world.add({.position = {x, gap < 0.0 ? -3.1 : -1.75},
               .speed = 0.0,
               .shape = pedestrian,
               .behavior = cb::ConstantAcceleration{}});
    for (int k = 0; k < 80; ++k) REQUIRE(world.step(0.1));
    CHECK((world.state(id).speed > 14.0) == (gap < 0.0));
    if (gap > 30.0) CHECK(world.state(id).x < x);
  }
}

TEST_CASE("a human that creeps through a bend keeps its lane") {
  Traffic<cb::HumanDriver<cb::UrbanDriver>, Swinging> world(road_with_bend(20.0));
  auto const& lane = lane_of(world.map(), 1);
  auto const leader = enter(world, lane, 225.0, {.behavior = Swinging{.speed = 0.03, .amplitude = 0.02}});
  auto const human = enter(world, lane, 218.0, {.behavior = cb::HumanDriver<cb::UrbanDriver>{}});
  REQUIRE(world.observe(leader).place().s > 220.0);
  double most_aslant = 0.0, farthest = 0.0;
  for (int k = 0; k < 1500; ++k) {
    REQUIRE(world.step(0.1));
    auto const at = world.observe(human).place();
    most_aslant = std::max(most_aslant, std::abs(at.heading_error));
    farthest = std::max(farthest, std::abs(at.lateral));
  }
  CHECK(world.observe(human).place().s > 220.0);
  CHECK(most_aslant < 0.03);
  CHECK(farthest < 0.03);
}

TEST_CASE("a driver that looks away notices later that its leader brakes") {
  auto inattentive = precise(0.6, true);
  inattentive.attentive = 3.0;
  inattentive.looks_away = 1.5;
  double const usual = braking_time(platoon(Braking{}, precise(0.6, true), 1), 0.1);
  int late = 0, away = 0;
  constexpr int runs = 300;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    auto const world = platoon(Braking{}, inattentive, 1, seed);
    double const time = braking_time(world, 0.1);
    CHECK(time >= usual - 0.11);
    late += time > usual + 0.3;
    auto other = world;
    for (int k = 0; k < 300; ++k) REQUIRE(other.step(0.1));
    away += other.memory<Human>(static_cast<cb::AgentId>(1)).looks_away;
  }
  CHECK(away / double{runs} == doctest::Approx(1.5 / 4.5).epsilon(0.25));  // the share of its time
  CHECK(late > runs / 8);
  CHECK(late < runs / 2);
}
