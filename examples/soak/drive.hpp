#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/viewer/record_world.hpp"

#include "findings.hpp"
#include "traffic.hpp"

namespace soak {

inline constexpr double run_length = 600.0;  ///< of a run [s]
inline constexpr double warm_up = 120.0;     ///< before throughput counts, at most a third of the run [s]

/// What came of one run.
struct Result {
  Mix mix;
  double kilometres = 0.0, counted_minutes = 0.0;
  std::uint64_t entered = 0, heavy = 0, passed = 0, steps = 0, agent_steps = 0;  ///< passed: while it counts
  std::vector<Finding> findings{};
};

/// A stretch of a run to record: from 20 s before a step to 5 s behind it.
struct Shot {
  std::uint64_t step{};
  cb::Recording recording{};
};

/// Drives run `run` of a seed for `duration` [s], with what the file says of the drivers. Records a part of it into
/// `shot`, unless that is null, and ends behind it.
[[nodiscard]] inline Result drive(Site const& site, std::uint64_t seed, std::uint32_t run, double duration,
                                  examples::ParameterFile const& parameters, Shot* shot = nullptr) {
  Result result{.mix = draw_mix(site, seed, run)};
  auto const& mix = result.mix;
  Sim world(site.map, {.seed = seed + 0x9e3779b97f4a7c15u * (run + 1)});
  if (mix.lights)
    for (std::size_t i = 0; i < site.map->lights().size(); ++i)
      world.set_light(site.map->lights()[i].id, light_plan(i, site.map->lights().size()));
  auto sources = site.sources;
  for (auto& source : sources) source.per_hour = mix.per_hour;
  sources.insert(sources.end(), site.paths.begin(), site.paths.end());
  cb::TrafficInflow<Sim> inflow(*site.map, sources, world.roster().seed);
  Inspector inspector;
  std::optional<cb::WorldRecorder> film;
  double const counted_from = std::min(warm_up, duration / 3.0);
  auto const first = shot == nullptr ? 0.0 : std::max(0.0, static_cast<double>(shot->step) * mix.dt - 20.0);
  auto const last = shot == nullptr ? duration : static_cast<double>(shot->step) * mix.dt + 5.0;
  auto const is_walker = [](auto const& agent) { return agent.shape == cb::geometry::pedestrian(); };
  while (world.time() < std::min(duration, last)) {
    for (auto const &entered : inflow.enter(world, [&](cb::TrafficSource const&source, cb::RandomStream&random) {
           auto spec = source.way ? draw_pedestrian(random) : draw_vehicle(site, mix, source, random);
           set_parameters(spec, parameters);
           return spec;
         })) {
      auto const& agent = world.roster().agents[world.slot_of(entered.id)];
      result.entered += !is_walker(agent);
      result.heavy += agent.shape.length() > 7.5;
    }
    if (shot != nullptr && !film && world.time() >= first) film.emplace(world);
    auto const done = world.step(mix.dt);
    static_cast<void>(done.valid());  // the inspector reports who failed
    ++result.steps;
    result.agent_steps += world.size();
    if (film) film->record(world);
    auto const before = result.findings.size();
    inspector.inspect(world, mix.dt, result.findings);
    for (auto i = before; film && i < result.findings.size(); ++i) {
      auto const& finding = result.findings[i];
      using Kind = cb::RecordedAgentKind;
      auto const kind = is_collision(finding.flaw) ? Kind::collided : Kind::ego;  // the replay follows both
      for (auto const id : {finding.first, finding.second}) film->show_as(id, kind, to_string(finding.flaw));
    }
    inspector.remove_collided(world);
    for (auto const& left : inflow.leave(world)) {
      bool const arrives = left.status == cb::AgentStatus::arrived || left.status == cb::AgentStatus::left_map;
      result.passed += arrives && is_valid(left.lane) && world.time() > counted_from;
      inspector.forget(left.id);
    }
  }
  result.kilometres = inspector.kilometres;
  result.counted_minutes = std::max(0.0, world.time() - counted_from) / 60.0;
  if (film) shot->recording = std::move(film->recording());
  return result;
}

}  // namespace soak
