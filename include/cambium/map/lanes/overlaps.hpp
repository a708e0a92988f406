#pragma once

#include <functional>
#include <vector>

#include "cambium/geometry/pose.hpp"
#include "cambium/map/lanes/lane.hpp"

namespace cambium::map {

/// Height of a lane's path at path position `s` [m].
using LaneElevation = std::function<double(Lane const&, double s)>;

/// The place on a lane's exact path, with the direction of travel, beside path position `s` [m] of the sampled one.
using LanePose = std::function<geometry::Pose(Lane const&, double s)>;

/// Fills `Lane::overlaps` of the drivable lanes: the stretches on which two lanes' paths are closer than `clearance`
/// [m], on both lanes. An end lies within 1 cm, along the path, of where the distance of the exact paths (`place`;
/// without one, the sampled paths) is the clearance, however slowly the lanes come together. Lanes whose sampled paths
/// come 2 cm closer than that, or less, may be missed, and gaps as shallow may be passed over. `elevation` may be
/// empty; where it is given, paths more than 3 m above each other at the place do not overlap. A lane that crosses
/// itself overlaps with itself, too: each of the two stretches is the other's other. A lane's number must be its place
/// in `lanes`. O((n + k) log n) for n path segments, k pairs of them that are close; memory O(n) and the pairs of one
/// lane.
///
/// Left out is where lanes belong together anyway: near the joint of lanes one behind the other (also with lanes in
/// between that are shorter than twice the clearance) and of those beside these, oncoming ones too, that is where a
/// stretch comes within 10 m of it along the paths; and lanes of the same road at about the same station,
/// unless one merges into the other. Kinds: crossing where the directions differ by more than 60 degrees in the middle
/// of the stretch; else merge where both end in a common successor; else split where both begin behind a common
/// predecessor; else split where they are closer at the stretch's begin than at its end; else merge. For merge and
/// split, begin and end are beside each other on the two lanes: where one lane begins or ends, so does the overlap.
void find_overlaps(std::vector<Lane>& lanes, LaneElevation const& elevation, double clearance,
                   LanePose const& place = {});

}  // namespace cambium::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/lanes/overlaps_impl.hpp"
#endif
