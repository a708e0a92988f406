// An observer that errs across the lane finds others in the lanes where it sees them.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "fixtures.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/observer/delayed.hpp"
#include "cambium/observer/parametric.hpp"

using namespace fixtures;

namespace {

template <class Observer>
using World = cb::World<cb::BehaviorSet<cb::ConstantAcceleration>, cb::InterpolateExecution, cb::SingleTrack, Observer>;

constexpr int lanes = 4;
constexpr double width = 3.5;

/// Cars on the middles of the lanes of a straight road, none in another; the first one looks.
template <class Observer>
World<Observer> traffic(std::uint64_t seed, Observer const& observer) {
  World<Observer> world(straight_road(lanes, 600.0), {.seed = seed});
  cb::RandomStream random(seed, 0, 0);
  for (int lane = 0; lane < lanes; ++lane)
    for (double x = 20.0 + 20.0 * cb::uniform01(random); x < 580.0; x += 8.0 + 50.0 * cb::uniform01(random))
      world.add({.position = {x, -width * (lane + 0.5)}, .speed = 5.0 + x / 100.0, .observer = observer});
  return world;
}

/// The next one ahead (`sign` 1) or behind (-1) of `own` of those seen to reach into the lane with middle `y`.
template <class View, class States>
std::optional<cb::AgentId> next_seen(View const& view, States const& truth, double own, double y, int sign) {
  std::optional<cb::AgentId> best;
  double smallest = std::numeric_limits<double>::infinity();
  view.around(1000.0, [&](cb::RoadUser const& other) {
    auto const seen = view.state(other);
    double const way = sign * (truth(other.agent).x - own), body = 0.9;  // half a car's width
    if (!(way > 0.0) || way > 300.0 || way >= smallest) return;
    if (std::abs(seen.y - y) >= width / 2 + body) return;
    smallest = way;
    best = other.agent;
  });
  return best;
}

}  // namespace

TEST_CASE("others are found in the lanes where they are seen, and only there") {
  int moved = 0, compared = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    cb::ParametricObserver const observer{.others = {.across = 1.6}};
    auto world = traffic(seed, observer);
    auto exact = traffic(seed, cb::PerfectObserver{});
    for (std::size_t i = 0; i < world.size(); i += 5) {
      auto const slot = static_cast<cb::Slot>(i);
      auto const view = world.observe(slot);
      auto const truly = exact.observe(slot);
      auto const truth = [&](cb::AgentId id) { return world.state(id); };
      double const own = view.state().x;
      auto const& corridors = view.road().corridors;
      for (cb::CorridorId c{}; index_of(c) < corridors.size(); ++c) {
        auto const place = view.place(c);
        double const y = corridors[c].center.pose(place.s).y;
        for (int const sign : {1, -1}) {
          auto const found = sign > 0 ? view.ahead(place) : view.behind(place);
          auto const expected = next_seen(view, truth, own, y, sign);
          INFO("seed ", seed, ", observer ", i, ", lane at y = ", y, ", sign ", sign);
          ++compared;
          REQUIRE(found.has_value() == expected.has_value());
          if (!found) continue;
          CHECK(found->agent == *expected);
          auto const car = cb::geometry::car();
          double const way = sign * (truth(*expected).x - own);
          CHECK(found->gap == doctest::Approx(way - car.front - car.rear).epsilon(1e-9));
          CHECK(found->speed == doctest::Approx(truth(*expected).speed).epsilon(1e-9));
          CHECK(found->s == doctest::Approx(place.s + sign * way).epsilon(1e-9));
          auto const before = sign > 0 ? truly.ahead(place) : truly.behind(place);
          moved += !before || before->agent != found->agent;
        }
        if (c != view.place().corridor) continue;
        auto const ahead = view.ahead(), behind = view.behind();
        CHECK(ahead.has_value() == view.ahead(place).has_value());
        if (ahead) CHECK(ahead->agent == view.ahead(place)->agent);
        if (behind) CHECK(behind->agent == view.behind(place)->agent);
        std::optional<cb::RoadUser> first;
        view.each_ahead({}, [&](cb::RoadUser const& user) {
          if (!first || user.gap < first->gap) first = user;
        });
        CHECK(first.has_value() == ahead.has_value());
        if (first) CHECK(first->agent == ahead->agent);
      }
    }
  }
  CHECK(compared > 2000);
  CHECK(moved > compared / 4);
}

TEST_CASE("an observer that errs along the lane only finds whom a perfect one finds") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    auto world = traffic(seed, cb::ParametricObserver{.others = {.mean_along = 0.7}});
    auto exact = traffic(seed, cb::PerfectObserver{});
    for (cb::Slot slot{}; index_of(slot) < world.size(); ++slot) {
      auto const found = world.observe(slot).ahead(), truth = exact.observe(slot).ahead();
      REQUIRE(found.has_value() == truth.has_value());
      if (found) CHECK(found->agent == truth->agent);
      if (found) CHECK(found->gap == doctest::Approx(truth->gap + 0.7));
    }
  }
}

TEST_CASE("a late observer finds an agent that has just changed lanes in its old lane") {
  World<cb::DelayedObserver<2>> world(straight_road(2, 600.0));
  auto const ego = world.add({.position = {50, -1.75}, .speed = 10.0, .observer = {.others = 2}});
  auto const other = world.add({.position = {100, -1.75}, .speed = 10.0});
  for (int k = 0; k < 5; ++k) REQUIRE(world.step(0.2));
  auto state = world.state(other);
  state.y = -5.25;
  world.set_state(other, state);
  auto const finds = [&] { return world.observe(ego).ahead().has_value(); };
  CHECK(finds());
  REQUIRE(world.step(0.2));
  CHECK(finds());
  REQUIRE(world.step(0.2));
  CHECK_FALSE(finds());
}

TEST_CASE("a prediction begins with the others in the lanes where they are seen, the observer in its own") {
  int moved = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    auto world = traffic(seed, cb::ParametricObserver{.own = {.across = 1.6}, .others = {.across = 1.6}});
    auto const prediction = cb::predict_all_as<cb::BehaviorSet<cb::ConstantAcceleration>>(cb::ConstantAcceleration{});
    auto const predicted = world.observe(cb::Slot{}).predict(prediction);
    for (cb::Slot slot{}; index_of(slot) < world.size(); ++slot) {
      auto const& record = predicted.frame().agents[slot];
      auto const& truth = world.frame().agents[slot];
      double const middle = predicted.roster().agents[slot].road->corridors[record.lane.corridor].center.pose(100.0).y;
      bool const is_own = index_of(slot) == 0;
      double const y = is_own ? truth.state.y : std::clamp(record.state.y, -width * lanes + 0.01, -0.01);
      CHECK(std::abs(y - middle) < width / 2);
      CHECK(record.lane.lateral == doctest::Approx(record.state.y - middle).epsilon(1e-9));
      moved += record.lane.corridor != truth.lane.corridor;
    }
  }
  CHECK(moved > 50);
}
