#pragma once

#include <algorithm>
#include <limits>
#include <string>

#include "cambium/core/distributions.hpp"
#include "cambium/core/one_of.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium {

/// A normal distribution whose draws are clipped: what is below `low` becomes `low`, what is above `high`, `high`.
struct ClippedNormal {
  double mean = 0.0;
  double deviation = 1.0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  static constexpr char const* name = "clipped_normal";
  static constexpr auto parameters() {
    using P = ClippedNormal;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return parameter_list(
        parameter("mean", &P::mean, "-", any_finite, "before clipping"),
        parameter("deviation", &P::deviation, "-", non_negative, "standard deviation before clipping"),
        parameter("low", &P::low, "-", Range{-infinity, infinity}, "lowest value"),
        parameter("high", &P::high, "-", Range{-infinity, infinity}, "highest value"));
  }
  /// Throws `ParameterError` if `low` is above `high`.
  void check(std::string const& where) const {
    if (!(low <= high)) throw ParameterError(where, "its low is above its high", "swap them");
  }

  template <BitStream Stream>
  [[nodiscard]] double operator()(Stream& stream) const {
    return std::clamp(Normal{mean, deviation}(stream), low, high);
  }
};

/// How a number is drawn. Takes one draw. In files: {"uniform": {"low": 10, "high": 20}}.
struct Distribution : OneOf<Uniform, ClippedNormal> {
  using OneOf::OneOf;

  template <BitStream Stream>
  [[nodiscard]] double operator()(Stream& stream) const {
    return visit([&](auto const& law) { return law(stream); });
  }

  [[nodiscard]] double lowest() const {
    return visit([](auto const& law) { return law.low; });
  }
  [[nodiscard]] double highest() const {
    return visit([](auto const& law) { return law.high; });
  }
};

/// Throws `ParameterError` at `where` unless all that a distribution draws is within `range`.
inline void check_draws(Distribution const& drawn, Range range, char const* name, char const* unit,
                        std::string const& where) {
  for (double const bound : {drawn.lowest(), drawn.highest()})
    if (!(bound >= range.low && bound <= range.high))
      throw ParameterError(where + "." + name, "draws up to " + detail::with_unit(detail::number_text(bound), unit),
                           "keep it in " + detail::with_unit(detail::range_text({name, unit, range, ""}), unit));
}

}  // namespace cambium
