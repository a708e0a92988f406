#pragma once

#include <string>

#include "cambium/core/distributions.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/random.hpp"
#include "cambium/geometry/shape.hpp"

namespace cambium::inline v0_1 {

/// Which vehicles traffic consists of. Those that are nothing else are cars.
struct VehicleMix {
  double truck_share = 0.1;
  double van_share = 0.0;
  double bicycle_share = 0.0;

  static constexpr char const* name = "vehicle_mix";
  static constexpr auto parameters() {
    using P = VehicleMix;
    return parameter_list(parameter("truck_share", &P::truck_share, "-", Range{0, 1}, "part of the vehicles"),
                          parameter("van_share", &P::van_share, "-", Range{0, 1}, "part of the vehicles"),
                          parameter("bicycle_share", &P::bicycle_share, "-", Range{0, 1}, "part of the vehicles"));
  }

  /// Throws `ParameterError` if the shares of trucks and bicycles add up to more than 1; vans yield to both.
  void check(std::string const& where) const {
    if (!(truck_share + bicycle_share <= 1.0))
      throw ParameterError(where, "truck_share and bicycle_share add up to more than 1", "lower one of them");
  }

  /// The next vehicle. Takes one draw.
  [[nodiscard]] geometry::Shape operator()(RandomStream& random) const {
    double const share = uniform01(random);
    if (share >= 1.0 - bicycle_share) return geometry::bicycle();
    if (share < truck_share) return geometry::truck();
    return share < truck_share + van_share ? geometry::van() : geometry::car();
  }
};

}  // namespace cambium::inline v0_1
