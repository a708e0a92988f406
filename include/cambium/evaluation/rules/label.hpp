#pragma once

#include <concepts>

#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium::inline v0_1 {

/// A label of one agent: an evaluator that returns a bool, as `Collision` and `OffRoad` do.
template <class L, class World>
concept AgentLabel = std::copyable<L> && requires(L const label, World& world) {
  { label(world, Slot{}) } -> std::same_as<bool>;
};

/// A label of two agents: a copyable struct with `template <class World> bool operator()(World& world, Slot slot,
/// Slot other) const`, pure as an evaluator: whether something is so between the agent that is judged and another one
/// in traffic.
template <class L, class World>
concept PairLabel = std::copyable<L> && requires(L const label, World& world) {
  { label(world, Slot{}, Slot{}) } -> std::same_as<bool>;
};

/// Whether an evaluator's value is above a threshold: makes a label of one that returns a number, such as
/// `Exceeds<Acceleration>{.threshold = 0.5}`.
template <class E>
struct Exceeds {
  E evaluator{};
  double threshold = 0.0;

  static constexpr char const* name = "exceeds";
  static constexpr char const* summary = "an evaluator's value is above a threshold";
  static constexpr auto parameters() {
    return parameter_list(parameter("evaluator", &Exceeds::evaluator, "returns a number"),
                          parameter("threshold", &Exceeds::threshold, "-", any_finite, "in the unit of the evaluator"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World& world, Slot slot) const {
    return static_cast<double>(evaluator(world, slot)) > threshold;
  }
};

/// A label of one agent, asked of the other one: `OfOther<AtLaneEnd>`.
template <class L>
struct OfOther {
  L label{};

  static constexpr char const* name = "of_other";
  static constexpr char const* summary = "a label of the other agent";
  static constexpr auto parameters() {
    return parameter_list(parameter("label", &OfOther::label, "asked of the other agent"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World& world, Slot, Slot other) const {
    return label(world, other);
  }
};

}  // namespace cambium::inline v0_1
