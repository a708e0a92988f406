#include "cambium/tracking/predicted_modes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "../support/maps.hpp"
#include "cambium/core/error.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/tracking/tracker.hpp"
#include "objects.hpp"

namespace cb = cambium;
using objects::cycle, objects::not_a_number, objects::object, objects::system_clock;

namespace {

/// A tracker of objects that have moved straight on for a second, and what it predicts.
struct Predicted {
  std::shared_ptr<cb::Map const> map;
  cb::Tracker<> tracker{map};
  std::vector<cb::PredictedState> states = std::vector<cb::PredictedState>(100'000);
  cb::PredictedModes modes;

  Predicted(std::shared_ptr<cb::Map const> on, std::vector<cb::TrackedObject> seen) : map(std::move(on)) {
    for (int i = -9; i <= 0; ++i) {
      auto list = seen;
      for (auto& o : list) {
        o.x += 0.1 * i * o.vx;
        o.y += 0.1 * i * o.vy;
      }
      tracker.update(system_clock + i * cycle, list);
    }
  }

  auto& with(cb::PredictionRequest const& request) {
    modes = tracker.predict(request, states);
    return *this;
  }
  [[nodiscard]] cb::PredictedState const& state(std::size_t mode, std::size_t object, std::size_t step) const {
    return states[modes.at(mode, object, step)];
  }
  [[nodiscard]] cb::PredictedState const& end(std::size_t mode, std::size_t object) const {
    return state(mode, object, modes.steps - 1);
  }
  /// The mode of an object that has this maneuver; nothing if there is none.
  [[nodiscard]] std::optional<std::size_t> find(std::size_t object, cb::Maneuver maneuver) const {
    for (std::size_t m = 0; m < modes.modes.size() / modes.objects.size(); ++m)
      if (modes.mode(m, object).maneuver == maneuver) return m;
    return std::nullopt;
  }
};

double distance(cb::PredictedState const& a, cb::PredictedState const& b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace

TEST_CASE("the modes of a car before a junction lead along each of its ways") {
  Predicted predicted(support::own_map("intersection_4way.xodr"), {object(1, -30.0, -1.75, 0.0, 8.0)});
  predicted.with({.steps = 50, .modes = 6});
  double sum = 0.0;
  std::vector<cb::LaneId> lanes;
  for (std::size_t m = 0; m < 6; ++m) {
    auto const& mode = predicted.modes.mode(m, 0);
    sum += mode.probability;
    if (m > 0) CHECK(mode.probability <= predicted.modes.mode(m - 1, 0).probability);
    if (mode.maneuver != cb::Maneuver::as_expected) continue;
    CHECK(std::find(lanes.begin(), lanes.end(), mode.lane) == lanes.end());
    lanes.push_back(mode.lane);
    CHECK(predicted.map->lane(mode.lane).drivable());
    for (std::size_t k = 1; k < 50; ++k) CHECK(distance(predicted.state(m, 0, k - 1), predicted.state(m, 0, k)) < 1.0);
  }
  CHECK(lanes.size() >= 2);
  CHECK(sum == doctest::Approx(1.0));
}

TEST_CASE("the most probable mode is what the tracker's world does") {
  Predicted predicted(support::own_map("roundabout.xodr"),
                      {object(1, -60.0, -1.75, 0.0, 9.0), object(2, -45.0, -1.75, 0.0, 7.0)});
  predicted.with({.steps = 30});
  auto world = predicted.tracker.world();
  for (std::size_t k = 0; k < 30; ++k) {
    REQUIRE(world.step(0.1));
    for (std::size_t i = 0; i < 2; ++i) {
      auto const id = *predicted.tracker.agent_of(predicted.modes.objects[i]);
      auto const center = cb::geometry::to_map({world.state(id).x, world.state(id).y, world.state(id).heading},
                                               {world.roster().agents[world.slot_of(id)].shape.center_offset(), 0.0});
      CHECK(std::hypot(predicted.state(0, i, k).x - center.x(), predicted.state(0, i, k).y - center.y()) < 0.2);
    }
  }
}

TEST_CASE("joint modes are the most probable combinations, each with one probability") {
  Predicted predicted(support::own_map("intersection_4way.xodr"),
                      {object(1, -30.0, -1.75, 0.0, 8.0), object(2, 30.0, 1.75, cb::geometry::pi, 8.0)});
  predicted.with({.modes = 5, .joint = true});
  double sum = 0.0;
  for (std::size_t m = 0; m < 5; ++m) {
    auto const& first = predicted.modes.mode(m, 0);
    CHECK(first.probability == predicted.modes.mode(m, 1).probability);
    sum += first.probability;
    if (m == 0) continue;
    CHECK(first.probability <= predicted.modes.mode(m - 1, 0).probability);
    CHECK(std::max(distance(predicted.end(m, 0), predicted.end(m - 1, 0)),
                   distance(predicted.end(m, 1), predicted.end(m - 1, 1))) > 1e-6);
  }
  CHECK(sum == doctest::Approx(1.0));
  INFO("by brute force: of three options each, the products in descending order");
  std::vector<std::vector<cb::detail::Option>> objects(4);
  for (std::size_t i = 0; i < 4; ++i)
    objects[i] = {{.probability = 0.5 + 0.05 * static_cast<double>(i)},
                  {.probability = 0.3 - 0.06 * static_cast<double>(i)},
                  {.probability = 0.2 + 0.01 * static_cast<double>(i)}};
  for (auto& options : objects)
    std::sort(options.begin(), options.end(),
              [](auto const& a, auto const& b) { return a.probability > b.probability; });
  std::vector<double> products;
  for (std::size_t number = 0; number < 81; ++number) {
    double product = 1.0;
    for (std::size_t i = 0, left = number; i < 4; ++i, left /= 3)
      product *= objects[i][left % 3].probability / objects[i][0].probability;
    products.push_back(product);
  }
  std::sort(products.rbegin(), products.rend());
  cb::detail::Combinations combinations;
  combinations.find(objects, 20);
  REQUIRE(combinations.odds.size() == 20);
  for (std::size_t m = 0; m < 20; ++m) CHECK(combinations.odds[m] == doctest::Approx(products[m]));
}

TEST_CASE("a host's trajectory is returned as it was given, others heed it, and it goes on where it ends") {
  auto const highway = support::own_map("highway.xodr");
  std::vector<cb::PredictedState> brakes;  // from 20 m/s to 4 m/s within 2 s
  double x = 130.0;
  for (int k = 1; k <= 20; ++k) {
    double const speed = 20.0 - 0.8 * k;
    x += 0.1 * (speed + 0.4);
    brakes.push_back({x, -1.75, 0.0, speed});
  }
  std::vector const seen{object(1, 100.0, -1.75, 0.0, 20.0), object(2, 130.0, -1.75, 0.0, 20.0)};
  Predicted free(highway, seen), held(highway, seen);
  free.with({.steps = 50});
  cb::GivenTrajectory const given{.key = {0, 2}, .states = brakes};
  held.with({.steps = 50, .given = {&given, 1}});
  CHECK(held.modes.mode(0, 1).maneuver == cb::Maneuver::given);
  for (std::size_t k = 0; k < 20; ++k) CHECK(held.state(0, 1, k) == brakes[k]);
  {
    INFO("it does not vanish: it drives on from where it was, as fast as it was");
    CHECK(held.state(0, 1, 20).x - brakes.back().x == doctest::Approx(0.4).epsilon(0.3));
    CHECK(held.end(0, 1).x > brakes.back().x + 8.0);
    CHECK(std::abs(held.end(0, 1).y + 1.875) < 0.05);
  }
  {
    INFO("the one behind brakes for it, also after its end");
    CHECK(held.end(0, 0).x < held.end(0, 1).x - 4.5);
    CHECK(free.end(0, 0).x > held.end(0, 0).x + 10.0);
  }
  {
    INFO("headings and speeds that are not given are those of the positions; it ends where a position is no number");
    auto positions = brakes;
    for (auto& state : positions) state.heading = state.speed = not_a_number;
    positions[10].x = not_a_number;
    cb::GivenTrajectory const only_positions{.key = {0, 2}, .states = positions};
    held.with({.steps = 50, .given = {&only_positions, 1}});
    CHECK(held.state(0, 1, 5).speed == doctest::Approx(brakes[5].speed).epsilon(0.05));
    CHECK(held.state(0, 1, 5).heading == doctest::Approx(0.0));
    CHECK(held.state(0, 1, 10).x == doctest::Approx(brakes[9].x + 1.2).epsilon(0.1));
    for (std::size_t k = 0; k < 50; ++k) CHECK(std::isfinite(held.state(0, 1, k).x));
  }
  {
    INFO("several of one object are its modes; those of objects that are not tracked are nobody's");
    std::vector<cb::PredictedState> const leaves{{131.3, -3.0, -0.9, 18.0}, {132.4, -4.4, -0.95, 18.0}};
    std::vector<cb::GivenTrajectory> const several{{.key = {0, 2}, .states = brakes, .probability = 1.0},
                                                   {.key = {0, 2}, .states = leaves, .probability = 3.0},
                                                   {.key = {0, 9}, .states = brakes},
                                                   {.key = {0, 1}, .states = {}}};
    held.with({.steps = 30, .modes = 3, .given = several});
    CHECK(held.modes.mode(0, 1).probability == doctest::Approx(0.75));
    CHECK(held.modes.mode(1, 1).probability == doctest::Approx(0.25));
    CHECK(held.modes.mode(2, 1).maneuver == cb::Maneuver::none);
    CHECK(held.modes.mode(2, 1).probability == 0.0);
    CHECK(held.modes.mode(0, 0).maneuver == cb::Maneuver::as_expected);
    CHECK(held.state(0, 1, 1) == leaves[1]);
    CHECK(held.end(0, 1).y < -15.0);
    CHECK(held.modes.mode(0, 1).lane == cb::none<cb::LaneId>);
  }
}

TEST_CASE("one that brakes may brake on to a standstill, one that stands may start") {
  auto braking = object(1, 100.0, -1.75, 0.0, 16.0);
  braking.acceleration = -4.0;
  Predicted predicted(support::own_map("highway.xodr"), {braking, object(2, 300.0, -1.75, 0.0, 0.0)});
  predicted.with({.steps = 60, .modes = 6});
  auto const brakes_on = predicted.find(0, cb::Maneuver::brakes_on), starts = predicted.find(1, cb::Maneuver::starts);
  REQUIRE(brakes_on);
  REQUIRE(starts);
  CHECK(predicted.end(*brakes_on, 0).speed == 0.0);
  CHECK(predicted.end(*brakes_on, 0).x == doctest::Approx(100.0 + 32.0).epsilon(0.02));
  CHECK(predicted.end(0, 0).speed > 5.0);
  CHECK(predicted.end(*starts, 1).x > 310.0);
  CHECK(predicted.end(0, 1).x == doctest::Approx(300.0));
}

TEST_CASE("one that has to yield may go first, and may change lanes") {
  auto const map = support::own_map("intersection_3way.xodr");
  auto const& side_road = map->lane(map->find_lane("3", 5.0, -1)).path;
  auto const side = side_road.pose(side_road.length() - 25.0);
  Predicted predicted(map, {object(1, -50.0, -1.6, 0.0, 10.0), object(2, side.x, side.y, side.heading, 8.0)});
  predicted.with({.steps = 50, .modes = 8});
  CHECK_FALSE(predicted.find(0, cb::Maneuver::goes_first));  // it does so anyway
  auto const goes_first = predicted.find(1, cb::Maneuver::goes_first);
  REQUIRE(goes_first);
  CHECK(distance(predicted.end(*goes_first, 1), {side.x, side.y}) >
        distance(predicted.end(0, 1), {side.x, side.y}) + 5.0);
  Predicted lanes(support::own_map("highway.xodr"), {object(1, 100.0, -1.75, 0.0, 20.0)});
  lanes.with({.steps = 60, .modes = 6});
  auto const changes = lanes.find(0, cb::Maneuver::changes_right);
  REQUIRE(changes);
  CHECK(lanes.end(*changes, 0).y == doctest::Approx(-5.625).epsilon(0.05));
  CHECK(lanes.end(0, 0).y == doctest::Approx(-1.875).epsilon(0.05));
  CHECK_FALSE(lanes.find(0, cb::Maneuver::changes_left));
}

TEST_CASE("the caller chooses objects, and a behaviour for some of them") {
  Predicted predicted(support::own_map("highway.xodr"),
                      {object(1, 100.0, -1.75, 0.0, 20.0), object(2, 150.0, -1.75, 0.0, 20.0)});
  cb::ObjectKey const keys[] = {{0, 2}, {0, 7}};
  predicted.with({.objects = keys});
  CHECK(predicted.modes.objects.size() == 2);
  CHECK(predicted.end(0, 0).x > 200.0);
  CHECK(predicted.end(0, 1) == cb::PredictedState{});
  CHECK(predicted.modes.mode(0, 1).maneuver == cb::Maneuver::none);
  using Behavior = cb::TrackedWorld::Behavior;
  auto const stops = [](cb::ObjectKey const& key, cb::PredictedMode const&) {
    cb::UrbanDriver slow;
    slow.law.desired_speed = 5.0;
    return key == cb::ObjectKey{0, 2} ? std::optional<Behavior>(slow) : std::nullopt;
  };
  auto const before = predicted.end(0, 0);
  predicted.modes = predicted.tracker.predict({.objects = keys}, predicted.states, stops);
  CHECK(predicted.end(0, 0).x < before.x - 5.0);
}

TEST_CASE("predictions change nothing, and are the same each time, whatever the array held") {
  Predicted predicted(support::own_map("intersection_4way.xodr"),
                      {object(1, -30.0, -1.75, 0.0, 8.0), object(2, 1.75, -30.0, 0.5 * cb::geometry::pi, 8.0)});
  auto const frame = predicted.tracker.world().frame();
  auto const first = predicted.with({.modes = 4}).states;
  std::fill(predicted.states.begin(), predicted.states.end(), cb::PredictedState{not_a_number, 1.0, 2.0, 3.0});
  auto const needed = static_cast<std::ptrdiff_t>(4 * 2 * 30);
  predicted.with({.modes = 4});
  CHECK(std::equal(first.begin(), first.begin() + needed, predicted.states.begin()));
  CHECK(predicted.tracker.world().frame() == frame);
}

TEST_CASE("who does not drive is not made to, where a trajectory of the host ends") {
  auto const crossing = support::own_map("intersection_4way.xodr");
  auto walks = object(1, -60.0, -6.8, 0.0, 1.4), parked = object(2, -60.0, -1.75, 0.0, 0.0);
  walks.kind = cb::ObjectClass::pedestrian;
  parked.is_parked = true;
  Predicted predicted(crossing, {walks, parked});
  std::vector<cb::PredictedState> on, stays(5, {-60.0, -1.75, 0.0, 0.0});
  for (int k = 1; k <= 10; ++k) on.push_back({-60.0 + 0.14 * k, -6.8, 0.0, 1.4});
  std::vector<cb::GivenTrajectory> const given{{.key = {0, 1}, .states = on}, {.key = {0, 2}, .states = stays}};
  predicted.with({.steps = 60, .given = given});
  CHECK(predicted.end(0, 0).x == doctest::Approx(-60.0 + 0.14 * 60).epsilon(0.02));
  CHECK(predicted.end(0, 1).x == doctest::Approx(-60.0));
}

TEST_CASE("a chosen driver carries out the maneuver, and another model goes on as measured") {
  auto turning = object(1, 100.0, -1.875, 0.0, 20.0), off = object(2, 60.0, -60.0, 0.3, 8.0);
  off.yaw_rate = 0.4;
  Predicted predicted(support::own_map("highway.xodr"), {turning, off});
  auto const as = [&](auto const& behavior) {
    return [&](cb::ObjectKey const&, cb::PredictedMode const&) {
      return std::optional<cb::TrackedWorld::Behavior>(behavior);
    };
  };
  predicted.with({.steps = 60, .modes = 3});
  auto const off_lanes = predicted.end(0, 1);
  cb::UrbanDriver slow;
  slow.law.desired_speed = 15.0;
  predicted.modes = predicted.tracker.predict({.steps = 60, .modes = 3}, predicted.states, as(slow));
  auto const changes = predicted.find(0, cb::Maneuver::changes_right);
  REQUIRE(changes);
  CHECK(predicted.end(*changes, 0).y == doctest::Approx(-5.625).epsilon(0.05));
  CHECK(predicted.end(*changes, 0).speed < 16.5);
  CHECK(predicted.end(0, 1) == off_lanes);  // a driver has nowhere to drive there
  predicted.modes = predicted.tracker.predict({.steps = 60}, predicted.states, as(cb::ConstantTurn{}));
  CHECK(predicted.end(0, 1) == off_lanes);
}

TEST_CASE("long steps change little, also behind a trajectory of the host's") {
  Predicted predicted(support::own_map("intersection_3way.xodr"),
                      {object(1, -130.0, -1.6, 0.0, 20.0), object(2, -95.0, -1.6, 0.0, 20.0)});
  auto const end_at = [&](double step) {
    std::vector<cb::PredictedState> brakes;  // by 4 m/s^2, to a standstill after 5 s
    for (int k = 1; k * step < 5.001; ++k) {
      double const t = k * step;
      brakes.push_back({-95.0 + 20.0 * t - 2.0 * t * t, -1.6, 0.0, 20.0 - 4.0 * t});
    }
    cb::GivenTrajectory const given{.key = {0, 2}, .states = brakes};
    predicted.with({.steps = brakes.size(), .step = step, .given = {&given, 1}});
    CHECK(predicted.end(0, 1) == brakes.back());
    return predicted.end(0, 0).x;
  };
  double const fine = end_at(0.02);
  CHECK(fine < -45.0 - 4.5);
  CHECK(fine > -45.0 - 25.0);
  for (double const step : {0.1, 0.25, 0.5, 1.0}) CHECK(std::abs(end_at(step) - fine) < 1.5);
}

TEST_CASE("a vehicle that reverses by positions alone keeps its heading") {
  Predicted predicted(support::own_map("highway.xodr"), {object(1, 100.0, -1.875, 0.0, 0.0)});
  std::vector<cb::PredictedState> back;
  for (int k = 1; k <= 10; ++k) back.push_back({100.0 - 0.1 * k, -1.875, not_a_number, not_a_number});
  cb::GivenTrajectory const given{.key = {0, 1}, .states = back};
  predicted.with({.given = {&given, 1}});
  for (std::size_t k = 0; k < 30; ++k) {
    CHECK(std::abs(predicted.state(0, 0, k).heading) < 1e-6);
    CHECK(predicted.state(0, 0, k).speed == doctest::Approx(-1.0));
  }
  CHECK(predicted.end(0, 0).x == doctest::Approx(97.0).epsilon(0.001));
}

TEST_CASE("states are those of the point that the host gives; the last result may be asked for again") {
  auto rear = object(1, 100.0, -1.875, 0.0, 20.0);
  rear.point = cb::ObjectPoint::rear_axle;
  Predicted predicted(support::own_map("highway.xodr"), {rear, object(2, 100.0, -5.625, 0.0, 20.0)});
  predicted.with({});
  CHECK(predicted.state(0, 0, 0).x == doctest::Approx(102.0).epsilon(0.001));
  CHECK(predicted.state(0, 1, 0).x == doctest::Approx(102.0).epsilon(0.001));
  auto const first = predicted.end(0, 1);
  predicted.with({.objects = predicted.modes.objects});
  CHECK(predicted.modes.objects.size() == 2);
  CHECK(predicted.end(0, 1) == first);
  cb::Tracker<> none(predicted.map);
  CHECK(none.predict({}, {}).objects.empty());
}

TEST_CASE("an agent that comes to the end of its road goes on") {
  auto const map = support::own_map("merging.xodr");
  double const end = map->bounds().max_x;
  Predicted predicted(map, {object(1, end - 30.0, -1.75, 0.0, 20.0)});
  predicted.with({.steps = 40});
  CHECK(predicted.end(0, 0).x > end + 30.0);
}

TEST_CASE("a request that cannot be answered is an error that says what to give") {
  Predicted predicted(support::own_map("highway.xodr"), {object(1, 100.0, -1.75, 0.0, 20.0)});
  std::vector<cb::PredictedState> states(60);
  auto const message = [&](cb::PredictionRequest const& request) {
    try {
      predicted.tracker.predict(request, states);
    } catch (cb::ParameterError const& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(message({.modes = 2}).empty());
  CHECK(message({.modes = 3}).find("there is room for 60 of 90") != std::string::npos);
  for (auto const& bad : {cb::PredictionRequest{.steps = 0},
                          {.step = 1e-300},
                          {.step = not_a_number},
                          {.modes = 0},
                          {.modes = std::numeric_limits<std::size_t>::max()}})
    CHECK(message(bad).find("PredictionRequest.") != std::string::npos);
}

TEST_CASE("a map that is prepared has all roads at once") {
  auto const map = support::own_map("intersection_4way.xodr");
  auto const held = map->prepare(map->bounds());
  for (auto const& lane : map->lanes()) {
    if (!lane.drivable()) continue;
    auto const ahead = cb::map::roads_ahead(*map, lane.id);
    REQUIRE_FALSE(ahead.empty());
    for (auto const& road : ahead) {
      CHECK(road->route.front() == lane.id);
      CHECK(std::find(held.begin(), held.end(), road) != held.end());
    }
    auto const straight = cb::map::build_road_corridor(*map, cb::map::straight_route(*map, lane.id));
    CHECK(std::find(held.begin(), held.end(), straight) != held.end());
  }
  auto const forks = map->nearest_lane({-60.0, -1.75, 0.0})->lane;
  CHECK(cb::map::roads_ahead(*map, forks).size() >= 2);
  CHECK_THROWS_AS((void)cb::map::roads_ahead(*map, cb::none<cb::LaneId>), cb::MapError);
}
