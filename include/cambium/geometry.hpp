/// The room `geometry`: angles, poses, arc-length lines, polygons, boxes, vehicle shapes, collision, Frenet frame. The
/// union of polygons (Boost.Geometry) is apart: `cambium/geometry/polygon_union.hpp`.
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
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/geometry/shape.hpp"
