#pragma once

#include <cmath>
#include <vector>

#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/pose.hpp"

// g++ 12 wrongly warns that parts of Boost.Geometry are uninitialised; clang 19 rejects an enumeration of Boost 1.74.
#if defined(__clang__)
#pragma clang diagnostic push
#if __has_warning("-Wenum-constexpr-conversion")
#pragma clang diagnostic ignored "-Wenum-constexpr-conversion"
#endif
#elif defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <boost/geometry/algorithms/union.hpp>
#include <boost/geometry/geometries/multi_polygon.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#if defined(__clang__)
#pragma clang diagnostic pop
#elif defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace cambium::inline v0_1::geometry::detail {

using BoostPoint = boost::geometry::model::d2::point_xy<double>;
using BoostPolygon = boost::geometry::model::polygon<BoostPoint, false, true>;  // counter-clockwise, closed
using BoostArea = boost::geometry::model::multi_polygon<BoostPolygon>;

[[nodiscard]] inline BoostPolygon to_boost(Polygon const& polygon) {
  BoostPolygon result;
  for (auto const& p : polygon.points()) result.outer().emplace_back(p.x(), p.y());
  result.outer().push_back(result.outer().front());
  return result;
}

/// Adds a ring as a polygon unless its area is negligible (below one square centimetre).
template <class Ring>
void add_ring(Ring const& ring, std::vector<Polygon>& polygons) {
  std::vector<Point> points;
  for (auto const& p : ring) points.emplace_back(p.x(), p.y());
  if (std::abs(twice_area(points)) > 2e-4) polygons.emplace_back(points, "area");
}

}  // namespace cambium::inline v0_1::geometry::detail
