#pragma once

#include "cambium/core/described.hpp"

namespace cambium::inline v0_1 {

/// How a `Tracker` tracks.
struct TrackerOptions {
  double keep_unseen = 1.0;
  double existence = 0.1;
  double longest_gap = 2.0;

  static constexpr char const* name = "tracker";
  static constexpr auto parameters() {
    using P = TrackerOptions;
    return parameter_list(
        parameter("keep_unseen", &P::keep_unseen, "s", Range{0, 60},
                  "that an object goes on as predicted when its list lacks it"),
        parameter("existence", &P::existence, "-", Range{0, 1}, "probability below which an object is refused"),
        parameter("longest_gap", &P::longest_gap, "s", Range{0.01, 60},
                  "between lists; after a longer one all objects are new"));
  }
};

}  // namespace cambium::inline v0_1
