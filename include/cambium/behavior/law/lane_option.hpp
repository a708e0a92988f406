#pragma once

#include <algorithm>
#include <optional>

#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/view.hpp"

namespace cambium::inline v0_1 {

namespace detail {
/// What is assumed of the drivers of long vehicles, and from which length [m].
inline constexpr Idm assumed_truck{.desired_speed = 23.0, .time_headway = 1.7, .maximum_acceleration = 0.9};
inline constexpr double assumed_truck_length = 7.5;

/// How `who` is assumed to follow others: by IDM, and it wants to drive no slower than it does.
[[nodiscard]] inline IdmLaw assumed_law(RoadUser const& who, Idm const& car = {}, Idm const& truck = assumed_truck,
                                        double truck_length = assumed_truck_length) {
  auto const& assumed = who.length() > truck_length ? truck : car;
  return IdmLaw(assumed, std::max(0.0, who.speed), std::max(assumed.desired_speed, who.speed));
}
}  // namespace detail

/// A neighbouring lane as the target of a change.
struct LaneOption {
  map::LanePlace place;
  bool left = false;                    ///< on the left, otherwise on the right
  std::optional<RoadUser> front, rear;  ///< the new leader and the new follower
};

}  // namespace cambium::inline v0_1
