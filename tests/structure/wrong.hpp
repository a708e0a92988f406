/// What each program of wrong/ begins with: it is included, precompiled, before the program's first line.
#pragma once

#include <memory>
#include <string>
#include <tuple>

#include <cambium/cambium.hpp>
#include <cambium/evaluation/rules.hpp>
#include <cambium/scenario/traffic_inflow.hpp>
#include <cambium/snapshot.hpp>

template <class... Models>
using WorldOf = cambium::World<cambium::BehaviorSet<Models...>, cambium::InterpolateExecution, cambium::SingleTrack>;
using Sim = WorldOf<cambium::IdmClassic>;

/// A prediction world of a tree search.
using Predicted = WorldOf<cambium::MacroActions, cambium::IdmClassic>;

/// A behaviour that has a plan, and nothing else.
struct Idle {
  template <class View>
  cambium::Plan<View> plan(View const&, cambium::NoMemory&, double) const {
    return {};
  }
};

/// A behaviour with the memory `M`, and one without a description.
template <class M>
struct Remembers {
  using Memory = M;
  static constexpr char const* name = "remembers";
  static constexpr auto parameters() { return cambium::parameter_list(); }
  template <class View>
  cambium::Plan<View> plan(View const&, Memory&, double) const {
    return {};
  }
};
template <class M>
struct Undescribed {
  using Memory = M;
  template <class View>
  cambium::Plan<View> plan(View const&, Memory&, double) const {
    return {};
  }
};

/// A selection policy with the statistics `S` of each arm, which have a field `best`.
template <class S>
struct Greedy {
  using Statistics = S;
  static constexpr char const* name = "greedy";
  static constexpr auto parameters() { return cambium::parameter_list(); }
  template <class Arms, class Random>
  std::size_t select(Arms const& arms, std::uint32_t, cambium::ReturnScale const&, Random&) const {
    return cambium::detail::best_arm(arms, [](auto const& arm) { return arm.statistics.best; });
  }
  template <class Arms>
  void update(Arms const& arms, std::size_t chosen, double score, cambium::ReturnScale const&) const {
    arms[chosen].statistics.best = score;
  }
};
template <class S>
using GreedyPlanner = cambium::Mcts<Predicted, cambium::MacroActions, cambium::TrafficReward, cambium::IdmClassic,
                                    cambium::MctsOptions<Greedy<S>>>;

/// An observer without a description.
struct Blurred {
  double error = 0.1;
  static constexpr bool perfect = false;
  template <class S>
  S observe(S seen, bool, cambium::RandomStream const&) const {
    seen.x += error;
    return seen;
  }
};
using BlurredSim = cambium::World<cambium::BehaviorSet<cambium::IdmClassic>, cambium::InterpolateExecution,
                                  cambium::SingleTrack, Blurred>;
