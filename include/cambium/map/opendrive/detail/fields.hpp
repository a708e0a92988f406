#pragma once

#include <array>
#include <concepts>
#include <string_view>
#include <type_traits>
#include <utility>

#include "cambium/map/opendrive/document.hpp"

/// Which attribute of a file is which field of the document, said once for the reader and the writer. `fields(visit,
/// x)` calls for every attribute of x's element, in the standard's order, one of
///   visit.needed(name, field)         without it the element is unusable; an id is not empty
///   visit.place(name, double)         always written; 0 without it, a bad one makes the element unusable
///   visit.always(name, field)         written even if it has its default value
///   visit.optional(name, field)       left out where it has the type's default value
///   visit.id(name, string)            as optional; the reader takes white space off its ends
namespace cambium::map::detail {

template <class T, class Struct>
concept Of = std::same_as<std::remove_const_t<T>, Struct>;

// The words of the enumerations. An enumerator without a word is not written; an unknown word is read as that one.

template <class Enum, std::size_t N>
using Words = std::array<std::pair<std::string_view, Enum>, N>;

[[nodiscard]] constexpr auto words(opendrive::ContactPoint) {
  using enum opendrive::ContactPoint;
  return Words<opendrive::ContactPoint, 3>{{{"start", start}, {"end", end}, {"", none}}};
}
[[nodiscard]] constexpr auto words(opendrive::ElementType) {
  using enum opendrive::ElementType;
  return Words<opendrive::ElementType, 2>{{{"road", road}, {"junction", junction}}};
}
[[nodiscard]] constexpr auto words(opendrive::DrivingSide) {
  using enum opendrive::DrivingSide;
  return Words<opendrive::DrivingSide, 2>{{{"RHT", right_hand}, {"LHT", left_hand}}};
}
[[nodiscard]] constexpr auto words(opendrive::LaneChangePermission) {
  using enum opendrive::LaneChangePermission;
  return Words<opendrive::LaneChangePermission, 5>{
      {{"both", both}, {"increase", increase}, {"decrease", decrease}, {"none", none}, {"", unspecified}}};
}
[[nodiscard]] constexpr auto words(opendrive::LaneDirection) {
  using enum opendrive::LaneDirection;
  return Words<opendrive::LaneDirection, 3>{{{"standard", standard}, {"reversed", reversed}, {"both", both}}};
}
[[nodiscard]] constexpr auto words(opendrive::JunctionType) {
  using enum opendrive::JunctionType;
  return Words<opendrive::JunctionType, 5>{
      {{"default", standard}, {"direct", direct}, {"virtual", virtual_}, {"crossing", crossing}, {"", other}}};
}
[[nodiscard]] constexpr auto words(opendrive::Side) {
  using enum opendrive::Side;
  return Words<opendrive::Side, 3>{{{"both", both}, {"left", left}, {"right", right}}};
}
[[nodiscard]] constexpr auto words(opendrive::SpeedUnit) {
  using enum opendrive::SpeedUnit;
  return Words<opendrive::SpeedUnit, 3>{
      {{"m/s", metres_per_second}, {"km/h", kilometres_per_hour}, {"mph", miles_per_hour}}};
}
[[nodiscard]] constexpr auto words(opendrive::Orientation) {
  using enum opendrive::Orientation;
  return Words<opendrive::Orientation, 3>{{{"none", both}, {"+", along}, {"-", against}}};
}

/// The word of an enumerator, empty when it has none.
template <class Enum>
[[nodiscard]] std::string_view word_of(Enum value) {
  for (auto const& [word, known] : words(value))
    if (known == value) return word;
  return {};
}

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
  visit.id_or("junction", x.junction, "-1");
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

}  // namespace cambium::map::detail
