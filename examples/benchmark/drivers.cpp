#include <string>
#include <utility>
#include <variant>

#include "traffic.hpp"

CAMBIUM_INSTANTIATE_WORLD(benchmark::TestedWorld);

namespace benchmark {

Contender driver(std::string name, std::string parameters, std::uint64_t hash,
                 std::function<Tested(Spec const&)> choose) {
  return cb::contender_by<Traffic>(
      std::move(name), std::move(parameters), hash,
      [choose = std::move(choose)](Spec const& ego, cb::Scenario<Traffic> const&) { return choose(ego); }, &freeze);
}

double desired_speed(Spec const& ego) {
  return std::visit(
      [&](auto const& driver) {
        if constexpr (requires { driver.law.desired_speed; })
          return driver.law.desired_speed;
        else
          return ego.speed;
      },
      ego.behavior.given());
}

Contender idm(examples::ParameterFile& file) {
  return with_speed(file, cb::IdmClassic{}, "idm",
                    [](auto& driver, double speed) { driver.law.desired_speed = speed; });
}
Contender mobil(examples::ParameterFile& file) {
  return with_speed(file, cb::Mobil{}, "mobil", [](auto& driver, double speed) { driver.law.desired_speed = speed; });
}
Contender urban(examples::ParameterFile& file) {
  return with_speed(file, cb::UrbanDriver{}, "urban",
                    [](auto& driver, double speed) { driver.law.desired_speed = speed; });
}

}  // namespace benchmark
