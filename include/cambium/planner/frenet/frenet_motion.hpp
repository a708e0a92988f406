#pragma once

#include <cmath>

#include "cambium/core/portable_math.hpp"

namespace cambium::inline v0_1 {

/// A motion in the Frenet frame of a line: `s` and its derivatives in time, the offset and its derivatives in `s`.
///
///                       .---->  course (heading error: its direction minus that of the line)
///              x ------'
///              | offset
///     ---------+----------------> line
///              s
template <class Scalar>
struct FrenetMotion {
  Scalar s{};             ///< [m]
  Scalar speed{};         ///< of `s` [m/s]
  Scalar acceleration{};  ///< of `s` [m/s^2]
  Scalar offset{};        ///< left positive [m]
  Scalar slope{};         ///< change of the offset per metre of `s` [-]
  Scalar bend{};          ///< change of the slope per metre of `s` [1/m]
};

/// The motion of a point along its course, at the same place and time.
template <class Scalar>
struct CourseMotion {
  Scalar heading_error{};  ///< direction of the course minus that of the line [rad]
  Scalar curvature{};      ///< of the course, left positive [1/m]
  Scalar speed{};          ///< [m/s]
  Scalar acceleration{};   ///< along the course [m/s^2]
};

/// The curvature of the line at the foot point, and its change.
template <class Scalar>
struct LineBend {
  Scalar curvature{};  ///< left positive [1/m]
  Scalar change{};     ///< of the curvature, per metre [1/m^2]
};

/// The motion along the course, from one in the Frenet frame (Werling, Ziegler, Kammel, Thrun 2010, appendix I).
/// Precondition: the offset does not reach the line's centre of curvature.
template <class Scalar>
[[nodiscard]] CourseMotion<Scalar> course_motion(FrenetMotion<Scalar> const& f, LineBend<Scalar> const& line) {
  using portable::atan;
  using std::sqrt;
  Scalar const stretch = Scalar(1) - line.curvature * f.offset, tan = f.slope / stretch,
               inverse_cos = sqrt(Scalar(1) + tan * tan);
  Scalar const narrowing = line.change * f.offset + line.curvature * f.slope;  // - d stretch / ds
  // Change of the heading error per metre of `s`.
  Scalar const turn = (f.bend + narrowing * tan) / (stretch * inverse_cos * inverse_cos);
  Scalar const way = stretch * inverse_cos;  // distance along the course per metre of `s`
  Scalar const lengthening = stretch * inverse_cos * tan * turn - narrowing * inverse_cos;
  return {atan(tan), (turn + line.curvature) / way, f.speed * way,
          f.acceleration * way + f.speed * f.speed * lengthening};
}

/// The inverse of `course_motion` at `s` and `offset`. Precondition: the heading error is within a quarter turn.
template <class Scalar>
[[nodiscard]] FrenetMotion<Scalar> frenet_motion(CourseMotion<Scalar> const& c, Scalar s, Scalar offset,
                                                 LineBend<Scalar> const& line) {
  using portable::tan;
  using std::sqrt;
  Scalar const stretch = Scalar(1) - line.curvature * offset, slant = tan(c.heading_error),
               inverse_cos = sqrt(Scalar(1) + slant * slant), way = stretch * inverse_cos;
  Scalar const slope = stretch * slant, narrowing = line.change * offset + line.curvature * slope;
  Scalar const turn = c.curvature * way - line.curvature;
  Scalar const bend = turn * stretch * inverse_cos * inverse_cos - narrowing * slant;
  Scalar const speed = c.speed / way;
  Scalar const lengthening = stretch * inverse_cos * slant * turn - narrowing * inverse_cos;
  return {s, speed, (c.acceleration - speed * speed * lengthening) / way, offset, slope, bend};
}

}  // namespace cambium::inline v0_1
