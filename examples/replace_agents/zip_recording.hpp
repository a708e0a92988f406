#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/road/curve_layout.hpp"
#include "cambium/scenario/dataset/recorded_traffic.hpp"
#include "cambium/scenario/dataset/track_recorder.hpp"
#include "cambium/world/world.hpp"

/// A stand-in for the recording of INTERACTION's DR_DEU_Merging_MT that the paper uses and that its licence keeps out
/// of this repository: the same kind of place, and drivers of our own who merge like a zip.
namespace replace_agents {

namespace cb = cambium;

/// Two lanes of 2.8 and 3.2 m become one, as at DR_DEU_Merging_MT: the right one narrows from 45 m before its end on.
/// With 40 m more before the merge than INTERACTION's map, so that all vehicles are there at the start.
inline cb::MapBuilder zip_map() {
  using cb::map::CurvePiece;
  constexpr double merge = 114.0, narrows = 69.0, end = 185.0;
  cb::MapBuilder builder("zip");
  cb::map::LanePlan const left{.width = 2.8};
  builder.add_road(
      {.id = "1",
       .line = cb::map::lay_from(
           {},
           {{66.0, 0.0, 0.0}, {9.0, 0.011, 0.011}, {20.0, 0.0, 0.0}, {13.0, -0.005, -0.005}, {end - 108.0, 0.0, 0.0}}),
       .sections = {{.s = 0.0, .right = {left, {.width = 3.2}}},
                    {.s = narrows, .right = {left, {.width = 3.2, .end_width = 0.0, .next = 0}}},
                    {.s = merge, .right = {{.width = 2.8, .end_width = 3.2}}}},
       .type = "town",
       .speed_limit = 30.0 / 3.6});
  return builder;
}

/// The recorded vehicles, in the order of the zip. Those that the paper replaces have its numbers: 66 and 68 on the
/// right, 65 and 67 on the left.
struct Recorded {
  std::int64_t id;
  bool on_left;
  double s;  ///< of the rear axle at the start [m]
};
inline constexpr Recorded vehicles[] = {{63, true, 66.0}, {64, false, 59.0}, {65, true, 52.0}, {66, false, 45.0},
                                        {67, true, 37.0}, {68, false, 29.0}, {69, true, 21.0}, {70, false, 12.0}};

inline constexpr double time_step = 0.1;  // [s]

/// Adds noise to the states as a tracker leaves it: normal, of 5 cm and a third of a degree, correlated over a second.
inline void add_noise(cb::Track& track, std::uint64_t seed) {
  constexpr double position = 0.05, heading = 0.006, kept = 0.9;
  cb::RandomStream random(seed, static_cast<std::uint32_t>(track.id), 0, 1);
  cb::Normal const normal{0.0, std::sqrt(1.0 - kept * kept)};
  double x = 0.0, y = 0.0, turn = 0.0;
  for (auto& state : track.states) {
    x = kept * x + normal(random);
    y = kept * y + normal(random);
    turn = kept * turn + normal(random);
    state.x += position * x;
    state.y += 0.5 * position * y;
    state.heading += heading * turn;
  }
}

/// A recording of 25 s: drivers with parameters and places of their own, drawn from `seed`, merge like a zip.
inline cb::RecordedTraffic record_zip(std::shared_ptr<cb::Map const> const& map, std::uint64_t seed) {
  using Sim = cb::World<cb::BehaviorSet<cb::ZipMerge>, cb::InterpolateExecution, cb::SingleTrack>;
  constexpr double duration = 25.0;
  cb::RandomStream random(seed, 0, 0);
  Sim world(map, {.seed = seed});
  for (auto const& vehicle : vehicles) {
    auto const lane = map->find_lane("1", 1.0, vehicle.on_left ? -1 : -2);
    auto const road = cb::map::build_road_corridor(*map, cb::map::straight_route(*map, lane));
    auto const pose = road->corridors[road->main].center.pose(vehicle.s + cb::Uniform{-1.0, 1.0}(random));
    cb::ZipMerge driver;
    driver.law = {.desired_speed = cb::Uniform{4.6, 5.6}(random),
                  .time_headway = cb::Uniform{0.8, 1.2}(random),
                  .minimum_gap = cb::Uniform{1.6, 2.4}(random),
                  .maximum_acceleration = 1.7,
                  .comfortable_deceleration = 1.7};
    world.add({.position = pose.position(),
               .heading = pose.heading,
               .speed = cb::Uniform{3.0, 4.0}(random),
               .behavior = driver,
               .id = static_cast<cb::AgentId>(vehicle.id)});
  }
  cb::TrackRecorder recorder(world, time_step, "zip " + std::to_string(seed));
  for (int step = 1; step <= std::lround(duration / time_step); ++step) {
    if (!world.step(time_step)) throw cb::Error("zip recording", "a driver found no way on", "choose another --seed");
    recorder.record(world);
  }
  for (auto& track : recorder.traffic().tracks) add_noise(track, seed);
  return recorder.traffic();
}

}  // namespace replace_agents
