#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/observer/observer_model.hpp"

namespace cambium::inline v0_1 {

/// Normally distributed errors of a perceived state: means, standard deviations and correlations of the errors along
/// and across the heading, of the heading and of the speed.
struct ObservationNoise {
  double mean_along = 0.0;
  double mean_across = 0.0;
  double mean_heading = 0.0;
  double mean_speed = 0.0;
  double along = 0.0;
  double across = 0.0;
  double heading = 0.0;
  double speed = 0.0;
  double along_across = 0.0;
  double along_heading = 0.0;
  double along_speed = 0.0;
  double across_heading = 0.0;
  double across_speed = 0.0;
  double heading_speed = 0.0;

  static constexpr char const* name = "observation_noise";
  static constexpr char const* summary =
      "normal errors of position, heading and speed: means, deviations, correlations";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    using P = ObservationNoise;
    constexpr Range one{-1, 1}, metres{-1000, 1000}, spread{0, 1000};
    return parameter_list(
        parameter("mean_along", &P::mean_along, "m", metres, "mean error along the heading"),
        parameter("mean_across", &P::mean_across, "m", metres, "mean error across the heading, left positive"),
        parameter("mean_heading", &P::mean_heading, "rad", Range{-4, 4}, "mean error of the heading"),
        parameter("mean_speed", &P::mean_speed, "m/s", metres, "mean error of the speed"),
        parameter("along", &P::along, "m", spread, "standard deviation along the heading"),
        parameter("across", &P::across, "m", spread, "standard deviation across the heading"),
        parameter("heading", &P::heading, "rad", Range{0, 4}, "standard deviation of the heading"),
        parameter("speed", &P::speed, "m/s", spread, "standard deviation of the speed"),
        parameter("along_across", &P::along_across, "-", one, "correlation"),
        parameter("along_heading", &P::along_heading, "-", one, "correlation"),
        parameter("along_speed", &P::along_speed, "-", one, "correlation"),
        parameter("across_heading", &P::across_heading, "-", one, "correlation"),
        parameter("across_speed", &P::across_speed, "-", one, "correlation"),
        parameter("heading_speed", &P::heading_speed, "-", one, "correlation"));
  }

  /// Throws `ParameterError` if the correlation matrix is not positive semidefinite.
  void check(std::string const& where) const {
    auto const l = factor();
    auto const c = correlations();
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double product = 0.0;
        for (std::size_t k = 0; k <= j; ++k) product += l[i][k] * l[j][k];
        if (!(std::abs(product - c[i][j]) <= 1e-9))
          throw ParameterError(where, "its correlations contradict each other",
                               "choose them so that their matrix is positive semidefinite");
      }
  }

  using Vector = std::array<double, 4>;  ///< along, across, heading, speed

  /// The error that results from four independent standard normal numbers.
  [[nodiscard]] Vector error(Vector const& z) const {
    auto const l = factor();
    Vector const deviation{along, across, heading, speed};
    Vector error{mean_along, mean_across, mean_heading, mean_speed};
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j <= i; ++j) error[i] += deviation[i] * l[i][j] * z[j];
    return error;
  }

 private:
  using Matrix = std::array<Vector, 4>;

  [[nodiscard]] Matrix correlations() const {
    return {{{1, along_across, along_heading, along_speed},
             {along_across, 1, across_heading, across_speed},
             {along_heading, across_heading, 1, heading_speed},
             {along_speed, across_speed, heading_speed, 1}}};
  }

  /// Lower triangular factor of the correlation matrix (Cholesky); a zero pivot leaves its column empty.
  [[nodiscard]] Matrix factor() const {
    constexpr double vanishing = 1e-12;
    auto const c = correlations();
    Matrix l{};
    for (std::size_t j = 0; j < 4; ++j) {
      double pivot = c[j][j];
      for (std::size_t k = 0; k < j; ++k) pivot -= l[j][k] * l[j][k];
      if (!(pivot > vanishing)) continue;
      l[j][j] = std::sqrt(pivot);
      for (std::size_t i = j + 1; i < 4; ++i) {
        double sum = c[i][j];
        for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
        l[i][j] = sum / l[j][j];
      }
    }
    return l;
  }
};

/// Perceives states with normally distributed errors: `own` applies to the agent itself, `others` to all other agents.
/// The errors of each pair of agents are independent of those of other pairs.
///
/// Errors may last. Every `lasting` steps the observer draws new standard normal numbers. In between, the old numbers
/// turn into the new ones as z_old cos(a) + z_new sin(a), with a from 0 to a quarter turn, so that the error keeps its
/// distribution in every step. Two steps in one interval are correlated by the cosine of the angle between them; steps
/// `2 * lasting` apart are independent. With `lasting` 1, each step has new errors. Perceived speeds may be negative.
struct ParametricObserver {
  ObservationNoise own{};
  ObservationNoise others{};
  int lasting = 1;

  static constexpr bool perfect = false;
  static constexpr char const* name = "parametric";
  static constexpr char const* summary =
      "state + error, error ~ N(mean, covariance), about itself and about others, new in each step or lasting";
  static constexpr char const* source = "normal distribution; after BARK";
  static constexpr auto parameters() {
    using P = ParametricObserver;
    return parameter_list(parameter("own", &P::own, "errors of its own state"),
                          parameter("others", &P::others, "errors of the others' states"),
                          parameter("lasting", &P::lasting, "-", Range{1, 1e6}, "steps between new errors"));
  }

  template <MotionState S>
  [[nodiscard]] S observe(S const& truth, bool is_own, RandomStream const& random) const {
    auto const [along, across, heading, speed] = (is_own ? own : others).error(numbers(random));
    auto const [sin, cos] = portable::sin_cos(truth.heading);
    S seen = truth;
    seen.x += along * cos - across * sin;
    seen.y += along * sin + across * cos;
    seen.heading += heading;
    seen.speed += speed;
    return seen;
  }

 private:
  using Vector = ObservationNoise::Vector;

  [[nodiscard]] static Vector draw(RandomStream random) {
    Vector z;
    for (auto& value : z) value = Normal{}(random);
    return z;
  }

  /// Four independent standard normal numbers.
  [[nodiscard]] Vector numbers(RandomStream const& random) const {
    auto const period = static_cast<std::uint32_t>(std::max(lasting, 1));
    auto const passed = random.step() % period, begin = random.step() - passed;
    if (passed == 0) return draw(random);
    auto const [sin, cos] = portable::sin_cos(0.5 * geometry::pi * passed / period);
    Vector z = draw(random.at_step(begin));
    Vector const next = draw(random.at_step(begin + period));
    for (std::size_t i = 0; i < z.size(); ++i) z[i] = z[i] * cos + next[i] * sin;
    return z;
  }
};
static_assert(ObserverModel<ParametricObserver>);

}  // namespace cambium::inline v0_1
