#pragma once

#include <algorithm>
#include <cstdint>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/law/road_rules.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"

namespace cambium {

/// A driver who sometimes lets others in. While it yields, it follows, besides its own leader, the next vehicle ahead
/// in each neighbouring lane that soon ends or joins its own, if comfortable braking suffices. Periods of yielding and
/// insisting alternate; each driver starts somewhere in between.
template <class Distribution>
struct Yielding {
  bool enabled = false;
  Distribution yields{2.0, 6.0};
  Distribution insists{5.0, 20.0};
  double horizon = 150.0;

  static constexpr char const* name = "yielding";
  static constexpr char const* summary =
      "sometimes follows the next vehicle ahead in a neighbouring lane that ends or joins, if comfortable braking "
      "suffices";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    return parameter_list(parameter("enabled", &Yielding::enabled, "whether it ever lets others in"),
                          parameter("yields", &Yielding::yields, "s", {}, "duration of yielding, at least 0.1 s"),
                          parameter("insists", &Yielding::insists, "s", {}, "duration of insisting, at least 0.1 s"),
                          parameter("horizon", &Yielding::horizon, "m", Range{0, 10'000},
                                    "lanes that end or join within this distance count"));
  }
};

/// IDM with parameters drawn from distributions, once for each agent or anew in every step, and periods of yielding.
/// Draws are clamped to the parameters' valid ranges. Reproducible: all random numbers come from the agent's own
/// stream.
template <class Distribution>
struct BasicIdmStochastic {
  enum class Drawn { per_agent, per_step };

  Drawn drawn = Drawn::per_agent;
  Distribution desired_speed{12.0, 18.0};
  Distribution time_headway{1.0, 2.0};
  Distribution minimum_gap{1.5, 2.5};
  Distribution maximum_acceleration{1.4, 2.0};
  Distribution comfortable_deceleration{1.4, 2.0};
  Yielding<Distribution> yielding{};
  RoadRules rules{};
  double exponent = 4.0;
  double lowest_acceleration = -5.0;
  double highest_acceleration = 8.0;
  double tolerance = 1e-4;

  static constexpr char const* name = "idm_stochastic";
  static constexpr char const* summary =
      "IDM with parameters drawn once for each agent or anew in every step; alternates between yielding and insisting";
  static constexpr char const* source = "law: Treiber, Hennecke, Helbing 2000; draws: own, after BARK";
  static constexpr auto parameters() {
    using Self = BasicIdmStochastic;
    return parameter_list(
        choice("drawn", &Self::drawn, "per_agent|per_step", "when parameters are drawn"),
        parameter("desired_speed", &Self::desired_speed, "m/s", {}, "as in IDM"),
        parameter("time_headway", &Self::time_headway, "s", {}, "as in IDM"),
        parameter("minimum_gap", &Self::minimum_gap, "m", {}, "as in IDM"),
        parameter("maximum_acceleration", &Self::maximum_acceleration, "m/s^2", {}, "as in IDM"),
        parameter("comfortable_deceleration", &Self::comfortable_deceleration, "m/s^2", {}, "as in IDM"),
        parameter("yielding", &Self::yielding, "when it lets others in"),
        parameter("rules", &Self::rules, "what it heeds besides other road users"),
        parameter("exponent", &Self::exponent, "-", Range{1, 100}, "as in IDM"),
        parameter("lowest_acceleration", &Self::lowest_acceleration, "m/s^2", Range{-50, -0.01}, "as in IDM"),
        parameter("highest_acceleration", &Self::highest_acceleration, "m/s^2", Range{0, 50}, "as in IDM"),
        parameter("tolerance", &Self::tolerance, "m/s^2", Range{1e-12, 1}, "as in IdmClassic"));
  }

  struct Memory {
    std::uint32_t person{};  ///< key of the agent's own draws; 0: not drawn yet
    float left{};            ///< of the current period [s]
    bool yields = false;
    RoadRules::Memory rules{};

    void was_set() { rules.was_set(); }

