#pragma once

#include <algorithm>
#include <cstdint>

#include "cambium/behavior/law/constraint.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"

namespace cambium::inline v0_1 {

/// Sometimes lets others in. While it yields, the driver follows, besides its own leader, the next vehicle ahead in
/// each neighbouring lane that soon ends or joins its own, if comfortable braking suffices. Periods of yielding and
/// insisting alternate; each driver starts somewhere in between.
template <class Distribution = Uniform>
struct Yielding {
  Distribution yields{2.0, 6.0};
  Distribution insists{5.0, 20.0};
  double horizon = 150.0;

  static constexpr char const* name = "yielding";
  static constexpr char const* summary =
      "sometimes follows the next vehicle ahead in a neighbouring lane that ends or joins, if comfortable braking "
      "suffices";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    return parameter_list(parameter("yields", &Yielding::yields, "s", {}, "duration of yielding, at least 0.1 s"),
                          parameter("insists", &Yielding::insists, "s", {}, "duration of insisting, at least 0.1 s"),
                          parameter("horizon", &Yielding::horizon, "m", Range{0, 10'000},
                                    "lanes that end or join within this distance count"));
  }

  struct Memory {
    float left{};  ///< of the current period [s]
    bool yields = false;
    bool has_begun = false;

    static constexpr char const* name = "yielding_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("left", &P::left, "s", any_finite, "of the current period"),
                            parameter("yields", &P::yields, "to those who want in"),
                            parameter("has_begun", &P::has_begun, "its first period"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  template <class View, class Limits>
  void heed(View const& view, Memory& memory, Limits& limits, double dt) const {
    constexpr std::uint32_t purpose = 0x1d6;
    auto stream = view.random(purpose);
    if (!memory.has_begun) begin_somewhere(stream, memory);
    change_mind(stream, memory, dt);
    if (memory.yields) let_in(view, limits);
  }

 private:
  template <BitStream Stream>
  [[nodiscard]] double duration(Stream& stream, bool yielding) const {
    return std::max(0.1, (yielding ? yields : insists)(stream));
  }

  /// Starts at a random time between the begin of yielding and the end of insisting, so that drivers do not switch in
  /// unison.
  template <BitStream Stream>
  void begin_somewhere(Stream& stream, Memory& memory) const {
    double const yielding = duration(stream, true), insisting = duration(stream, false);
    double const left = uniform01(stream) * (yielding + insisting);  // insisting, which precedes yielding here
    memory.has_begun = true;
    memory.yields = left >= insisting;
    memory.left = static_cast<float>(memory.yields ? left - insisting : left);
  }

  /// Continues its period, or switches to the other one when it is over.
  template <BitStream Stream>
  void change_mind(Stream& stream, Memory& memory, double dt) const {
    memory.left -= static_cast<float>(dt);
    if (memory.left > 0.0f) return;
    memory.yields = !memory.yields;
    memory.left = static_cast<float>(duration(stream, memory.yields));
  }

  template <class View, class Limits>
  void let_in(View const& view, Limits& limits) const {
    auto const& at = view.place();
    auto const& own = view.corridor();
    for (auto const side : {own.pieces[at.piece].left, own.pieces[at.piece].right}) {
      if (side == none<CorridorId>) continue;
      auto const there = view.place(side);
      auto const& lane = view.road().corridors[side];
      double const s = there.s + horizon;
      bool const ends = s > lane.length() && !lane.continues && !lane.reaches_destination;
      bool const joins = lane.piece_at(s).lane == own.piece_at(at.s + horizon).lane;
      if (!ends && !joins) continue;
      auto const front = view.ahead(there);
      if (!front || !(front->gap > 0.0)) continue;
      auto const constraint = detail::constraint_of<typename Limits::Response>(view, *front, there);
      if (-limits.response()(constraint) <= limits.law().comfortable_deceleration) limits.heed(constraint);
    }
  }
};

}  // namespace cambium::inline v0_1
