#pragma once

#include <functional>
#include <vector>

#include "cambium/geometry/pose.hpp"
#include "cambium/map/lanes/lane.hpp"

namespace cambium::inline v0_1::map {

/// Height of a lane's path at path position `s` [m].
using LaneElevation = std::function<double(Lane const&, double s)>;

/// The exact path of each lane: its pose, along the direction of travel, beside path position `s` [m] of the sampled
/// one.
using ExactPath = std::function<geometry::Pose(Lane const&, double s)>;

/// Enough for one lane to pass under another [m]; own choice.
inline constexpr double clear_height = 3.0;

/// Fills `Lane::overlaps` of the drivable lanes: the stretches on which two lanes' paths are closer than `clearance`
/// [m], on both lanes. Each end lies within 1 cm, along the path, of where the exact paths (`place`; without it, the
/// sampled paths) are as far apart as the clearance, however slowly the lanes come together. An overlap may be missed
/// if the sampled paths come less than 2 cm closer than the clearance, and so may an equally shallow gap. `elevation`
/// may be empty; if it is given, paths that are more than `clear_height` above each other do not overlap there. A lane
/// that crosses itself overlaps with itself: each of the two stretches is the other one's other. A lane's number must
/// be its place in `lanes`. O((n + k) log n) for n path segments and k pairs of them that are close; memory O(n) and
/// the pairs of one lane.
///
/// Lanes that are close for a harmless reason do not overlap. These are successive lanes, and those beside them,
/// oncoming ones too, where the stretch comes within 10 m of their joint along the paths (lanes shorter than twice the
/// clearance may lie between); and lanes of the same road at about the same station, unless one merges into the other.
///
/// An overlap is a crossing where the directions differ by more than 60 degrees in the middle of the stretch; else a
/// merge where both lanes end in a common successor; else a split where both begin after a common predecessor; else a
/// split where they are closer at the stretch's begin than at its end; else a merge. For merge and split, begin and end
/// are beside each other on the two lanes: where one lane begins or ends, so does the overlap.
void find_overlaps(std::vector<Lane>& lanes, LaneElevation const& elevation, double clearance,
                   ExactPath const& place = {});

}  // namespace cambium::inline v0_1::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/lanes/overlaps_impl.hpp"
#endif
