#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <limits>
#include <utility>

#include "cambium/core/ids.hpp"
#include "cambium/evaluation/evaluator.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

/// A metric of one agent's run: what an evaluator cannot say, because it needs memory. `observe` is called with the
/// world before the first step (`dt` 0) and after each step of `dt` [s]; `value` may be asked at any time. A metric
/// with `static constexpr bool needs_history = true` needs a world that keeps a history.
template <class M, class World>
concept MetricFor = std::copyable<M> && requires(M metric, World& world) {
  metric.observe(world, Slot{}, 0.2);
  { metric.value() } -> std::convertible_to<double>;
};

/// How `Over` sums up the values of an evaluator.
enum class Fold : std::uint8_t {
  least,     ///< the smallest value; infinity without any
  most,      ///< the largest value; minus infinity without any
  mean,      ///< over time; 0 without any
  integral,  ///< value times seconds
  times,     ///< how often the value turned from zero to another
  longest,   ///< the longest time for which the value was not zero [s]
};

/// The values of an evaluator over a run, summed up. Frames in which the agent is not driving do not count.
template <class E, Fold fold>
struct Over {
  E evaluator{};

  Over() = default;
  /// Summarises `own`.
  explicit Over(E own) : evaluator(std::move(own)) {}

  template <class World>
  void observe(World& world, Slot slot, double dt) {
    if (world.frame().agents[slot].status != AgentStatus::driving) return;
    auto const value = static_cast<double>(evaluator(world, slot));
    if constexpr (fold == Fold::least)
      so_far_ = std::min(so_far_, value);
    else if constexpr (fold == Fold::most)
      so_far_ = std::max(so_far_, value);
    else if constexpr (fold == Fold::times)
      so_far_ += value != 0.0 && last_ == 0.0 ? 1.0 : 0.0;
    else if constexpr (fold == Fold::longest)
      so_far_ = std::max(so_far_, lasts_ = value != 0.0 ? lasts_ + dt : 0.0);
    else
      so_far_ += value * dt;
    last_ = value;
    duration_ += dt;
  }

  [[nodiscard]] double value() const {
    if constexpr (fold == Fold::mean) return duration_ > 0.0 ? so_far_ / duration_ : 0.0;
    return so_far_;
  }

 private:
  double so_far_ = fold == Fold::least  ? std::numeric_limits<double>::infinity()
                   : fold == Fold::most ? -std::numeric_limits<double>::infinity()
                                        : 0.0;
  double last_ = 0.0, duration_ = 0.0, lasts_ = 0.0;
};

/// Least value of `E` so far.
template <class E>
using Least = Over<E, Fold::least>;
/// Largest value of `E` so far.
template <class E>
using Most = Over<E, Fold::most>;
/// Mean of `E` over time.
template <class E>
using MeanOf = Over<E, Fold::mean>;
/// Integral of `E` over time.
template <class E>
using Integral = Over<E, Fold::integral>;
/// How often `E` became true.
template <class E>
using Times = Over<E, Fold::times>;
/// The longest time for which `E` was true [s].
template <class E>
using LongestTime = Over<E, Fold::longest>;

}  // namespace cambium::inline v0_1
