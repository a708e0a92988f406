// MOBIL's decision against a twin that computes equations 2 to 7 of Kesting, Treiber, Helbing 2007 anew, from the
// positions of all vehicles.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "cambium/behavior/drivers.hpp"
#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

using Sim = Traffic<cb::Mobil, cb::ConstantAcceleration>;

struct Vehicle {
  int lane{};  ///< from the left, 1 to 3
  double x{}, speed{}, front{}, rear{};

  [[nodiscard]] double length() const { return front + rear; }
};

/// IDM's acceleration, without a leader if `gap` is infinite.
double idm(cb::Idm const& p, double desired, double v, double gap, double leader_speed) {
  if (!(gap > 0.0)) return p.lowest_acceleration;
  double const wanted =
      p.minimum_gap +
      std::max(0.0, v * p.time_headway + v * (v - leader_speed) /
                                             (2.0 * std::sqrt(p.maximum_acceleration * p.comfortable_deceleration)));
  double const a = p.maximum_acceleration * (1.0 - std::pow(v / desired, p.exponent) - (wanted / gap) * (wanted / gap));
  return std::clamp(a, p.lowest_acceleration, p.highest_acceleration);
}

constexpr double nobody = std::numeric_limits<double>::infinity();

struct Twin {
  cb::Mobil const& driver;
  Vehicle const& own;
  std::vector<Vehicle> const& others;

  /// The nearest vehicle ahead or behind in a lane.
  [[nodiscard]] std::optional<Vehicle> next(int lane, bool ahead) const {
    std::optional<Vehicle> best;
    for (auto const& one : others)
      if (one.lane == lane && (one.x > own.x) == ahead &&
          (!best || std::abs(one.x - own.x) < std::abs(best->x - own.x)))
        best = one;
    return best;
  }

  [[nodiscard]] double following(std::optional<Vehicle> const& leader) const {
    double const v = own.speed, desired = driver.law.desired_speed;
    return leader ? idm(driver.law, desired, v, leader->x - leader->rear - own.x - own.front, leader->speed)
                  : idm(driver.law, desired, v, nobody, 0.0);
  }

  /// A follower's acceleration behind `leader`.
  [[nodiscard]] double of_follower(std::optional<Vehicle> const& who, std::optional<Vehicle> const& leader) const {
    if (!who) return 0.0;
    auto const& p = who->length() > driver.lateral.truck_length ? driver.lateral.trucks : driver.lateral.others;
    double const desired = std::max(p.desired_speed, who->speed);
    return leader ? idm(p, desired, who->speed, leader->x - leader->rear - who->x - who->front, leader->speed)
                  : idm(p, desired, who->speed, nobody, 0.0);
  }

  [[nodiscard]] bool passes(std::optional<Vehicle> const& inner_leader) const {  // the condition of eq. 5
    return inner_leader && own.speed > inner_leader->speed && inner_leader->speed > driver.lateral.rule.critical_speed;
  }

  /// Incentive of a change by one lane above its threshold, or nothing if it is unsafe.
  [[nodiscard]] std::optional<double> worth(bool left) const {
    int const lane = left ? own.lane - 1 : own.lane + 1;
    if (lane < 1 || lane > 3) return std::nullopt;
    auto const leader = next(own.lane, true), follower = next(own.lane, false);
    auto const new_leader = next(lane, true), new_follower = next(lane, false);
    double now = following(leader), then = following(new_leader);
    double of_new = of_follower(new_follower, own) - of_follower(new_follower, new_leader);
    double of_old = of_follower(follower, leader) - of_follower(follower, own);
    if (driver.lateral.rule.keep_right) {
      auto const inner = next(own.lane - 1, true);
      double const gap = inner ? inner->x - inner->rear - own.x - own.front : nobody;
      if (inner && inner->speed > driver.lateral.rule.critical_speed && gap > 0.0) {
        // Nobody brakes hard for it: behind a slower one as at the desired headway, else as in steady following.
        auto const& p = driver.law;
        double const share = std::pow(own.speed / p.desired_speed, 4), steady = std::max(0.0, 1.0 - share);
        double const weight = std::clamp((own.speed - inner->speed) / 2.0, 0.0, 1.0);
        double const least = (p.minimum_gap + own.speed * p.time_headway) / std::sqrt(steady + weight * (1.0 - steady));
        now = std::min(now, idm(p, p.desired_speed, own.speed, std::max(gap, least), inner->speed));
      }
      if (left && passes(new_leader)) now = std::min(now, then);
      if (!left && passes(leader)) then = std::min(now, then);
      (left ? of_old : of_new) = 0.0;  // eq. 6, 7
    } else {
      of_new = std::min(of_new, 0.0);  // see `BasicMobil`
    }
    double const incentive =
        then - now + driver.lateral.rule.politeness * (of_new + of_old) - driver.lateral.rule.threshold;
    bool const has_room =
        (!new_leader || new_leader->x - new_leader->rear - own.x - own.front > driver.lateral.safe_gap) &&
        (!new_follower || own.x - own.rear - new_follower->x - new_follower->front > driver.lateral.safe_gap);
    bool const is_safe = has_room && (!new_leader || following(new_leader) >= -driver.lateral.safe_deceleration) &&
                         (!new_follower || of_follower(new_follower, own) >= -driver.lateral.safe_deceleration);
    if (!is_safe) return std::nullopt;
    return incentive + (left ? -driver.lateral.rule.bias : driver.lateral.rule.bias);
  }
};

