#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/pose.hpp"

namespace cambium::inline v0_1::map::detail {

/// Transverse Mercator of the UTM grid on WGS 84, by Krüger's series of third order (1912; Karney 2011, eqs. 7 to 11
/// and 35): exact to less than a millimetre within the zones beside that of the origin. Places are relative to the
/// origin's, rounded to a micrometre.
class UtmProjection {
 public:
  /// `latitude`, `longitude` of the origin [degrees].
  UtmProjection(double latitude, double longitude)
      : meridian_(meridian_of(latitude, longitude)), origin_(project(latitude, longitude)) {}

  [[nodiscard]] geometry::Point operator()(double latitude, double longitude) const {
    auto const p = project(latitude, longitude) - origin_;
    return {std::round(p.x() * 1e6) / 1e6, std::round(p.y() * 1e6) / 1e6};
  }

 private:
  /// The middle of the zone [degrees]; those of south-western Norway and of Svalbard are wider.
  [[nodiscard]] static double meridian_of(double latitude, double longitude) {
    if (latitude >= 56.0 && latitude < 64.0 && longitude >= 3.0 && longitude < 12.0) return 9.0;
    if (latitude >= 72.0 && longitude >= 0.0 && longitude < 42.0)
      return longitude < 9.0 ? 3.0 : longitude < 21.0 ? 15.0 : longitude < 33.0 ? 27.0 : 39.0;
    return 6.0 * std::clamp(std::floor((longitude + 180.0) / 6.0), 0.0, 59.0) - 177.0;
  }

  [[nodiscard]] geometry::Point project(double latitude, double longitude) const {
    constexpr double radius = 6378137.0, flattening = 1.0 / 298.257223563, scale = 0.9996, degree = geometry::pi / 180;
    constexpr double n = flattening / (2.0 - flattening);
    constexpr double meridian = radius / (1.0 + n) * (1.0 + n * n / 4.0 + n * n * n * n / 64.0);
    constexpr std::array alpha{n / 2.0 - 2.0 * n * n / 3.0 + 5.0 * n * n * n / 16.0,
                               13.0 * n * n / 48.0 - 3.0 * n * n * n / 5.0, 61.0 * n * n * n / 240.0};
    double const eccentricity = 2.0 * std::sqrt(n) / (1.0 + n), sine = std::sin(latitude * degree);
    double const t = std::sinh(std::atanh(sine) - eccentricity * std::atanh(eccentricity * sine));
    double const east = (longitude - meridian_) * degree;
    double const xi = std::atan2(t, std::cos(east)), eta = std::atanh(std::sin(east) / std::hypot(1.0, t));
    double x = eta, y = xi;
    for (std::size_t j = 0; j < alpha.size(); ++j) {
      double const k = 2.0 * static_cast<double>(j + 1);
      x += alpha[j] * std::cos(k * xi) * std::sinh(k * eta);
      y += alpha[j] * std::sin(k * xi) * std::cosh(k * eta);
    }
    return {scale * meridian * x, scale * meridian * y};
  }

  double meridian_;  ///< of the zone's middle [degrees]
  geometry::Point origin_;
};

}  // namespace cambium::inline v0_1::map::detail
