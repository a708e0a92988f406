#pragma once

#include "cambium/map/opendrive/detail/fields.hpp"

/// As `opendrive_fields.hpp`, for signals, controllers and objects.
namespace cambium::map::detail {

void fields(auto& visit, Of<opendrive::Validity> auto& x) {
  visit.needed("fromLane", x.from_lane);
  visit.needed("toLane", x.to_lane);
}

void fields(auto& visit, Of<opendrive::Signal> auto& x) {
  visit.needed("s", x.s);
  visit.needed("t", x.t);
  visit.needed("id", x.id);
  visit.optional("name", x.name);
  visit.yes_no("dynamic", x.dynamic);
  visit.always("orientation", x.orientation);
  visit.always("zOffset", x.z_offset);
  visit.optional("country", x.country);
  visit.optional("countryRevision", x.country_revision);
  visit.always("type", x.type);
  visit.always("subtype", x.subtype);
  visit.optional("value", x.value);
  visit.optional("unit", x.unit);
  visit.optional("height", x.height);
  visit.optional("width", x.width);
  visit.optional("text", x.text);
  visit.optional("hOffset", x.h_offset);
  visit.optional("pitch", x.pitch);
  visit.optional("roll", x.roll);
}

void fields(auto& visit, Of<opendrive::SignalReference> auto& x) {
  visit.needed("s", x.s);
  visit.needed("t", x.t);
  visit.needed("id", x.id);
  visit.always("orientation", x.orientation);
}

void fields(auto& visit, Of<opendrive::Controller> auto& x) {
  visit.needed("id", x.id);
  visit.optional("name", x.name);
  visit.optional("sequence", x.sequence);
}

void fields(auto& visit, Of<opendrive::Control> auto& x) {
  visit.needed("signalId", x.signal_id);
  visit.optional("type", x.type);
}

void fields(auto& visit, Of<opendrive::Object> auto& x) {
  visit.needed("id", x.id);
  visit.optional("name", x.name);
  visit.needed("s", x.s);
  visit.needed("t", x.t);
  visit.always("zOffset", x.z_offset);
  visit.optional("type", x.type);
  visit.optional("subtype", x.subtype);
  visit.optional("hdg", x.heading);
  visit.optional("pitch", x.pitch);
  visit.optional("roll", x.roll);
  visit.optional("height", x.height);
  visit.optional("length", x.length);
  visit.optional("width", x.width);
  visit.optional("radius", x.radius);
  visit.optional("orientation", x.orientation);
  visit.optional("validLength", x.valid_length);
  visit.yes_no("dynamic", x.dynamic);
}

void fields(auto& visit, Of<opendrive::ObjectReference> auto& x) {
  visit.needed("s", x.s);
  visit.needed("t", x.t);
  visit.needed("id", x.id);
  visit.optional("zOffset", x.z_offset);
  visit.optional("validLength", x.valid_length);
  visit.always("orientation", x.orientation);
}

void fields(auto& visit, Of<opendrive::Outline> auto& x) {
  visit.optional("id", x.id);
  visit.optional("fillType", x.fill_type);
  visit.optional("laneType", x.lane_type);
  visit.optional("closed", x.closed);
}

void fields(auto& visit, Of<opendrive::RoadCorner> auto& x) {
  visit.needed("s", x.s);
  visit.needed("t", x.t);
  visit.always("dz", x.dz);
  visit.always("height", x.height);
  visit.optional("id", x.id);
}

void fields(auto& visit, Of<opendrive::LocalCorner> auto& x) {
  visit.needed("u", x.u);
  visit.needed("v", x.v);
  visit.always("z", x.z);
  visit.always("height", x.height);
  visit.optional("id", x.id);
}

void fields(auto& visit, Of<opendrive::Repeat> auto& x) {
  visit.needed("s", x.s);
  visit.needed("length", x.length);
  visit.needed("distance", x.distance);
  visit.optional("tStart", x.t_start);
  visit.optional("tEnd", x.t_end);
  visit.optional("widthStart", x.width_start);
  visit.optional("widthEnd", x.width_end);
  visit.optional("heightStart", x.height_start);
  visit.optional("heightEnd", x.height_end);
  visit.optional("zOffsetStart", x.z_offset_start);
  visit.optional("zOffsetEnd", x.z_offset_end);
  visit.optional("lengthStart", x.length_start);
  visit.optional("lengthEnd", x.length_end);
  visit.optional("radiusStart", x.radius_start);
  visit.optional("radiusEnd", x.radius_end);
}

}  // namespace cambium::map::detail
