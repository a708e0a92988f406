#pragma once

#include <algorithm>
#include <cstdint>

#include "cambium/behavior/law/constraint.hpp"
#include "cambium/core/described.hpp"

namespace cambium::inline v0_1 {

/// Brakes where the lane ends, as a car-following law brakes for a standing vehicle.
struct LaneEnd {
  enum class Of : std::uint8_t {
    route,     ///< where its lane ends or leaves the route before the destination
    corridor,  ///< before every end of its lane corridor, as BARK's option does
  };

  Of of = Of::route;
  double distance = 60.0;
  double offset = 15.0;

  static constexpr char const* name = "lane_end";
  static constexpr char const* summary = "brakes where its lane ends";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() {
    using P = LaneEnd;
    return parameter_list(
        choice("of", &P::of, "route|corridor", "for which ends it brakes: those before its destination, or all"),
        parameter("distance", &P::distance, "m", Range{0, 10'000},
                  "from the end at which braking begins; the default is too short to stop from above about 15 m/s"),
        parameter("offset", &P::offset, "m", Range{0, 1000}, "from the end at which it would stop"));
  }

  template <class View, class Limits>
  void heed(View const& view, Limits& limits, double /*dt*/) const {
    auto const& corridor = view.corridor();
    if (of == Of::route && corridor.reaches_destination) return;
    double const left = corridor.length_until_end(view.place().s) - view.shape().front;
    if (left <= distance) limits.heed({std::max(0.0, left - offset), 0.0, 0.0});
  }
};

}  // namespace cambium::inline v0_1