cb::Mobil random_driver(cb::RandomStream& random) {
  cb::Mobil driver;
  driver.law.desired_speed = between(15.0, 40.0, random);
  driver.law.time_headway = between(0.8, 2.0, random);
  driver.law.minimum_gap = between(1.0, 3.0, random);
  driver.lateral.rule.politeness = between(0.0, 1.0, random);
  driver.lateral.rule.threshold = between(0.0, 0.5, random);
  driver.lateral.rule.bias = between(-0.5, 0.5, random);
  driver.lateral.rule.keep_right = cb::uniform01(random) < 0.5;
  driver.lateral.rule.critical_speed = between(5.0, 25.0, random);
  driver.lateral.safe_deceleration = between(1.0, 6.0, random);
  driver.lateral.safe_gap = between(0.5, 4.0, random);
  return driver;
}

/// Up to 12 vehicles about `own`, no two within 12 m in one lane; a third of them long.
std::vector<Vehicle> random_vehicles(Vehicle const& own, cb::RandomStream& random) {
  std::vector<Vehicle> others;
  for (int i = 0; i < 12; ++i) {
    auto const shape = cb::uniform01(random) < 0.33 ? cb::geometry::truck() : cb::geometry::car();
    Vehicle const one{1 + static_cast<int>(cb::uniform_index(random, 3)), own.x + between(-90.0, 90.0, random),
                      between(5.0, 35.0, random), shape.front, shape.rear};
    auto const is_near = [&](Vehicle const& other) {
      return other.lane == one.lane && std::abs(other.x - one.x) < 15.0;
    };
    if (!is_near(own) && std::none_of(others.begin(), others.end(), is_near)) others.push_back(one);
  }
  return others;
}

}  // namespace

TEST_CASE("MOBIL decides by equations 2 to 7, in thousands of random situations") {
  auto const map = straight_road(3, 1200.0);
  int changes[3] = {}, close = 0;
  for (std::uint32_t number = 0; number < 6000; ++number) {
    cb::RandomStream random(12, number, 0);
    auto const driver = random_driver(random);
    auto const car = cb::geometry::car();
    Vehicle const own{1 + static_cast<int>(cb::uniform_index(random, 3)), 600.0, between(8.0, 35.0, random), car.front,
                      car.rear};
    auto const others = random_vehicles(own, random);
    Sim world(map, {.seed = number});
    auto const id = add(world, own.lane, own.x, own.speed, driver, {}, car);
    for (auto const& one : others)
      add(world, one.lane, one.x, one.speed, cb::ConstantAcceleration{}, {},
          one.length() > 8.0 ? cb::geometry::truck() : car);
    Twin const twin{driver, own, others};
    auto const left = twin.worth(true), right = twin.worth(false);
    double const most = std::max(left.value_or(-1e9), right.value_or(-1e9));
    // Rounding decides where the incentive is 0, or equal on both sides.
    if (std::abs(most) < 1e-9 || (left && right && std::abs(*left - *right) < 1e-9)) {
      ++close;
      continue;
    }
    int const expected = most <= 0.0 ? 0 : left.value_or(-1e9) == most ? -1 : 1;
    auto const& piece = world.observe(id).corridor().pieces[world.record(id).lane.piece];
    REQUIRE(world.step(0.1));
    auto const change = std::get<0>(world.record(id).memory).lateral.change;
    int const decided = !change.active() ? 0 : change.target == piece.left ? -1 : 1;
    CAPTURE(number);
    CAPTURE(driver.lateral.rule.keep_right);
    CAPTURE(left.value_or(-1e9));
    CAPTURE(right.value_or(-1e9));
    CHECK(decided == expected);
    ++changes[expected + 1];
  }
  MESSAGE(changes[0] << " changes to the left, " << changes[2] << " to the right, " << changes[1] << " times none");
  CHECK(changes[0] > 500);
  CHECK(changes[2] > 500);
  CHECK(changes[1] > 500);
  CHECK(close < 100);
}
