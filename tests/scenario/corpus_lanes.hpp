#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>

#include "../support/corpus.hpp"
#include "cambium/core/error.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive.hpp"

namespace corpus {

/// Calls `f(name, map)` for each OpenDRIVE map of the corpus; whether there is one.
template <class F>
bool for_each_map(F const& f) {
  auto const folder = root();
  if (!folder) return false;
  for (auto const& file : maps(*folder / "opendrive")) {
    std::shared_ptr<cambium::Map const> map;
    try {
      map = cambium::load_opendrive(file.string()).map;
    } catch (cambium::Error const&) {
      continue;  // files that are wrong on purpose
    }
    f(file.filename().string(), map);
  }
  return true;
}

/// Calls `f(map, lane)` for about `each` lanes of each of them.
template <class F>
bool for_some_lanes(std::size_t each, F const& f) {
  return for_each_map([&](std::string const& name, std::shared_ptr<cambium::Map const> const& map) {
    CAPTURE(name);
    auto const& lanes = map->lanes();
    std::size_t const stride = std::max<std::size_t>(1, lanes.size() / each);
    for (std::size_t i = 0; i < lanes.size(); i += stride) {
      CAPTURE(i);
      if (lanes[i].drivable() && lanes[i].length() >= 15.0) f(map, lanes[i]);
    }
  });
}

}  // namespace corpus
