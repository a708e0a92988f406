#include "cambium/predictor.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "../support/corpus.hpp"
#include "../support/error_of.hpp"
#include "cambium/cambium.h"
#include "objects.hpp"

namespace cb = cambium;
using objects::cycle, objects::not_a_number, objects::system_clock;

namespace {

std::string own_map(char const* name) { return std::string(CAMBIUM_SOURCE_DIR) + "/maps/" + name; }

/// A car in the lane, one that goes the wrong way, and one that is nowhere, at cycle `i`.
std::vector<cb::TrackedObject> list_at(int i) {
  return {{.key = cb::key_of("car"), .x = 100.0 + 2.0 * i, .y = -1.875, .heading = 0.0, .vx = 20.0},
          {.key = cb::key_of("ghost rider"), .x = 300.0 - i, .y = -5.6, .heading = 3.1416, .vx = -10.0},
          {.key = cb::key_of("nowhere"), .x = not_a_number}};
}

}  // namespace

TEST_CASE("the predictor behind the firewall tracks and predicts") {
  cb::Predictor predictor(own_map("highway.xodr"), {.keep_unseen = 0.5});
  CHECK(predictor.map_warnings().empty());
  predictor.prepare(100.0, 0.0, 300.0);
  std::vector<cb::Verdict> verdicts;
  for (int i = 0; i < 10; ++i) {
    auto const now = predictor.update(system_clock + i * cycle, list_at(i));
    verdicts.assign(now.begin(), now.end());
  }
  REQUIRE(verdicts.size() == 3);
  CHECK(verdicts[0].motion == cb::ObjectMotion::follows_lane);
  CHECK(verdicts[1].motion == cb::ObjectMotion::wrong_way);
  CHECK(verdicts[2].refusal == cb::Refusal::not_finite);
  REQUIRE(predictor.objects().size() == 2);
  CHECK(predictor.objects()[0] == cb::key_of("car"));

  std::vector<cb::PredictedState> states(2 * 30);
  auto const end = [&](std::size_t object) { return states[object * 30 + 29]; };
  CHECK(predictor.predict({}, states).mode(0, 0).maneuver == cb::Maneuver::as_expected);
  CHECK(end(0).x == doctest::Approx(178.0).epsilon(0.01));
  CHECK(end(1).x == doctest::Approx(261.0).epsilon(0.02));
  CHECK(std::abs(cb::PredictedState(end(1)).heading) == doctest::Approx(3.1416).epsilon(0.01));

  INFO("what drives an object may be chosen");
  auto const choose = [](cb::ObjectModel const& model) {
    return [model](cb::ObjectKey const& key, cb::PredictedMode const&) {
      return key == cb::key_of("car") ? std::optional(model) : std::nullopt;
    };
  };
  predictor.predict({}, states, choose({.desired_speed = 10.0}));
  CHECK(end(0).x < 172.0);
  predictor.predict({}, states, choose({.desired_speed = not_a_number, .time_headway = -3.0}));
  CHECK(end(0).x == doctest::Approx(178.0).epsilon(0.01));
  states.resize(2 * 150);
  auto const y_with = [&](cb::ObjectModel const& model) {  // where the motorway has bent
    predictor.predict({.steps = 150}, states, choose(model));
    return states[149].y;
  };
  double const bent = y_with({});
  CHECK(std::abs(bent - y_with({.time_headway = 0.8})) < 0.5);
  CHECK(std::abs(bent - y_with({.on_lanes = false})) > 1.5);
}

TEST_CASE("a chosen driver may heed nobody at junctions") {
  cb::Predictor predictor(own_map("intersection_3way.xodr"));
  std::vector<cb::TrackedObject> const list{
      {.key = {0, 1}, .x = -45.0, .y = -1.6, .heading = 0.0, .vx = 10.0},
      {.key = {0, 2}, .x = 0.4, .y = -38.0, .heading = 1.5, .vx = 0.5, .vy = 7.0}};
  predictor.update(system_clock, list);
  std::vector<cb::PredictedState> states(2 * 40);
  predictor.predict({.steps = 40}, states);
  double const waits = states[79].y;
  predictor.predict({.steps = 40}, states,
                    [](cb::ObjectKey const&, cb::PredictedMode const&) { return cb::ObjectModel{.gives_way = false}; });
  CHECK(states[79].y > waits + 3.0);
}

