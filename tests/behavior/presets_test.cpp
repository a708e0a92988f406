#include "cambium/behavior/presets.hpp"

#include <doctest/doctest.h>

namespace cb = cambium;

TEST_CASE("presets of pedestrians and cyclists are valid; a cyclist brakes no harder than its bicycle can") {
  using namespace cb::presets;
  CHECK_NOTHROW(cb::check_parameters(cyclist()));
  CHECK_NOTHROW(cb::check_parameters(bicycle_dynamics()));
  CHECK_NOTHROW(cb::check_parameters(pedestrian_dynamics()));
  CHECK(cyclist().lowest_acceleration >= bicycle_dynamics().lowest_acceleration);
  CHECK(cyclist().maximum_acceleration <= bicycle_dynamics().highest_acceleration);
  CHECK(pedestrian_dynamics().highest_speed > 1.3 * 1.34);
  auto const bicycle = cb::geometry::bicycle();
  CHECK(bicycle_dynamics().wheel_base < bicycle.length());
  CHECK(bicycle.front - bicycle_dynamics().wheel_base == doctest::Approx(bicycle.rear));  // wheels of equal size
}

TEST_CASE("presets of drivers are valid and drive as their names say") {
  using namespace cb::presets;
  for (auto const& preset : all) CHECK_NOTHROW(cb::check_parameters(preset.parameters));
  double const gap = 40.0, speed = 25.0, leader = 24.0;
  double const hasty = cb::idm_acceleration(aggressive(), speed, gap, leader),
               usual = cb::idm_acceleration(kesting_2010_car(), speed, gap, leader),
               careful = cb::idm_acceleration(timid(), speed, gap, leader);
  CHECK(hasty > usual);
  CHECK(usual > careful);
  // Treiber, Hennecke, Helbing 2000: static capacity of about 1700 to 2000 vehicles per hour for vehicles 5 m long.
  double capacity = 0.0;
  for (double v = 1.0; v < 33.0; v += 0.1)
    capacity = std::max(capacity, 3600 * v / (5.0 + cb::idm_equilibrium_gap(treiber_2000(), v)));
  CHECK(capacity > 1600.0);
  CHECK(capacity < 2000.0);
}