    static constexpr char const* name = "idm_stochastic_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("person", &P::person, "-", Range{0, 4294967295.0},
                                      "key of the agent's own draws; 0: not drawn yet"),
                            parameter("left", &P::left, "s", any_finite, "of the current period"),
                            parameter("yields", &P::yields, "to those who want in"),
                            parameter("rules", &P::rules, "what the rules of the road remember"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  /// The parameters drawn from `stream`, each within its valid range.
  template <BitStream Stream>
  [[nodiscard]] IdmParameters draw(Stream& stream) const {
    IdmParameters p{
        .exponent = exponent, .lowest_acceleration = lowest_acceleration, .highest_acceleration = highest_acceleration};
    p.desired_speed = std::clamp(desired_speed(stream), 0.1, 100.0);
    p.time_headway = std::clamp(time_headway(stream), 0.0, 20.0);
    p.minimum_gap = std::clamp(minimum_gap(stream), 0.0, 100.0);
    p.maximum_acceleration = std::clamp(maximum_acceleration(stream), 0.01, 20.0);
    p.comfortable_deceleration = std::clamp(comfortable_deceleration(stream), 0.01, 20.0);
    return p;
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    auto stream = view.random(purpose);
    bool const is_new = memory.person == 0;
    if (is_new) memory.person = static_cast<std::uint32_t>(stream() >> 32) | 1u;
    if (yielding.enabled && is_new) begin_somewhere(stream, memory);
    if (yielding.enabled) change_mind(stream, memory, dt);
    double const speed = std::max(0.0, view.state().speed);
    RandomStream own(memory.person, 0, 0, purpose);
    auto const p = drawn == Drawn::per_agent ? draw(own) : draw(stream);
    IdmLaw const law(p, speed, rules.desired_speed(p, view, speed));
    Strictest ahead(law);
    if (memory.yields) let_in(view, law, p.comfortable_deceleration, ahead);
    return rules.keep_lane(view, ahead, p, tolerance, dt, memory.rules);
  }

 private:
  static constexpr std::uint32_t purpose = 0x1d5;

  template <BitStream Stream>
  [[nodiscard]] double duration(Stream& stream, bool yields) const {
    return std::max(0.1, (yields ? yielding.yields : yielding.insists)(stream));
  }

  /// Starts at a random time between the begin of yielding and the end of insisting, so that drivers do not switch in
  /// unison.
  template <BitStream Stream>
  void begin_somewhere(Stream& stream, Memory& memory) const {
    double const yields = duration(stream, true), insists = duration(stream, false);
    double const left = uniform01(stream) * (yields + insists);  // insisting, which precedes yielding here
    memory.yields = left >= insists;
    memory.left = static_cast<float>(memory.yields ? left - insists : left);
  }

  /// Continues its period, or switches to the other one when it is over.
  template <BitStream Stream>
  void change_mind(Stream& stream, Memory& memory, double dt) const {
    memory.left -= static_cast<float>(dt);
    if (memory.left > 0.0f) return;
    memory.yields = !memory.yields;
    memory.left = static_cast<float>(duration(stream, memory.yields));
  }

  template <class View>
  void let_in(View const& view, IdmLaw const& law, double hardest, Strictest<IdmLaw>& ahead) const {
    auto const& at = view.place();
    auto const& own = view.corridor();
    for (auto const side : {own.pieces[at.piece].left, own.pieces[at.piece].right}) {
      if (side == none<CorridorId>) continue;
      auto const there = view.place(side);
      auto const& lane = view.road().corridors[side];
      double const s = there.s + yielding.horizon;
      bool const ends = s > lane.length() && !lane.continues && !lane.reaches_destination;
      bool const joins = lane.piece_at(s).lane == own.piece_at(at.s + yielding.horizon).lane;
      if (!ends && !joins) continue;
      auto const front = view.ahead(there);
      if (!front) continue;
      if (front->gap > 0.0 && -law(front) <= hardest) ahead.heed({front->gap, front->speed});
    }
  }
};

/// The usual variant, with uniform distributions.
using IdmStochastic = BasicIdmStochastic<Uniform>;
static_assert(BehaviorModel<IdmStochastic>);

}  // namespace cambium
