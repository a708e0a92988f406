#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "cambium/behavior/presets.hpp"
#include "cambium/behavior/wrap/human_driver.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/random.hpp"
#include "cambium/core/text.hpp"

namespace cambium::inline v0_1 {

/// How the drivers of a recipe's vehicles differ from those that it gives: most numbers of a driver are drawn around
/// those of its population, see `presets::Temperament::drawn_around`.
///
/// - `as_given`: not at all;
/// - `timid`, `aggressive`: the temperaments of these names (`presets::Temperament`);
/// - `inattentive`: usual temperaments that respond late, look away and misjudge gaps (`HumanDriver`);
/// - `mixed`: each driver is of one of the four.
enum class TrafficPopulation : std::uint8_t { as_given, timid, aggressive, inattentive, mixed };

inline constexpr char const* population_names = "as_given|timid|aggressive|inattentive|mixed";

[[nodiscard]] inline std::string_view to_string(TrafficPopulation population) {
  return detail::split(population_names, "|")[static_cast<std::size_t>(population)];
}

namespace detail {

/// Whether a behaviour can be one of a population: a `Driver`.
template <class Given>
inline constexpr bool can_be_person = requires(Given given) {
  presets::Temperament{}.of(given);
  given.law.desired_speed;
};

/// A driver of a population in place of `given`: its desired speed is that of `given`, times the speed factor of its
/// temperament. Returns `given` if it is no `Driver`. Throws `ParameterError` if `World` lacks the behaviour.
template <class World, class Given>
[[nodiscard]] typename World::Behavior driver_of(TrafficPopulation population, Given const& given, RandomStream& random,
                                                 std::string const& where) {
  if constexpr (can_be_person<Given>) {
    using P = TrafficPopulation;
    if (population == P::mixed) population = static_cast<P>(uniform_index(random, 4));
    if (population == P::as_given) return given;
    auto const usual = population == P::timid        ? presets::timid_temperament()
                       : population == P::aggressive ? presets::aggressive_temperament()
                                                     : presets::Temperament{};
    auto const one = usual.drawn_around(random);
    double const speed = given.law.desired_speed * one.speed_factor;
    if (population != P::inattentive) {
      auto driver = one.of(given);
      driver.law.desired_speed = speed;
      return driver;
    }
    using Human = HumanDriver<Given>;
    if constexpr (World::Behaviors::template contains<Human>) {
      auto const around = [&](double usual_value) { return usual_value * (0.7 + 0.6 * uniform01(random)); };
      Human human{.nominal = given};
      human.reaction_time = around(0.8);
      human.gap_error = around(human.gap_error);
      human.rate_error = around(human.rate_error);
      human.attentive = around(human.attentive);
      human.looks_away = around(1.0);
      human.noise = around(human.noise);
      human = one.of(human);
      human.nominal.law.desired_speed = speed;
      return human;
    } else {
      throw ParameterError(where, std::string("needs HumanDriver of ") + Given::name + ", which the program lacks",
                           "add it to the BehaviorSet of the program's World, or leave out inattentive and mixed");
    }
  } else {
    return given;
  }
}

}  // namespace detail

}  // namespace cambium::inline v0_1