TEST_CASE("whatever a sensor sends, a choice for it does not throw") {
  cb::Predictor predictor(own_map("highway.xodr"));
  std::vector<cb::PredictedState> states(30);
  for (double const speed : {0.0, 85.0, 140.0, -3.0}) {
    for (int i = 0; i < 5; ++i)
      predictor.update(system_clock + (100 * static_cast<int>(speed) + i) * cycle,
                       std::vector<cb::TrackedObject>{{.key = cb::key_of("car"),
                                                       .x = 100.0 + 0.1 * i * speed,
                                                       .y = -1.875,
                                                       .heading = 0.0,
                                                       .vx = speed,
                                                       .acceleration = 9.0}});
    predictor.predict({}, states, [](cb::ObjectKey const&, cb::PredictedMode const&) { return cb::ObjectModel{}; });
    for (auto const& state : states) CHECK(std::isfinite(state.x + state.speed));
  }
}

TEST_CASE("a light that is red holds those who come") {
  cb::Predictor predictor(own_map("intersection_4way.xodr"));
  auto const end_with = [&](cb::map::LightColor color, std::int64_t at, double x = -35.0) {
    for (auto const* light : {"east-west", "north-south"}) predictor.set_light(light, color);
    predictor.update(system_clock + at * cycle,
                     std::vector<cb::TrackedObject>{{.key = {0, 1}, .x = x, .y = -1.75, .heading = 0.0, .vx = 10.0}});
    std::vector<cb::PredictedState> states(60);
    predictor.predict({.steps = 60}, states);
    return states.back();
  };
  using cb::map::LightColor;
  CHECK(end_with(LightColor::red, 1).speed < 0.5);
  CHECK(end_with(LightColor::green, 2).speed > 4.0);
  CHECK(end_with(LightColor::off, 3).speed > 4.0);
  for (int i = 4; i < 14; ++i) end_with(LightColor::yellow, i, -60.0);
  CHECK(end_with(LightColor::yellow, 14, -60.0).speed < 0.5);  // it has been so for a second
  support::says("no such light", [&] { return predictor.set_light("no such light", LightColor::red), 0; });
}

TEST_CASE("the predictor says what is wrong with a map, an option or a place") {
  support::says("^no/such.xodr", [] { return cb::Predictor("no/such.xodr"); });
  support::says("origin", [] { return cb::Predictor(own_map("highway.xodr"), {}, cb::map::Lanelet2Origin{}); });
  support::says("there is no map", [] { return cb::Predictor(std::shared_ptr<cb::map::Map const>()); });
  support::says("existence", [] { return cb::Predictor(own_map("highway.xodr"), {.existence = 2.0}); });
  cb::Predictor predictor(own_map("highway.xodr"));
  support::says("prepare", [&] { return predictor.prepare(not_a_number, 0.0, 10.0), 0; });
}

TEST_CASE("the predictor reads maps of other kinds, too") {
  if (auto const file = corpus::find("lanelet2/mapping_example.osm")) {
    cb::Predictor const predictor(file->string(), {}, cb::map::Lanelet2Origin{49.0, 8.4});
    CHECK(predictor.map() != nullptr);
  }
  if (auto const file = corpus::find("scenarios/commonroad/ZAM_Tutorial-1_2_T-1.xml"))
    CHECK(cb::Predictor(file->string()).map() != nullptr);
}

