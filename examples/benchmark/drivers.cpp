#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>

#include "cambium/core/text.hpp"

#include "traffic.hpp"

CAMBIUM_INSTANTIATE_WORLD(benchmark::TestedWorld);

namespace benchmark {

Contender driver(std::string name, std::string parameters, std::uint64_t hash,
                 std::function<Tested(Spec const&)> choose) {
  return cb::contender_by<Traffic>(
      std::move(name), std::move(parameters), hash,
      [choose = std::move(choose)](Spec const& ego, cb::Scenario<Traffic> const&) { return choose(ego); }, &freeze);
}

std::size_t different_parts(std::string const& a, std::string const& b) {
  auto const in_a = cb::detail::split(a, ", "), in_b = cb::detail::split(b, ", ");
  std::size_t count = std::max(in_a.size(), in_b.size()) - std::min(in_a.size(), in_b.size());
  for (std::size_t i = 0; i < std::min(in_a.size(), in_b.size()); ++i) count += in_a[i] != in_b[i];
  return count;
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
