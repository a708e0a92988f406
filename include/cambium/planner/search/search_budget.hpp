#pragma once

#include <algorithm>
#include <chrono>
#include <concepts>
#include <cstddef>

#include "cambium/core/parameters.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// The `i`th of `n` nearly equal parts of `whole`.
[[nodiscard]] constexpr std::size_t part_of(std::size_t whole, std::size_t i, std::size_t n) {
  return whole / n + (i < whole % n ? 1 : 0);
}

}  // namespace detail

/// How long a planner continues. An iteration is one of a tree search, or one candidate of a planner that compares a
/// list. Prediction counts, but the course that a report shows is simulated after the budget has ended.
///
/// - `start()`: called when planning begins, and again when its search begins; only the first call counts.
/// - `goes_on(done)`: whether another iteration follows after `done` of them; planners that compare candidates look at
///   one, whatever it says.
template <class B>
concept SearchBudget = std::copyable<B> && requires(B budget, std::size_t done) {
  budget.start();
  { budget.goes_on(done) } -> std::same_as<bool>;
};

/// The budget of a tree search, which does not end by itself. It also has
///
/// - `most()`: upper limit of the number of iterations.
/// - `part(i, n)`: the share of the `i`th of `n` searches that share the budget.
/// - `expected()`, optional: number of iterations for which memory is reserved at the start; `most()` by default.
template <class B>
concept TreeSearchBudget = SearchBudget<B> && requires(B const budget, std::size_t i) {
  { budget.most() } -> std::same_as<std::size_t>;
  { budget.part(i, i) } -> std::same_as<B>;
};

/// A fixed number of iterations. The search is then a pure function of state, parameters and seed.
struct IterationBudget {
  std::size_t iterations = 1000;

  static constexpr char const* name = "iteration_budget";
  static constexpr char const* summary = "a fixed number of iterations";
  static constexpr auto parameters() {
    return parameter_list(parameter("iterations", &IterationBudget::iterations, "-", Range{1, 1e9}, "their number"));
  }

  [[nodiscard]] std::size_t most() const { return iterations; }
  void start() {}
  [[nodiscard]] IterationBudget part(std::size_t i, std::size_t n) const { return {detail::part_of(iterations, i, n)}; }
  [[nodiscard]] bool goes_on(std::size_t done) const { return done < iterations; }
};
static_assert(TreeSearchBudget<IterationBudget>);

/// A limit on wall-clock time. The clock is read before every iteration except the first, which always runs. Results
/// depend on the machine and its load. A tree that outgrows all previous ones allocates.
struct TimeBudget {
  double duration = 0.01;
  std::size_t iterations = 1'000'000;

  static constexpr char const* name = "time_budget";
  static constexpr char const* summary = "a limit on wall-clock time";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("duration", &TimeBudget::duration, "s", Range{1e-6, 86'400}, "time for one search"),
        parameter("iterations", &TimeBudget::iterations, "-", Range{1, 1e9}, "greatest number of iterations"));
  }

  [[nodiscard]] std::size_t most() const { return iterations; }
  [[nodiscard]] std::size_t expected() const { return std::min<std::size_t>(iterations, 512); }
  [[nodiscard]] TimeBudget part(std::size_t i, std::size_t n) const {
    return {duration, detail::part_of(iterations, i, n), begin};
  }
  void start() {
    if (begin == std::chrono::steady_clock::time_point{}) begin = std::chrono::steady_clock::now();
  }
  [[nodiscard]] bool goes_on(std::size_t done) const {
    if (done == 0) return true;
    std::chrono::duration<double> const spent = std::chrono::steady_clock::now() - begin;
    return done < iterations && spent.count() < duration;
  }

  std::chrono::steady_clock::time_point begin{};  ///< when it started
};
static_assert(TreeSearchBudget<TimeBudget>);

/// No limit: planners that compare a list score every candidate. A tree search needs a budget that ends.
struct NoBudget {
  static constexpr char const* name = "no_budget";
  static constexpr char const* summary = "no limit: every candidate is scored";
  static constexpr auto parameters() { return parameter_list(); }

  void start() {}
  [[nodiscard]] bool goes_on(std::size_t) const { return true; }
};
static_assert(SearchBudget<NoBudget>);

}  // namespace cambium::inline v0_1
