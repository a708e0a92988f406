#pragma once

#include <cstdint>
#include <variant>

#include "cambium/behavior/drivers.hpp"
#include "cambium/scenario/merging_site.hpp"
#include "cambium/scenario/scenario_set.hpp"
#include "maps.hpp"

namespace support {

/// The first `count` scenarios of merging traffic, all of it IDM.
template <class Traffic>
cambium::ScenarioSet<Traffic> merging_set(std::uint32_t count) {
  static auto const site = cambium::find_merging_site(own_map("merging.xodr"));
  cambium::ScenarioSet<Traffic> set{.title = "merging"};
  for (std::uint32_t i = 0; i < count; ++i) {
    set.scenarios.push_back(cambium::with_behaviors<Traffic>(
        site.sample(4, i),
        [](auto const& spec) -> typename Traffic::Behavior { return std::get<cambium::IdmClassic>(spec.behavior); }));
    set.scenarios.back().map_file = "merging.xodr";
  }
  return set;
}

}  // namespace support
