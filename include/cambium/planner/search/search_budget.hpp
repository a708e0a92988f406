#pragma once

#include <algorithm>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <limits>

#include "cambium/core/parameters.hpp"

namespace cambium {

namespace detail {

/// The `i`th part of `whole` things dealt out to `n`.
[[nodiscard]] constexpr std::size_t part_of(std::size_t whole, std::size_t i, std::size_t n) {
  return whole / n + (i < whole % n ? 1 : 0);
}

}  // namespace detail

/// How long a planner goes on. An iteration is one of a tree search, or one candidate of a planner that weighs a list.
/// `most()`: iterations that it never exceeds; `start()`; `goes_on(done)`: whether there is to be another one after
/// `done`; `part(i, n)`: what the `i`th of `n` searches that share it gets. It may have `expected()`: how many to make
/// room for from the start (else for `most()`).
template <class B>
concept SearchBudget = std::copyable<B> && requires(B budget, B const fixed, std::size_t done) {
  { fixed.most() } -> std::same_as<std::size_t>;
  budget.start();
  { budget.goes_on(done) } -> std::same_as<bool>;
  { fixed.part(done, done) } -> std::same_as<B>;
};

/// So many iterations: the search is a pure function of state, parameters and seed.
struct IterationBudget {
  std::size_t iterations = 1000;

  static constexpr char const* name = "iteration_budget";
  static constexpr char const* summary = "so many iterations";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("iterations", &IterationBudget::iterations, "-", Range{1, 1e9}, "how many there are"));
  }

  [[nodiscard]] std::size_t most() const { return iterations; }
  void start() {}
  [[nodiscard]] IterationBudget part(std::size_t i, std::size_t n) const { return {detail::part_of(iterations, i, n)}; }
  [[nodiscard]] bool goes_on(std::size_t done) const { return done < iterations; }
};
static_assert(SearchBudget<IterationBudget>);

/// So much time of the wall clock: the clock is read before each iteration but the first, which is always there.
/// Results depend on the machine and its load. A tree that grows larger than any before it allocates.
struct TimeBudget {
  double duration = 0.01;
  std::size_t iterations = 1'000'000;

  static constexpr char const* name = "time_budget";
  static constexpr char const* summary = "so much time of the wall clock";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("duration", &TimeBudget::duration, "s", Range{1e-6, 86'400}, "time for one search"),
        parameter("iterations", &TimeBudget::iterations, "-", Range{1, 1e9}, "never more than so many"));
  }

  [[nodiscard]] std::size_t most() const { return iterations; }
  [[nodiscard]] std::size_t expected() const { return std::min<std::size_t>(iterations, 512); }
  [[nodiscard]] TimeBudget part(std::size_t i, std::size_t n) const {
    return {duration, detail::part_of(iterations, i, n)};
  }
  void start() { begin = std::chrono::steady_clock::now(); }
  [[nodiscard]] bool goes_on(std::size_t done) const {
    if (done == 0) return true;
    std::chrono::duration<double> const spent = std::chrono::steady_clock::now() - begin;
    return done < iterations && spent.count() < duration;
  }

  std::chrono::steady_clock::time_point begin{};  ///< of the search
};
static_assert(SearchBudget<TimeBudget>);

/// Every candidate is weighed: for planners that weigh a list. A tree search needs a budget that ends.
struct NoBudget {
  static constexpr char const* name = "no_budget";
  static constexpr char const* summary = "every candidate is weighed";
  static constexpr auto parameters() { return parameter_list(); }

  [[nodiscard]] std::size_t most() const { return std::numeric_limits<std::size_t>::max(); }
  void start() {}
  [[nodiscard]] NoBudget part(std::size_t, std::size_t) const { return {}; }
  [[nodiscard]] bool goes_on(std::size_t) const { return true; }
};
static_assert(SearchBudget<NoBudget>);

}  // namespace cambium
