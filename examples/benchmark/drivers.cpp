#include <variant>

#include "traffic.hpp"

namespace benchmark {

double desired_speed(Spec const& ego) {
  return std::visit(
      [&](auto const& driver) {
        if constexpr (requires { driver.idm.desired_speed; })
          return driver.idm.desired_speed;
        else if constexpr (requires { driver.desired_speed; })
          return driver.desired_speed;
        else
          return ego.speed;
      },
      ego.behavior.given());
}

Contender idm() {
  return with_speed(cb::IdmClassic{}, "idm", [](auto& driver, double speed) { driver.desired_speed = speed; });
}
Contender mobil() {
  return with_speed(cb::Mobil{}, "mobil", [](auto& driver, double speed) { driver.idm.desired_speed = speed; });
}
Contender intersection() {
  return with_speed(cb::Intersection{}, "intersection",
                    [](auto& driver, double speed) { driver.idm.desired_speed = speed; });
}

}  // namespace benchmark
