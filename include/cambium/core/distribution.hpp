#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "cambium/core/distributions.hpp"
#include "cambium/core/one_of.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium::inline v0_1 {

/// A normal distribution of which only what is between `low` and `high` is drawn, by inversion: takes one draw, and a
/// larger random number never gives a smaller value. Bounds that are both farther than 37 deviations on one side of the
/// mean draw the nearer one.
struct TruncatedNormal {
  double mean = 0.0;
  double deviation = 1.0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  static constexpr char const* name = "truncated_normal";
  static constexpr auto parameters() {
    using P = TruncatedNormal;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return parameter_list(parameter("mean", &P::mean, "-", any_finite, "of the whole normal distribution"),
                          parameter("deviation", &P::deviation, "-", non_negative, "standard deviation of the whole"),
                          parameter("low", &P::low, "-", Range{-infinity, infinity}, "lowest value"),
                          parameter("high", &P::high, "-", Range{-infinity, infinity}, "highest value"));
  }
  /// Throws `ParameterError` if `low` is above `high`.
  void check(std::string const& where) const {
    if (!(low <= high)) throw ParameterError(where, "its low is above its high", "swap them");
  }

  template <BitStream Stream>
  [[nodiscard]] double operator()(Stream& stream) const {
    bool const above = low > mean;  // drawn on the other side of the mean, where probabilities are small and exact
    double const u = open_uniform01(stream);
    double const least = probability_below(above ? high : low, above),
                 most = probability_below(above ? low : high, above);
    double const p = std::fma(most - least, above ? 1.0 - u : u, least);
    if (!(p > 0.0 && p < 1.0)) return std::max(low, std::min(mean, high));
    double const z = detail::normal_quantile(p);
    return std::max(low, std::min(std::fma(deviation, above ? -z : z, mean), high));
  }

 private:
  [[nodiscard]] double probability_below(double bound, bool mirrored) const {
    if (bound == mean) return 0.5;
    double const z = (bound - mean) / deviation;
    return detail::normal_probability(mirrored ? -z : z);
  }
};

/// How a number is drawn. Takes one draw. In files: {"uniform": {"low": 10, "high": 20}}.
struct Distribution : OneOf<Uniform, TruncatedNormal> {
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
  for (bool const low : {true, false}) {
    double const bound = low ? drawn.lowest() : drawn.highest();
    if (!(bound >= range.low && bound <= range.high))
      throw ParameterError(
          where + "." + name,
          (low ? "draws down to " : "draws up to ") + detail::with_unit(detail::number_text(bound), unit),
          "keep it in " + detail::with_unit(detail::range_text({name, unit, range, ""}), unit));
  }
}

}  // namespace cambium::inline v0_1
