#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/planner/search/selection_policy.hpp"

namespace cambium::inline v0_1 {

/// How a planner updates its beliefs about others as it observes them.
struct BeliefParameters {
  double forgetting = 0.02;
  double floor = 1e-3;
  double speed_deviation = 0.05;
  double range = 60.0;
  double interval = 0.2;

  static constexpr char const* name = "belief";
  static constexpr char const* summary = "how beliefs about others follow observations: Bayes' rule with forgetting";
  static constexpr auto parameters() {
    using P = BeliefParameters;
    return parameter_list(
        parameter("forgetting", &P::forgetting, "-", Range{0, 1},
                  "share spread evenly over all hypotheses before each observation, because intentions change"),
        parameter("floor", &P::floor, "-", Range{0, 0.5},
                  "lower bound of each probability, times the number of hypotheses"),
        parameter("speed_deviation", &P::speed_deviation, "m/s", Range{1e-3, 10},
                  "standard deviation of an observed speed from the one that a hypothesis predicts"),
        parameter("range", &P::range, "m", non_negative,
                  "it learns about the 6 nearest agents within; for all others the hypotheses stay equally likely"),
        parameter("interval", &P::interval, "s", Range{0.01, 60},
                  "time between two calls of `think`; a behaviour observes in every step instead"));
  }
};

/// Probabilities of up to 8 hypotheses about another agent, updated by Bayes' rule. A value of fixed size.
class Belief {
 public:
  static constexpr std::size_t capacity = 8;

  Belief() = default;
  /// Equal probabilities for `hypotheses` hypotheses. Throws `ParameterError` unless there are 1 to `capacity`.
  explicit Belief(std::size_t hypotheses) : size_(static_cast<std::uint8_t>(hypotheses)) {
    if (hypotheses < 1 || hypotheses > capacity)
      throw ParameterError("belief", "has " + std::to_string(hypotheses) + " hypotheses", "give 1 to 8");
    std::fill_n(weights_.begin(), size_, 1.0f / static_cast<float>(size_));
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Of `hypothesis`, a number below `size()`.
  [[nodiscard]] double probability(std::size_t hypothesis) const { return static_cast<double>(weights_[hypothesis]); }
  [[nodiscard]] std::size_t most_likely() const {
    return static_cast<std::size_t>(std::max_element(weights_.begin(), weights_.begin() + size_) - weights_.begin());
  }

  /// Updates the probabilities by an observation. `likelihoods`: that of the observation under each hypothesis; a
  /// common factor cancels. Does nothing if all are zero, or one is negative or not finite. Throws `ParameterError`
  /// unless there is one for each hypothesis.
  void update(std::span<double const> likelihoods, BeliefParameters const& parameters = {}) {
    if (likelihoods.size() != size_)
      throw ParameterError(
          "belief",
          "got " + std::to_string(likelihoods.size()) + " likelihoods for " + std::to_string(size_) + " hypotheses",
          "give one for each");
    std::array<double, capacity> posterior{};
    double sum = 0.0;
    for (std::size_t h = 0; h < size_; ++h) {
      double const prior = (1.0 - parameters.forgetting) * probability(h) + parameters.forgetting / size_;
      posterior[h] = prior * likelihoods[h];
      sum += posterior[h];
      if (!(likelihoods[h] >= 0.0)) return;
    }
    if (!(sum > 0.0 && std::isfinite(sum))) return;
    double total = 0.0;
    for (std::size_t h = 0; h < size_; ++h) {
      posterior[h] = std::max(posterior[h] / sum, parameters.floor / size_);
      total += posterior[h];
    }
    for (std::size_t h = 0; h < size_; ++h) weights_[h] = static_cast<float>(posterior[h] / total);
  }

  /// A hypothesis, drawn by its probability.
  template <BitStream Stream>
  [[nodiscard]] std::size_t sample(Stream& stream) const {
    return detail::drawn(size_, stream, [&](std::size_t h) { return probability(h); });
  }

  static constexpr char const* name = "belief_about_agent";
  static constexpr auto parameters() {
    using P = Belief;
    return parameter_list(parameter("weights", &P::weights_, "-", any_finite, "of the hypotheses"),
                          parameter("size", &P::size_, "-", Range{1, 8}, "number of hypotheses"));
  }

  friend bool operator==(Belief const&, Belief const&) = default;

 private:
  std::array<float, capacity> weights_{1.0f};
  std::uint8_t size_ = 1;
};

}  // namespace cambium::inline v0_1
