#pragma once

#include <optional>

#include "cambium/behavior/view.hpp"

namespace cambium {

/// A neighbouring lane as the target of a change.
struct LaneOption {
  map::LanePlace place;
  bool left = false;                    ///< on the left, otherwise on the right
  std::optional<RoadUser> front, rear;  ///< the new leader and the new follower
};

}  // namespace cambium
