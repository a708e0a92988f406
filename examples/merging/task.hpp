#pragma once

#include <cstdint>
#include <iostream>
#include <string>

#include "cambium/core/ids.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/scenario/merging_site.hpp"

#include "../common/map_file.hpp"
#include "../common/options.hpp"
#include "../common/report.hpp"

namespace merging {

/// The task: the ego merges. See `examples::run_scenario`.
struct Task {
  cambium::MergingSite site;
  cambium::MergingTraffic traffic{};

  [[nodiscard]] auto sample(std::uint64_t seed, std::uint32_t number) const {
    return site.sample(seed, number, traffic);
  }

  template <class World>
  [[nodiscard]] auto watch(World const&, cambium::Slot ego) const {
    return [ego](World const& world) { return cambium::AtGoal{}(world, ego); };
  }

  [[nodiscard]] examples::Facts facts() const { return {{"entrances", site.entrances.size()}}; }
};

/// The merging site of the map in the settings. Warns of crossings, because these drivers do not give way there.
[[nodiscard]] inline cambium::MergingSite find_site(examples::Settings const& settings, std::string const& program) {
  auto site = cambium::find_merging_site(examples::load_map(settings.map_file), settings.map_file);
  if (site.crossings > 0)
    std::cerr << program << ": " << settings.map_file << ": " << site.crossings
              << (site.crossings == 1 ? " place" : " places")
              << " where routes cross or meet at an angle; these drivers do not give way there, so expect collisions\n";
  return site;
}

}  // namespace merging
