#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/map/opendrive/detail/fields.hpp"
#include "cambium/map/opendrive/detail/xml_text.hpp"
#include "cambium/map/opendrive/element.hpp"

namespace cambium::inline v0_1::map::detail {

/// An attribute with a number; throws `MapError` where it is not finite.
inline void write_number(XmlText& xml, std::string_view name, double value) {
  if (!std::isfinite(value))
    throw MapError("attribute " + std::string(name), "a number is not finite, which OpenDRIVE cannot express",
                   "give a finite number");
  xml.attribute(name, cambium::detail::number_text(value));
}

/// A visitor of `fields` that writes them as attributes, but for those that the rest has.
class AttributeWriter {
 public:
  AttributeWriter(XmlText& xml, opendrive::Rest const* rest) : xml_(&xml), rest_(rest) {}

  template <class T>
  void always(std::string_view name, T const& value) {
    if (!rest_ || !rest_->find_attribute(name)) write(name, value);
  }
  template <class T>
  void needed(std::string_view name, T const& value) {
    always(name, value);
  }
  void place(std::string_view name, double value) { always(name, value); }
  template <class T>
  void optional(std::string_view name, T const& value) {
    if (!(value == T{})) always(name, value);
  }
  void id(std::string_view name, std::string const& value, std::string_view nothing = {}) {
    optional(name, value.empty() ? std::string(nothing) : value);
  }

 private:
  void write(std::string_view name, std::string const& value) { xml_->attribute(name, value); }
  void write(std::string_view name, double value) { write_number(*xml_, name, value); }
  void write(std::string_view name, int value) { xml_->attribute(name, std::to_string(value)); }
  void write(std::string_view name, bool value) { xml_->attribute(name, value ? "true" : "false"); }
  void write(std::string_view name, LaneType value) { xml_->attribute(name, to_string(value)); }
  template <class T>
  void write(std::string_view name, std::optional<T> const& value) {
    if (value) write(name, *value);
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void write(std::string_view name, Enum value) {
    if (!word_of(value).empty()) xml_->attribute(name, word_of(value));
  }

  XmlText* xml_;
  opendrive::Rest const* rest_;
};

/// The attributes that are fields of `x`, then those of its rest.
template <class T>
void write_attributes(XmlText& xml, T const& x) {
  AttributeWriter writer(xml, &x.rest);
  fields(writer, x);
  for (opendrive::Attribute const& a : x.rest.attributes) xml.attribute(a.name, a.value);
}

inline void write_element(XmlText& xml, opendrive::Element const& element) {
  xml.element(element.name, [&] {
    for (opendrive::Attribute const& a : element.attributes) xml.attribute(a.name, a.value);
    if (!element.text.empty()) xml.text(element.text);
    for (opendrive::Element const& child : element.children) write_element(xml, child);
  });
}

/// The elements of a rest but for those that belong to one of the `containers`.
inline void write_rest(XmlText& xml, opendrive::Rest const& rest,
                       std::initializer_list<std::string_view> containers = {}) {
  for (opendrive::Element const& element : rest.elements)
    if (std::find(containers.begin(), containers.end(), element.name) == containers.end()) write_element(xml, element);
}

/// An element without children of its own.
template <class T>
void write_leaf(XmlText& xml, std::string_view name, T const& x) {
  xml.element(name, [&] {
    write_attributes(xml, x);
    write_rest(xml, x.rest);
  });
}

template <class T>
void write_leaves(XmlText& xml, std::string_view name, std::vector<T> const& all) {
  for (T const& x : all) write_leaf(xml, name, x);
}

/// A container with what `content` writes and what the parent's rest has of it; nothing where it is neither `needed`
/// nor there.
template <class Content>
void write_container(XmlText& xml, std::string_view name, opendrive::Rest const& parent, bool needed,
                     Content const& content) {
  opendrive::Element const* rest = nullptr;
  for (opendrive::Element const& element : parent.elements)
    if (element.name == name) rest = &element;
  if (!needed && !rest) return;
  xml.element(name, [&] {
    if (rest)
      for (opendrive::Attribute const& a : rest->attributes) xml.attribute(a.name, a.value);
    content();
    if (rest)
      for (opendrive::Element const& child : rest->children) write_element(xml, child);
  });
}

}  // namespace cambium::inline v0_1::map::detail
