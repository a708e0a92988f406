#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <pugixml.hpp>

#include "cambium/core/random.hpp"
#include "cambium/map/opendrive/detail/xml_context.hpp"

/// Damage to XML files that leaves them XML: what random bytes never get to.
namespace xml_damage {

/// Any number below `count`.
inline std::size_t any_of(std::size_t count, cambium::RandomStream& random) {
  return static_cast<std::size_t>(random() % count);
}

/// All elements below `node`, the outer ones first.
inline void collect(pugi::xml_node node, std::vector<pugi::xml_node>& out) {
  for (auto const child : node.children()) {
    if (child.type() != pugi::node_element) continue;
    out.push_back(child);
    collect(child, out);
  }
}

/// "/road[2]/lanes[1]/laneSection[1]": which of its name within the parent.
inline std::string name_of(pugi::xml_node node) {
  std::string path;
  for (; node.parent().parent(); node = node.parent()) {
    int number = 1;
    for (auto before = node.previous_sibling(node.name()); before; before = before.previous_sibling(node.name()))
      ++number;
    path = "/" + std::string(node.name()) + "[" + std::to_string(number) + "]" + path;
  }
  return path;
}

inline std::string text_of(pugi::xml_node root) {
  std::ostringstream text;
  root.print(text, " ", pugi::format_raw);
  return text.str();
}

/// Another value for `value`: an odd word, or a number near it.
inline std::string other_value(char const* value, cambium::RandomStream& random) {
  static char const* const values[] = {"0",      "-1",  "1",      "-3.5",  "0.5",  "1e-9", "1e300",
                                       "-1e300", "1e7", "-1e7",   "100",   "-100", "1000", "nan",
                                       "-nan",   "inf", "-inf",   "",      "many", "1,5",  "1e999",
                                       "2",      "-2",  "1e-300", "3.7 m", "1e4",  "1e5",  "99999999999999999999"};
  auto const number = cambium::map::detail::parse_number<double>(value);
  if (any_of(3, random) != 0 || !number) return values[any_of(std::size(values), random)];
  double const changed[] = {-*number,       *number * 10,   *number / 10,   *number + 1,
                            *number - 1e-3, *number + 1e-9, *number * 1.01, *number - 10};
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", changed[any_of(std::size(changed), random)]);
  return text;
}

/// Damages one place of `xml`; says what it did.
inline std::string damage_once(pugi::xml_document& xml, cambium::RandomStream& random) {
  std::vector<pugi::xml_node> elements;
  collect(xml.document_element(), elements);
  if (elements.empty()) return "";
  auto element = elements[any_of(elements.size(), random)];
  auto const name = name_of(element);
  auto const kind = any_of(11, random);
  if (kind == 0) {
    element.parent().remove_child(element);
    return "deleted " + name + "; ";
  }
  if (kind == 1) {
    element.parent().insert_copy_after(element, element);
    return "doubled " + name + "; ";
  }
  auto other = elements[any_of(elements.size(), random)];
  if (kind == 2) {  // often to where it has no business
    other.append_copy(element);
    return "copied " + name + " into " + name_of(other) + "; ";
  }
  if (kind == 3) {  // an element of another kind, with this one's attributes
    element.set_name(std::string(other.name()).c_str());
    return "renamed " + name + " " + other.name() + "; ";
  }
  auto const count = static_cast<std::size_t>(std::distance(element.attributes_begin(), element.attributes_end()));
  if (count == 0) {
    auto text = element.text();
    if (text.empty()) return "";
    std::string const before = text.get();
    std::string const value = any_of(4, random) == 0 ? other.text().get() : other_value(before.c_str(), random);
    text.set(value.c_str());
    return name + " " + before + " -> " + value + "; ";
  }
  auto attribute = *std::next(element.attributes_begin(), static_cast<std::ptrdiff_t>(any_of(count, random)));
  auto const elsewhere = elements[any_of(elements.size(), random)].attribute(attribute.name());
  auto const value = any_of(4, random) == 0 && elsewhere ? elsewhere.value() : other_value(attribute.value(), random);
  auto const what = name + "@" + attribute.name() + " " + attribute.value() + " -> " + value + "; ";
  if (any_of(20, random) == 0)
    element.remove_attribute(attribute);
  else
    attribute.set_value(value.c_str());
  return what;
}

}  // namespace xml_damage
