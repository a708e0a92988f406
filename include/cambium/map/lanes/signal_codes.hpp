#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "cambium/map/lanes/signals.hpp"

namespace cambium::inline v0_1::map {

/// What a code of a country's catalogue of signs and lights says.
enum class SignalMeaning : std::uint8_t {
  priority,
  give_way,
  stop,
  light,        ///< for vehicles, of all or one direction
  bulb,         ///< one lamp of such a light
  speed_limit,  ///< whose value is written beside the code
  other,        ///< of no effect on who goes first: lights for others, lines, places, ...
};

/// The sign or light for lanes that a meaning is; nothing where it does not say who goes first.
[[nodiscard]] constexpr std::optional<SignalKind> kind_of(SignalMeaning meaning) {
  switch (meaning) {
    case SignalMeaning::priority:
      return SignalKind::priority;
    case SignalMeaning::give_way:
      return SignalKind::give_way;
    case SignalMeaning::stop:
      return SignalKind::stop;
    case SignalMeaning::light:
    case SignalMeaning::bulb:
      return SignalKind::light;
    case SignalMeaning::speed_limit:
    case SignalMeaning::other:
      break;
  }
  return std::nullopt;
}

/// Which ways an arrow light is for, as bits.
enum class Arrow : std::uint8_t { none = 0, left = 1, straight = 2, right = 4 };

[[nodiscard]] constexpr Arrow operator|(Arrow a, Arrow b) {
  return static_cast<Arrow>(static_cast<std::uint8_t>(a) | static_cast<std::uint8_t>(b));
}
[[nodiscard]] constexpr bool has(Arrow arrow, Arrow way) {
  return (static_cast<std::uint8_t>(arrow) & static_cast<std::uint8_t>(way)) != 0;
}

/// The arrow of a way that turns by so much [rad], positive to the left.
[[nodiscard]] constexpr Arrow arrow_of_turn(double turn) {
  constexpr double least = 0.5;  // own choice
  return turn > least ? Arrow::left : turn < -least ? Arrow::right : Arrow::straight;
}

/// A row of the catalogue. Country "" stands for OpenDRIVE's own numbers and for the German ones, which files of all
/// countries use; subtype "" for any.
struct SignalCode {
  std::string_view country, type, subtype;
  SignalMeaning meaning{};
  bool has_arrow = false;  ///< the subtype says which
};

/// What a sign or light says, and the ways that it is for where it is an arrow light.
struct SignalSense {
  SignalMeaning meaning{};
  Arrow arrow = Arrow::none;  ///< none: for all ways
};

/// The codes that are known, in lower case. Sources: the tables of signs and of bulbs of esmini (77028d8), CARLA's list
/// of types (0f5e668), Lanelet2's tagging rules (ae39c8d), commonroad-io's lists by country (8275861); US R1-2 from the
/// MUTCD, second-hand.
inline constexpr std::array signal_codes{
    SignalCode{"", "1000001", "", SignalMeaning::light},
    SignalCode{"", "1000009", "", SignalMeaning::light},
    SignalCode{"", "1000016", "", SignalMeaning::light},
    SignalCode{"", "1000017", "", SignalMeaning::light},
    SignalCode{"", "1000018", "", SignalMeaning::light},
    SignalCode{"", "1000019", "", SignalMeaning::light},
    SignalCode{"", "1000010", "", SignalMeaning::light, true},
    SignalCode{"", "1000011", "", SignalMeaning::light, true},
    SignalCode{"", "1000008", "", SignalMeaning::bulb, true},
    SignalCode{"", "1000012", "", SignalMeaning::bulb, true},
    SignalCode{"", "1000020", "", SignalMeaning::bulb, true},
    SignalCode{"", "1000002", "", SignalMeaning::other},
    SignalCode{"", "1000003", "", SignalMeaning::other},
    SignalCode{"", "1000004", "", SignalMeaning::other},
    SignalCode{"", "1000007", "", SignalMeaning::other},
    SignalCode{"", "1000013", "", SignalMeaning::other},
    SignalCode{"", "1000014", "", SignalMeaning::other},
    SignalCode{"", "1000015", "", SignalMeaning::other},
    SignalCode{"", "205", "", SignalMeaning::give_way},
    SignalCode{"", "206", "", SignalMeaning::stop},
    SignalCode{"", "301", "", SignalMeaning::priority},
    SignalCode{"", "306", "", SignalMeaning::priority},
    SignalCode{"", "274", "", SignalMeaning::speed_limit},
    SignalCode{"", "274.1", "", SignalMeaning::speed_limit},
    SignalCode{"", "208", "", SignalMeaning::other},
    SignalCode{"", "215", "", SignalMeaning::other},
    SignalCode{"", "267", "", SignalMeaning::other},
    SignalCode{"", "274.2", "", SignalMeaning::other},
    SignalCode{"", "278", "", SignalMeaning::other},
    SignalCode{"", "294", "", SignalMeaning::other},
    SignalCode{"", "307", "", SignalMeaning::other},
    SignalCode{"", "310", "", SignalMeaning::other},
    SignalCode{"", "311", "", SignalMeaning::other},
    SignalCode{"us", "r1-1", "", SignalMeaning::stop},
    SignalCode{"us", "r1-2", "", SignalMeaning::give_way},
    SignalCode{"us", "r1-3", "", SignalMeaning::stop},
    SignalCode{"us", "r2-1", "", SignalMeaning::speed_limit},
    SignalCode{"us", "r5-1", "", SignalMeaning::other},
    SignalCode{"au", "r1-1", "", SignalMeaning::stop},
    SignalCode{"au", "r1-2", "", SignalMeaning::give_way},
    SignalCode{"es", "r1", "", SignalMeaning::give_way},
    SignalCode{"es", "r2", "", SignalMeaning::stop},
    SignalCode{"es", "r301", "", SignalMeaning::speed_limit},
    SignalCode{"se", "c", "31", SignalMeaning::speed_limit},
    SignalCode{"cn", "jin", "", SignalMeaning::speed_limit},
    SignalCode{"cn", "shi", "", SignalMeaning::other},
    SignalCode{"fr", "b14", "", SignalMeaning::speed_limit},
    SignalCode{"be", "c43", "", SignalMeaning::speed_limit},
    SignalCode{"hr", "b31", "", SignalMeaning::speed_limit},
    SignalCode{"ar", "r15", "", SignalMeaning::speed_limit},
    SignalCode{"ru", "3.24", "", SignalMeaning::speed_limit},
    SignalCode{"gr", "\xCE\xA1-32", "", SignalMeaning::speed_limit},  // a capital rho
};

namespace detail {

[[nodiscard]] inline std::string lower_case(std::string_view word) {
  std::string text(word);
  for (char& letter : text)
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  return text;
}

/// The number of a catalogue without the dots that group its digits by three: "1.000.001" is 1000001, "274.1" stays.
[[nodiscard]] inline std::string without_groups(std::string const& type) {
  std::string text;
  auto const is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (std::size_t i = 0; i < type.size(); ++i) {
    auto const group = std::string_view(type).substr(i + 1, 3);
    bool const ends = i + 4 >= type.size() || type[i + 4] == '.';
    if (type[i] == '.' && group.size() == 3 && ends && std::all_of(group.begin(), group.end(), is_digit)) continue;
    text += type[i];
  }
  return text;
}

/// The ways that an arrow light is for, by OpenDRIVE's subtypes (as esmini's table of bulbs has them).
[[nodiscard]] constexpr Arrow arrow_of_subtype(std::string_view subtype) {
  if (subtype == "10" || subtype == "60" || subtype == "80") return Arrow::left;  // half left, down left
  if (subtype == "20" || subtype == "70" || subtype == "90") return Arrow::right;
  if (subtype == "30") return Arrow::straight;
  if (subtype == "40") return Arrow::straight | Arrow::left;
  if (subtype == "50") return Arrow::straight | Arrow::right;
  if (subtype == "100") return Arrow::left | Arrow::right;
  return Arrow::none;
}

}  // namespace detail

/// What a code says as a file has it, in any spelling: "DEU" or "Germany" for the country, "1.000.001" for a number,
/// "274-55" for a type with its subtype; a subtype of "-1" or "none" is none. Nothing where it is not known.
[[nodiscard]] inline std::optional<SignalSense> find_signal(std::string_view country, std::string_view type,
                                                            std::string_view subtype) {
  // The words of ISO 3166 for the countries of the catalogue.
  static constexpr std::array<std::array<std::string_view, 3>, 12> countries{{{"us", "usa", "united states"},
                                                                              {"us", "pri", "puerto rico"},
                                                                              {"au", "aus", "australia"},
                                                                              {"es", "esp", "spain"},
                                                                              {"se", "swe", "sweden"},
                                                                              {"cn", "chn", "china"},
                                                                              {"fr", "fra", "france"},
                                                                              {"be", "bel", "belgium"},
                                                                              {"hr", "hrv", "croatia"},
                                                                              {"ar", "arg", "argentina"},
                                                                              {"ru", "rus", "russia"},
                                                                              {"gr", "grc", "greece"}}};
  auto const word = detail::lower_case(country);
  std::string_view where;
  for (auto const& words : countries)
    if (std::find(words.begin(), words.end(), word) != words.end()) where = words.front();
  auto const what = detail::without_groups(detail::lower_case(type));
  auto const part = detail::lower_case(subtype);
  for (auto const of : {where, std::string_view()})
    for (auto const& code : signal_codes)
      if (code.country == of && code.type == what && (code.subtype.empty() || code.subtype == part))
        return SignalSense{code.meaning, code.has_arrow ? detail::arrow_of_subtype(part) : Arrow::none};
  auto const dash = what.find('-');
  if (dash == std::string::npos || dash == 0) return std::nullopt;
  return find_signal(country, what.substr(0, dash), what.substr(dash + 1));
}

}  // namespace cambium::inline v0_1::map
