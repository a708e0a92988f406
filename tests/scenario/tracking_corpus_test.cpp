// Late and noisy actuators on real maps: what the controllers make of recorded drives, and of lane tracking.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "../support/corpus.hpp"
#include "../support/maps.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/following/idm_lane_tracking.hpp"
#include "cambium/behavior/open_loop/static_trajectory.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/execution/lqr.hpp"
#include "cambium/execution/stanley.hpp"
#include "cambium/map/opendrive.hpp"
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
  execution.actuation = {.delay = 0.1, .acceleration_noise = {0.1, 0.4}, .steering_noise = {0.0, 0.01}};
  return execution;
}

/// The course of a vehicle that follows its lane for up to 20 s, exactly.
std::vector<cb::State> recorded_drive(std::shared_ptr<cb::Map const> const& map, cb::map::Lane const& lane) {
  World<cb::IdmLaneTracking, cb::InterpolateExecution> world(map);
  auto const pose = lane.path.pose(2.0);
  auto const id = world.add({.position = pose.position(), .heading = pose.heading, .speed = 3.0});
  std::vector<cb::State> states{world.state(id)};
  for (int k = 0; k < 100 && world.step(dt) && world.status(id) == cb::AgentStatus::driving; ++k)
    states.push_back(world.state(id));
  return states;
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

/// Calls `f(map, lane)` for some lanes of each map of the corpus.
template <class F>
void for_some_lanes(std::filesystem::path const& root, std::size_t each, F const& f) {
  for (auto const& file : corpus::maps(root / "opendrive")) {
    std::shared_ptr<cb::Map const> map;
    try {
      map = cambium::load_opendrive(file.string()).map;
    } catch (cb::Error const&) {
      continue;  // files that are wrong on purpose
    }
    auto const& lanes = map->lanes();
    std::size_t const stride = std::max<std::size_t>(1, lanes.size() / each);
    for (std::size_t i = 0; i < lanes.size(); i += stride)
      if (lanes[i].drivable() && lanes[i].length() >= 15.0) f(map, lanes[i]);
  }
}

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
  auto const root = corpus::root();
  if (!root) return;
  Deviations exact, noisy;
  for_some_lanes(*root, 8, [&](auto const& map, cb::map::Lane const& lane) {
    auto const states = recorded_drive(map, lane);
    if (states.size() < 10) return;
    replay(map, states, Execution{}, exact);
    replay(map, states, sloppy<Execution>(), noisy);
  });
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

TEST_CASE_TEMPLATE("lane tracking by late and noisy actuators stays in its lane on every map", Execution,
                   cb::StanleyExecution, cb::LqrExecution) {
  auto const root = corpus::root();
  if (!root) return;
  std::vector<double> lateral;
  for_some_lanes(*root, 8, [&](auto const& map, cb::map::Lane const& lane) {
    World<cb::IdmLaneTracking, Execution> world(map);
    auto const pose = lane.path.pose(2.0);
    auto const id = world.add(
        {.position = pose.position(), .heading = pose.heading, .speed = 3.0, .execution = sloppy<Execution>()});
    for (int k = 0; k < 100 && world.step(dt) && world.status(id) == cb::AgentStatus::driving; ++k)
      lateral.push_back(std::abs(world.record(id).lane.lateral));
  });
  MESSAGE(std::string(Execution::name) << ": rear axle off the centre line by " << Deviations::quantile(lateral, 0.5)
                                       << " m in the middle, " << Deviations::quantile(lateral, 0.99) << " m at 99 %, "
                                       << Deviations::quantile(lateral, 1.0) << " m at most");
  CHECK(lateral.size() > 5000);
  CHECK(Deviations::quantile(lateral, 0.9) < 0.15);
  CHECK(Deviations::quantile(lateral, 0.99) < 0.4);
  CHECK(Deviations::quantile(lateral, 1.0) < 1.0);
}