TEST_CASE("C sees the same as C++, and an error for what it must not do") {
  cb::Predictor predictor(own_map("highway.xodr"));
  auto* const c = cambium_open(own_map("highway.xodr").c_str(), nullptr);
  REQUIRE(c != nullptr);
  std::vector<cambium_verdict> seen(3);
  for (int i = 0; i < 10; ++i) {
    auto const list = list_at(i);
    std::vector<cambium_object> objects;
    for (auto const& o : list) {
      objects.push_back(cambium_object_default());
      auto& object = objects.back();
      object.key = {o.key.high, o.key.low};
      object.x = o.x;
      object.y = o.y;
      object.heading = o.heading;
      object.vx = o.vx;
    }
    auto const verdicts = predictor.update(system_clock + i * cycle, list);
    REQUIRE(cambium_update(c, system_clock + i * cycle, objects.data(), objects.size(), seen.data()) == 1);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(cambium_motion_name(seen[k].motion) == std::string(to_string(verdicts[k].motion)));
      CHECK(cambium_refusal_name(seen[k].refusal) == std::string(to_string(verdicts[k].refusal)));
      CHECK(seen[k].lane == static_cast<std::uint32_t>(verdicts[k].lane));
    }
  }
  std::vector<cambium_key> keys(1);
  CHECK(cambium_objects(c, keys.data(), keys.size()) == 2);
  CHECK(keys[0].low == cambium_key_of("car").low);

  std::vector<cb::PredictedState> const brakes{{120.0, -1.875, 0.0, 15.0}, {121.0, -1.875, 0.0, 10.0}};
  std::vector<cambium_state> const brakes_in_c{{120.0, -1.875, 0.0, 15.0}, {121.0, -1.875, 0.0, 10.0}};
  cb::GivenTrajectory const given{.key = cb::key_of("car"), .states = brakes};
  cambium_trajectory const given_in_c{cambium_key_of("car"), brakes_in_c.data(), 2, 1.0};
  std::vector<cb::PredictedState> states(3 * 2 * 20);
  auto const modes = predictor.predict({.steps = 20, .step = 0.2, .modes = 3, .given = {&given, 1}}, states);
  auto request = cambium_request_default();
  request.steps = 20;
  request.step = 0.2;
  request.modes = 3;
  request.given = &given_in_c;
  request.given_count = 1;
  std::vector<cambium_state> states_in_c(states.size());
  std::vector<cambium_mode> modes_in_c(6);
  REQUIRE(cambium_predict(c, &request, states_in_c.data(), states_in_c.size(), modes_in_c.data(), 6) == 1);
  for (std::size_t i = 0; i < states.size(); ++i) {
    CHECK(states_in_c[i].x == states[i].x);
    CHECK(states_in_c[i].speed == states[i].speed);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(modes_in_c[i].probability == modes.modes[i].probability);
    CHECK(cambium_maneuver_name(modes_in_c[i].maneuver) == std::string(to_string(modes.modes[i].maneuver)));
  }

  auto const fails = [](int result, char const* reason) {
    CHECK(result == 0);
    CAPTURE(cambium_error());
    CHECK(std::string(cambium_error()).find(reason) != std::string::npos);
  };
  fails(cambium_predict(c, &request, states_in_c.data(), 7, modes_in_c.data(), 6), "room for 7 of 120");
  fails(cambium_predict(c, &request, states_in_c.data(), 120, modes_in_c.data(), 5), "modes");
  request.steps = std::numeric_limits<std::size_t>::max();
  fails(cambium_predict(c, &request, states_in_c.data(), 120, modes_in_c.data(), 6), "PredictionRequest.steps");
  fails(cambium_predict(c, nullptr, nullptr, 0, nullptr, 0), "null");
  fails(cambium_update(nullptr, 0, nullptr, 0, nullptr), "null");
  auto* const empty = cambium_open(own_map("highway.xodr").c_str(), nullptr);
  auto const usual = cambium_request_default();
  CHECK(cambium_predict(empty, &usual, nullptr, 0, nullptr, 0) == 1);
  cambium_close(empty);
  fails(cambium_set_light(c, "1", 9), "colour");
  fails(cambium_prepare(c, not_a_number, 0.0, 1.0), "prepare");
  CHECK(cambium_open("no/such.xodr", nullptr) == nullptr);
  CHECK(cambium_open(nullptr, nullptr) == nullptr);
  CHECK(std::string(cambium_motion_name(-1)) == "no motion of this number");
  CHECK(std::string(cambium_version()).find("0.") == 0);
  cambium_close(c);
  cambium_close(nullptr);
}
