#pragma once

#include <array>
#include <cstddef>

namespace cambium::inline v0_1 {

struct Idm;
struct Acc;
struct KeepLane;
struct TrackLine;
template <class Rule>
struct ChangeLanes;
template <class... Filters>
struct MobilRule;
struct FreeSpaceRule;
struct SpeedLimit;
struct Bends;
template <int percent>
struct BendsFor;
struct Signals;
struct Pedestrians;
struct Conflicts;
struct Zip;

/// How files, messages and tables call a driver.
struct DriverText {
  char const* name;
  char const* summary;
  char const* source;
};

namespace detail {
/// The names of the parts, joined by underscores.
template <class... Parts>
struct JoinedName {
  static constexpr std::size_t length = [] {
    std::size_t n = 0;
    for (char const* part : {Parts::name...})
      for (n += 1; *part != '\0'; ++part) ++n;
    return n;
  }();
  static constexpr auto text = [] {
    std::array<char, length> joined{};
    std::size_t n = 0;
    for (char const* part : {Parts::name...}) {
      if (n > 0) joined[n++] = '_';
      for (; *part != '\0'; ++part) joined[n++] = *part;
    }
    return joined;
  }();
};
}  // namespace detail

/// The text of `Driver<Law, Lateral, Heeds...>`: by default the names of its parts. The drivers of `drivers.hpp` have
/// theirs below; give those of your own one in the same way.
template <class Law, class Lateral, class... Heeds>
inline constexpr DriverText driver_text{detail::JoinedName<Law, Lateral, Heeds...>::text.data(),
                                        "follows by a law, keeps or changes its lane, and heeds what it is composed of",
                                        "see its parts"};

template <>
inline constexpr DriverText driver_text<Idm, KeepLane, Pedestrians>{
    "idm_classic",
    "keeps its lane; a = a_max (1 - (v/v0)^4 - (s*/s)^2), s* = s0 + max(0, v T + v (v - v_leader) / (2 sqrt(a_max b)))",
    "Treiber, Hennecke, Helbing 2000, eq. 3 and 4"};
template <>
inline constexpr DriverText driver_text<Acc, KeepLane, Pedestrians>{
    "adaptive_cruise_control",
    "keeps its lane; its base law, but where that brakes harder than the constant-acceleration heuristic c requires: "
    "(1 - coolness) a_base + coolness (c + b tanh((a_base - c) / b))",
    "Kesting, Treiber, Helbing 2010, eq. 2.3 and 2.6; base: Treiber, Kesting 2013"};
template <>
inline constexpr DriverText driver_text<Idm, TrackLine, BendsFor<340>, Pedestrians>{
    "idm_lane_tracking",
    "along: IDM, slower in bends; across: front axle to the centre line, steering = heading error - atan(k e / (v + "
    "v_soft)), through the vehicle model",
    "Treiber, Hennecke, Helbing 2000; Hoffmann, Tomlin, Montemerlo, Thrun 2007"};
template <>
inline constexpr DriverText driver_text<Idm, ChangeLanes<MobilRule<>>, BendsFor<300>, Pedestrians>{
    "mobil",
    "IDM; changes lanes if a_new - a_old + politeness (gains of new and old follower) > threshold + bias, and the new "
    "follower need not brake harder than is safe; parameters are the driver's own",
    "Kesting, Treiber, Helbing 2007, eq. 2 to 7"};
template <>
inline constexpr DriverText driver_text<Idm, ChangeLanes<FreeSpaceRule>, BendsFor<300>, Pedestrians>{
    "lane_change_rule_based", "IDM; changes to the lane with the most free space ahead, if that is safe",
    "rule: BARK; safety: Kesting, Treiber, Helbing 2007"};
template <>
inline constexpr DriverText driver_text<Idm, KeepLane, Pedestrians, Zip>{
    "zip_merge", "IDM; at a merge, lets one vehicle from the other lane in before itself",
    "rule: StVO section 7 (4); control of the gap: own"};
template <>
inline constexpr DriverText driver_text<Idm, KeepLane, SpeedLimit, Bends, Signals, Pedestrians, Conflicts>{
    "intersection",
    "IDM; stops at red lights and stop signs; gives way by priorities of the map, signs, order of arrival, right "
    "before left, oncoming before turning; stops for vehicles predicted to come too close in time; resolves deadlocks",
    "rules of the road (StVO sections 8 and 9); prediction: own"};
template <>
inline constexpr DriverText
    driver_text<Acc, ChangeLanes<MobilRule<>>, SpeedLimit, Bends, Signals, Pedestrians, Conflicts>{
        "urban_driver",
        "ACC; changes lanes by MOBIL, obeys limits, slows down for bends, stops for lights, signs and pedestrians, and "
        "gives way at junctions",
        "see intersection and mobil"};

namespace detail {
struct MemoryWord {
  static constexpr char const* name = "memory";
};
template <class... Parts>
struct DriverName {
  static constexpr char const* name = driver_text<Parts...>.name;
};
/// The name of a driver's memory, which differs from that of another driver's.
template <class... Parts>
inline constexpr char const* memory_name = JoinedName<DriverName<Parts...>, MemoryWord>::text.data();
}  // namespace detail

}  // namespace cambium::inline v0_1
