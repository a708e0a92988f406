#pragma once

#include <cstddef>
#include <string>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/signals.hpp"

namespace cambium::detail {

/// Throws `WorldError` for a light that the map does not have and for numbers that are no plan.
inline void require_light_plan(Map const& map, LightId id, map::LightPlan const& plan) {
  std::string const where = "light " + to_string(id);
  if (index_of(id) >= map.lights().size())
    throw WorldError(where, "the map has no such traffic light", "see Map::lights for those it has");
  if (!plan.is_possible())
    throw WorldError(where, "its plan has a negative phase, or one of more than a day",
                     "give green_begin <= green_end within the cycle");
}

/// Throws `WorldError` where a frame of `records` is not one of a roster of `agents`.
inline void require_same_size(std::size_t records, std::size_t agents) {
  if (records != agents)
    throw WorldError(
        "World",
        "the frame has " + std::to_string(records) + " records, the roster " + std::to_string(agents) + " agents",
        "restore frames of this world from since the last agent entered or left");
}

/// Throws `WorldError` where `steps_back` is none of the `kept` frames.
inline void require_kept(std::size_t steps_back, std::size_t kept) {
  if (steps_back == 0 || steps_back > kept)
    throw WorldError("history", "there is no frame " + std::to_string(steps_back) + " steps back",
                     "call keep_history before stepping");
}

}  // namespace cambium::detail
