#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>

#include "cambium/map/opendrive/document.hpp"

/// Which attribute of a file is which field of the document, said once for the reader and the writer. `fields(visit,
/// x)` calls for every attribute of x's element, in the standard's order, one of
///   visit.needed(name, field)         without it the element is unusable; an id is not empty
///   visit.place(name, double)         always written; 0 without it, a bad one makes the element unusable
///   visit.always(name, field)         written even if it has its default value
///   visit.optional(name, field)       left out where it has the type's default value
///   visit.id(name, string, nothing)   as optional; the reader takes white space off its ends; the word `nothing` in
///   the
///                                     file, unless it is empty, stands for an empty id
namespace cambium::inline v0_1::map::detail {

template <class T, class Struct>
concept Of = std::same_as<std::remove_const_t<T>, Struct>;

// The words of the enumerations, by the numbers of the enumerators. An enumerator without a word is not written; an
// unknown word is read as that one.

template <std::size_t N>
using Words = std::array<std::string_view, N>;

[[nodiscard]] constexpr auto words(opendrive::ContactPoint) { return Words<3>{"", "start", "end"}; }
[[nodiscard]] constexpr auto words(opendrive::ElementType) { return Words<2>{"road", "junction"}; }
[[nodiscard]] constexpr auto words(opendrive::DrivingSide) { return Words<2>{"RHT", "LHT"}; }
[[nodiscard]] constexpr auto words(opendrive::LaneChangePermission) {
  return Words<5>{"", "both", "increase", "decrease", "none"};
}
[[nodiscard]] constexpr auto words(opendrive::LaneDirection) { return Words<3>{"standard", "reversed", "both"}; }
[[nodiscard]] constexpr auto words(opendrive::JunctionType) {
  return Words<5>{"default", "direct", "virtual", "crossing", ""};
}
[[nodiscard]] constexpr auto words(opendrive::Side) { return Words<3>{"both", "left", "right"}; }
[[nodiscard]] constexpr auto words(opendrive::SpeedUnit) { return Words<3>{"m/s", "km/h", "mph"}; }
[[nodiscard]] constexpr auto words(opendrive::Orientation) { return Words<3>{"none", "+", "-"}; }

/// The word of an enumerator, empty when it has none.
template <class Enum>
[[nodiscard]] std::string_view word_of(Enum value) {
  return words(value)[static_cast<std::size_t>(value)];
}

/// The enumerator that has the word, nothing when none has.
template <class Enum>
[[nodiscard]] std::optional<Enum> enumerator_of(std::string_view word) {
  auto const all = words(Enum{});
  auto const at = std::find(all.begin(), all.end(), word);
  return at == all.end() ? std::nullopt : std::optional(static_cast<Enum>(at - all.begin()));
}

/// An element that describes a curve: its name, and its attributes, of which the first eight are numbers.
struct CurveKind {
  std::string_view name;
  std::array<std::string_view, 9> attributes;
};
inline constexpr CurveKind poly3_kind{"poly3", {"a", "b", "c", "d"}};
inline constexpr CurveKind param_poly3_kind{"paramPoly3", {"aU", "bU", "cU", "dU", "aV", "bV", "cV", "dV", "pRange"}};
inline constexpr std::array curve_kinds{CurveKind{"line", {}}, CurveKind{"arc", {"curvature"}},
                                        CurveKind{"spiral", {"curvStart", "curvEnd"}}, poly3_kind, param_poly3_kind};

/// A speed of the file in m/s.
[[nodiscard]] inline double in_metres_per_second(double value, opendrive::SpeedUnit unit) {
  if (unit == opendrive::SpeedUnit::kilometres_per_hour) return value / 3.6;
  if (unit == opendrive::SpeedUnit::miles_per_hour) return value * 0.44704;
  return value;
}

void fields(auto& visit, Of<opendrive::Header> auto& x) {
  visit.always("revMajor", x.rev_major);
  visit.always("revMinor", x.rev_minor);
  visit.always("name", x.name);
  visit.optional("vendor", x.vendor);
}

void fields(auto& visit, Of<opendrive::HeaderOffset> auto& x) {
  visit.always("x", x.x);
  visit.always("y", x.y);
  visit.always("z", x.z);
  visit.always("hdg", x.heading);
}

void fields(auto& visit, Of<opendrive::RoadElement> auto& x) {
  visit.optional("name", x.name);
  visit.always("length", x.length);
  visit.needed("id", x.id);
  visit.id("junction", x.junction, "-1");
  visit.always("rule", x.rule);
}

void fields(auto& visit, Of<opendrive::RoadLink> auto& x) {
  visit.needed("elementType", x.element_type);
  visit.needed("elementId", x.id);
  visit.optional("contactPoint", x.contact_point);
  visit.optional("elementS", x.element_s);
}

void fields(auto& visit, Of<opendrive::RoadType> auto& x) {
  visit.place("s", x.s);
  visit.always("type", x.type);
}

void fields(auto& visit, Of<Geometry> auto& x) {
  visit.needed("s", x.s);
  visit.needed("x", x.x);
  visit.needed("y", x.y);
  visit.needed("hdg", x.heading);
  visit.needed("length", x.length);
}

void fields(auto& visit, Of<opendrive::LaneSection> auto& x) {
  visit.needed("s", x.s);
  visit.optional("singleSide", x.single_side);
}

void fields(auto& visit, Of<opendrive::LaneElement> auto& x) {
  visit.needed("id", x.id);
  visit.always("type", x.type);
  visit.optional("direction", x.direction);
}

void fields(auto& visit, Of<opendrive::RoadMark> auto& x) {
  visit.place("sOffset", x.s_offset);
  visit.always("type", x.type);
  visit.optional("weight", x.weight);
  visit.optional("color", x.color);
  visit.optional("width", x.width);
  visit.optional("laneChange", x.lane_change);
}

void fields(auto& visit, Of<opendrive::HeightRecord> auto& x) {
  visit.place("sOffset", x.s_offset);
  visit.always("inner", x.inner);
  visit.always("outer", x.outer);
}

void fields(auto& visit, Of<opendrive::JunctionElement> auto& x) {
  visit.optional("name", x.name);
  visit.needed("id", x.id);
  visit.optional("type", x.type);
}

void fields(auto& visit, Of<opendrive::Connection> auto& x) {
  visit.always("id", x.id);
  visit.id("incomingRoad", x.incoming_road);
  visit.id("connectingRoad", x.connecting_road);
  visit.id("linkedRoad", x.linked_road);
  visit.optional("contactPoint", x.contact_point);
}

void fields(auto& visit, Of<opendrive::LaneLink> auto& x) {
  visit.needed("from", x.from);
  visit.needed("to", x.to);
}

void fields(auto& visit, Of<opendrive::Priority> auto& x) {
  visit.id("high", x.high);
  visit.id("low", x.low);
}

void fields(auto& visit, Of<opendrive::Signal> auto& x) {
  visit.needed("s", x.s);
  visit.needed("id", x.id);
  visit.optional("orientation", x.orientation);
  visit.optional("type", x.type);
}

void fields(auto& visit, Of<opendrive::Validity> auto& x) {
  visit.needed("fromLane", x.from_lane);
  visit.needed("toLane", x.to_lane);
}

void fields(auto& visit, Of<opendrive::Controller> auto& x) { visit.needed("id", x.id); }

void fields(auto& visit, Of<opendrive::Control> auto& x) { visit.needed("signalId", x.signal_id); }

}  // namespace cambium::inline v0_1::map::detail
