/// The room `geometry`: angles, poses, arc-length lines, polygons, boxes, vehicle shapes, collision, Frenet frame.
///
/// **Line and Frenet frame.** A `Line` is a polyline with arc length s and a heading. A point's Frenet coordinates are
/// the arc length of its foot point and its lateral offset, left positive. Queries keep a cursor, the segment of the
/// last answer, so they take O(1) for a moving vehicle.
///
///                       p
///                       |  lateral > 0 (left)
///     Line  o---->o-----f------->o---------> s      p has the Frenet coordinates (s of f, lateral)
///           s = 0
///
/// **Shape and reference point.** A pose places an agent's reference point (vehicles: centre of the rear axle). A
/// `Shape` gives the distances from there to the four sides; `box_of(shape, pose)` is the `OrientedBox` on the map.
///
/// `geometry/polygon_union.hpp` (union of polygons) needs Boost.Geometry and is included by name.
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/box_tree.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/convex_hull.hpp"
#include "cambium/geometry/frenet.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/geometry/moving_box.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/geometry/shape.hpp"
