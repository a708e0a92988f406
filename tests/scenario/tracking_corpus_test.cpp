// Late and noisy actuators on real maps: what the controllers make of recorded drives, and of lane tracking.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "corpus_lanes.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/open_loop/static_trajectory.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/execution/lqr.hpp"
#include "cambium/execution/stanley.hpp"
#include "cambium/world/world.hpp"

namespace cb = cambium;

namespace {

template <class Behavior, class Execution>
using World = cb::World<cb::BehaviorSet<Behavior>, Execution, cb::SingleTrack>;

constexpr double dt = 0.2;

/// Late by 0.1 s, with noise that moves a car of 10 m/s by several metres a minute if nobody steers against it.
template <class Execution>
Execution sloppy() {
  Execution execution;
  if constexpr (requires { execution.actuation; })
    execution.actuation = {.delay = 0.1, .acceleration_noise = {0.1, 0.4}, .steering_noise = {0.0, 0.01}};
  return execution;
}

/// Calls `f(record)` at the start and after each step of a vehicle that tracks its lane for up to 20 s.
template <class Execution, class F>
void track_lane(std::shared_ptr<cb::Map const> const& map, cb::map::Lane const& lane, Execution const& execution,
                F const& f) {
  World<cb::IdmLaneTracking, Execution> world(map);
  auto const pose = lane.path.pose(2.0);
  auto const id =
      world.add({.position = pose.position(), .heading = pose.heading, .speed = 3.0, .execution = execution});
  f(world.record(id));
  for (int k = 0; k < 100 && world.status(id) == cb::AgentStatus::driving; ++k) {
    REQUIRE(world.step(dt));
    if (world.status(id) == cb::AgentStatus::driving) f(world.record(id));
  }
}

/// How far vehicles are from where they should be.
struct Deviations {
  std::vector<double> across, along;

  [[nodiscard]] static double quantile(std::vector<double> values, double share) {
    auto const place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + place, values.end());
    return values[static_cast<std::size_t>(place)];
  }
};

/// Replays a drive by `execution` and notes how far it is from the recording.
template <class Execution>
void replay(std::shared_ptr<cb::Map const> const& map, std::vector<cb::State> const& states, Execution const& execution,
            Deviations& deviations) {
  World<cb::StaticTrajectory, Execution> world(map);
  auto const& first = states.front();
  auto const id = world.add({.position = {first.x, first.y},
                             .heading = first.heading,
                             .speed = first.speed,
                             .behavior = cb::StaticTrajectory(states),
                             .execution = execution});
  for (std::size_t k = 1; k < states.size(); ++k) {
    if (!world.step(dt) || world.status(id) != cb::AgentStatus::driving) return;
    auto const& is = world.state(id);
    auto const& wanted = states[k];
    double const dx = is.x - wanted.x, dy = is.y - wanted.y, c = std::cos(wanted.heading), s = std::sin(wanted.heading);
    deviations.across.push_back(std::abs(dy * c - dx * s));
    deviations.along.push_back(std::abs(dx * c + dy * s));
  }
}

}  // namespace

TEST_CASE_TEMPLATE("recorded drives on every map are followed within bounds, with delay and noise", Execution,
                   cb::StanleyExecution, cb::LqrExecution) {
  Deviations exact, noisy;
  bool const is_there = corpus::for_some_lanes(8, [&](auto const& map, cb::map::Lane const& lane) {
    std::vector<cb::State> states;
    track_lane(map, lane, cb::InterpolateExecution{}, [&](auto const& record) { states.push_back(record.state); });
    if (states.size() < 10) return;
    replay(map, states, Execution{}, exact);
    replay(map, states, sloppy<Execution>(), noisy);
  });
  if (!is_there) return;
  auto const tell = [](std::string const& what, Deviations const& d) {
    MESSAGE(std::string(Execution::name) << ", " << what << ", " << d.across.size() << " steps: across "
                                         << Deviations::quantile(d.across, 0.5) << " m in the middle, "
                                         << Deviations::quantile(d.across, 0.99) << " m at 99 %, "
                                         << Deviations::quantile(d.across, 1.0) << " m at most; along "
                                         << Deviations::quantile(d.along, 0.99) << " m at 99 %, "
                                         << Deviations::quantile(d.along, 1.0) << " m at most");
  };
  tell("as commanded", exact);
  tell("late and noisy", noisy);
  CHECK(noisy.across.size() > 5000);
  CHECK(Deviations::quantile(exact.across, 1.0) < 0.02);
  CHECK(Deviations::quantile(exact.along, 1.0) < 0.05);
  CHECK(Deviations::quantile(noisy.across, 0.5) > 0.005);  // there is noise
  CHECK(Deviations::quantile(noisy.across, 1.0) < 0.5);
  CHECK(Deviations::quantile(noisy.along, 1.0) < 0.5);
}

TEST_CASE_TEMPLATE("lane tracking stays in its lane on every map, also by late and noisy actuators", Execution,
                   cb::InterpolateExecution, cb::StanleyExecution, cb::LqrExecution) {
  constexpr bool is_exact = std::is_same_v<Execution, cb::InterpolateExecution>;
  std::vector<double> lateral;
  bool const is_there = corpus::for_some_lanes(is_exact ? 15 : 8, [&](auto const& map, cb::map::Lane const& lane) {
    track_lane(map, lane, sloppy<Execution>(),
               [&](auto const& record) { lateral.push_back(std::abs(record.lane.lateral)); });
  });
  if (!is_there) return;
  MESSAGE(std::string(Execution::name) << ": rear axle off the centre line by " << Deviations::quantile(lateral, 0.5)
                                       << " m in the middle, " << Deviations::quantile(lateral, 0.99) << " m at 99 %, "
                                       << Deviations::quantile(lateral, 1.0) << " m at most");
  CHECK(lateral.size() > (is_exact ? 10'000 : 5000));
  CHECK(Deviations::quantile(lateral, 0.9) < 0.15);
  CHECK(Deviations::quantile(lateral, 0.99) < 0.4);
  CHECK(Deviations::quantile(lateral, is_exact ? 0.998 : 1.0) < (is_exact ? 0.8 : 1.0));
}
