#pragma once

#include <cstdint>

#include "cambium/core/ids.hpp"
#include "cambium/tracking/tracked_object.hpp"

namespace cambium::inline v0_1 {

/// How an object moves, and with that, which model predicts it.
enum class ObjectMotion : std::uint8_t {
  follows_lane,
  turns,  ///< follows a lane that bends off at a junction
  changes_lanes,
  stands,     ///< stays where it is: nothing ahead makes it wait
  wrong_way,  ///< against its lane, on its own course
  off_lanes,  ///< on its own course
  reverses,   ///< its rear goes first, on its own course
  walks,      ///< on foot, on its own course
  none,       ///< it was refused
};

/// Why an object was refused.
enum class Refusal : std::uint8_t {
  none,
  not_finite,    ///< its position or velocity is missing or not finite
  out_of_range,  ///< it is farther than 1e8 m from the origin, or faster than 150 m/s
  duplicate,     ///< an object before it in the list has its key
  too_old,       ///< it was measured more than a second from its list, or that is not newer than the last one
  unlikely,      ///< its existence is less probable than `TrackerOptions::existence`
};

/// What the tracker makes of an object.
struct Verdict {
  ObjectKey key{};
  AgentId agent = none<AgentId>;  ///< in the tracker's world; none if it was refused
  ObjectMotion motion = ObjectMotion::none;
  Refusal refusal = Refusal::none;
  LaneId lane = none<LaneId>;    ///< that it is in; none off the lanes
  double probability = 1.0;      ///< of the way that the world has for it; others are possible
  bool assumed_size = false;     ///< its size is that of its class
  bool assumed_heading = false;  ///< its heading is that of its motion, or the last one

  friend bool operator==(Verdict const&, Verdict const&) = default;
};

/// In words.
[[nodiscard]] constexpr char const* to_string(ObjectMotion motion) {
  constexpr char const* names[] = {"follows its lane", "turns",    "changes lanes", "stands", "wrong way",
                                   "off lanes",        "reverses", "walks",         "refused"};
  return names[static_cast<std::uint8_t>(motion)];
}

/// A sentence.
[[nodiscard]] constexpr char const* to_string(Refusal refusal) {
  constexpr char const* sentences[] = {
      "it is tracked",
      "its position or velocity is missing or not a finite number",
      "it is farther than 1e8 m from the origin, or faster than 150 m/s",
      "an object before it in the list has the same key",
      "it was measured more than a second before or after its list, or that is not newer than the last one",
      "that it exists is less probable than TrackerOptions::existence"};
  return sentences[static_cast<std::uint8_t>(refusal)];
}

}  // namespace cambium::inline v0_1
