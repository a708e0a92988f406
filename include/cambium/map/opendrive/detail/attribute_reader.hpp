#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <pugixml.hpp>

#include "cambium/map/opendrive/detail/fields.hpp"
#include "cambium/map/opendrive/detail/xml_context.hpp"
#include "cambium/map/opendrive/element.hpp"

namespace cambium::inline v0_1::map::detail {

/// Adds an attribute; of several of one name, which XML forbids, the first counts.
inline void keep_attribute(std::vector<opendrive::Attribute>& attributes, pugi::xml_attribute attribute) {
  for (opendrive::Attribute const& known : attributes)
    if (known.name == attribute.name()) return;
  attributes.push_back({attribute.name(), attribute.value()});
}

/// Any element as plain data. What lies deeper than 100 levels is left out and reported.
[[nodiscard]] inline opendrive::Element read_element(XmlContext& context, pugi::xml_node node, int depth = 0) {
  opendrive::Element element;
  element.name = node.name();
  for (pugi::xml_attribute a = node.first_attribute(); a; a = a.next_attribute()) keep_attribute(element.attributes, a);
  for (pugi::xml_node child = node.first_child(); child; child = child.next_sibling()) {
    if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata)
      element.text += child.value();
    else if (child.type() == pugi::node_element && depth < 100)
      element.children.push_back(read_element(context, child, depth + 1));
    else if (child.type() == pugi::node_element)
      context.report(Severity::warning, child, "it lies more than 100 levels deep in user data; it was left out");
  }
  return element;
}

inline void keep_element(XmlContext& context, pugi::xml_node node, opendrive::Rest& rest) {
  rest.elements.push_back(read_element(context, node));
}

/// A visitor of `fields` that fills them from an element's attributes. What it cannot read is reported; unless it is
/// needed it is kept in the rest. There may be one at a time for a context.
class AttributeReader {
 public:
  AttributeReader(XmlContext& context, pugi::xml_node node, opendrive::Rest* rest)
      : context_(&context), node_(node), rest_(rest) {
    context.attributes.clear();
    for (pugi::xml_attribute a = node.first_attribute(); a; a = a.next_attribute())
      context.attributes.push_back({a.name(), a, false});
  }

  template <class T>
  void needed(std::string_view name, T& field) {
    pugi::xml_attribute const found = find(name);
    if (!found) context_->report_missing(node_, name);
    good_ = found && read(found, field) && good_;
  }
  void needed(std::string_view name, std::string& field) {
    id(name, field);
    if (!field.empty()) return;
    context_->report_missing(node_, name);
    good_ = false;
  }
  template <class T>
  void optional(std::string_view name, T& field) {
    if (pugi::xml_attribute const found = find(name); found && !read(found, field)) keep(found);
  }
  template <class T>
  void always(std::string_view name, T& field) {
    optional(name, field);
  }
  void id(std::string_view name, std::string& field, std::string_view nothing = {}) {
    if (pugi::xml_attribute const found = find(name)) field = trimmed(found.value());
    if (field == nothing) field.clear();
  }
  /// A bad one makes the element unusable.
  void place(std::string_view name, double& field) {
    if (pugi::xml_attribute const found = find(name)) good_ = read(found, field) && good_;
  }

  /// True when all that is needed was there.
  [[nodiscard]] bool good() const { return good_; }
  /// Moves the attributes that no field has asked for to the rest.
  void keep_others() {
    auto const& all = context_->attributes;
    for (XmlContext::NamedAttribute const& a : all) {
      if (a.is_read) continue;
      bool const is_second =
          std::any_of(all.begin(), all.end(), [&](auto const& b) { return b.is_read && b.name == a.name; });
      if (is_second) continue;
      rest_ ? keep(a.attribute) : lose_attribute(*context_, node_, a.attribute);
    }
  }

 private:
  [[nodiscard]] pugi::xml_attribute find(std::string_view name) {
    // Attributes mostly come in the order of the fields.
    for (std::size_t i = 0; i < context_->attributes.size(); ++i) {
      XmlContext::NamedAttribute& a = context_->attributes[next_];
      next_ = next_ + 1 < context_->attributes.size() ? next_ + 1 : 0;
      if (a.name != name) continue;
      a.is_read = true;
      return a.attribute;
    }
    return {};
  }
  void keep(pugi::xml_attribute attribute) {
    if (rest_) keep_attribute(rest_->attributes, attribute);
  }

  template <class Number>
  requires std::is_arithmetic_v<Number>
  [[nodiscard]] bool read(pugi::xml_attribute attribute, Number& field) {
    std::optional<Number> const value = context_->number<Number>(node_, attribute);
    if (value) field = *value;
    return value.has_value();
  }
  template <class Number>
  [[nodiscard]] bool read(pugi::xml_attribute attribute, std::optional<Number>& field) {
    field = context_->number<Number>(node_, attribute);
    return field.has_value();
  }
  [[nodiscard]] bool read(pugi::xml_attribute attribute, bool& field) {
    std::string_view const word = trimmed(attribute.value());
    field = word == "true" || word == "yes" || word == "1";
    if (field) return true;
    for (std::string_view const no : {"", "false", "no", "0"})
      if (word == no) return true;
    report_no_truth(attribute);
    return false;
  }
  [[nodiscard]] bool read(pugi::xml_attribute attribute, std::string& field) {
    field = attribute.value();
    return true;
  }
  /// The reader of lanes says what it thinks of an unknown type.
  [[nodiscard]] bool read(pugi::xml_attribute attribute, LaneType& field) {
    std::string_view const word = attribute.value();
    field = word.empty() ? LaneType::none : lane_type_from_string(word);
    return field != LaneType::other || word == to_string(LaneType::other);
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  [[nodiscard]] bool read(pugi::xml_attribute attribute, Enum& field) {
    std::string_view const found = attribute.value();
    if (found.empty()) return true;
    auto const known_one = enumerator_of<Enum>(found);
    field = known_one ? *known_one : enumerator_of<Enum>("").value_or(Enum{});
    if (known_one) return true;
    std::string known;
    for (auto const word : words(Enum{})) add_word(known, word);
    report_unknown_word(attribute, known, word_of(field));
    return false;
  }
  [[gnu::cold]] void report_no_truth(pugi::xml_attribute attribute) {
    context_->report(
        Severity::warning, node_,
        std::string(attribute.name()) + "=\"" + attribute.value() + "\" is neither true nor false; false is assumed");
  }
  [[gnu::cold]] static void add_word(std::string& words, std::string_view word) {
    if (!word.empty()) words += (words.empty() ? "" : ", ") + std::string(word);
  }
  [[gnu::cold]] void report_unknown_word(pugi::xml_attribute attribute, std::string const& known,
                                         std::string_view taken) {
    std::string const done = taken.empty() ? "" : "; " + std::string(taken) + " is assumed";
    context_->report(Severity::warning, node_,
                     std::string(attribute.name()) + "=\"" + attribute.value() + "\" is not one of " + known + done);
  }

  XmlContext* context_;
  pugi::xml_node node_;
  opendrive::Rest* rest_;
  std::size_t next_ = 0;
  bool good_ = true;
};

/// Fills the fields of `x` from the attributes of `node`, and `rest` (unless null) with the other attributes. False
/// when one that is needed is missing or bad.
template <class T>
[[nodiscard]] bool read_attributes(XmlContext& context, pugi::xml_node node, T& x, opendrive::Rest* rest) {
  lose_text(context, node);
  AttributeReader reader(context, node, rest);
  fields(reader, x);
  reader.keep_others();
  return reader.good();
}

template <class T>
[[nodiscard]] bool read_attributes(XmlContext& context, pugi::xml_node node, T& x) {
  if constexpr (requires { x.line; }) x.line = context.line(node);
  return read_attributes(context, node, x, &x.rest);
}

/// Fills `x` from the element; children that `take(child, name)` does not take (false) go to the rest. False when
/// something that it needs is missing or bad.
template <class T, class Take>
[[nodiscard]] bool read_with(XmlContext& context, pugi::xml_node node, T& x, Take const& take) {
  if (!read_attributes(context, node, x)) {
    context.report(Severity::warning, node, "it was left out, see the previous finding");
    return false;
  }
  for_each_child(node, [&](pugi::xml_node child, std::string_view name) {
    if (!take(child, name)) keep_element(context, child, x.rest);
  });
  return true;
}

/// As above, with all children in the rest.
template <class T>
[[nodiscard]] bool read_leaf(XmlContext& context, pugi::xml_node node, T& x) {
  return read_with(context, node, x, [](pugi::xml_node, std::string_view) { return false; });
}

/// Appends the element as `read_leaf` gives it.
template <class T>
void append_leaf(XmlContext& context, pugi::xml_node node, std::vector<T>& list) {
  if (!read_leaf(context, node, list.emplace_back())) list.pop_back();
}

/// Appends the element with its children of the name `part` in the list `parts`.
template <class T, class Part>
void append_with(XmlContext& context, pugi::xml_node node, std::vector<T>& list, std::string_view part,
                 std::vector<Part> T::*parts) {
  T& x = list.emplace_back();
  bool const is_read = read_with(context, node, x, [&](pugi::xml_node child, std::string_view name) {
    if (name == part) append_leaf(context, child, x.*parts);
    return name == part;
  });
  if (!is_read) list.pop_back();
}

/// Calls `take(child, name)` for every child of a container, a null node included; what it does not take (false), and
/// the container's attributes, go to the rest of the parent as an element of the container's name.
template <class Take>
void read_container(XmlContext& context, pugi::xml_node node, opendrive::Rest& rest, Take const& take) {
  std::string_view const container = local_name(node);
  opendrive::Element* kept = nullptr;
  auto const keep = [&]() -> opendrive::Element& {
    for (opendrive::Element& known : rest.elements)
      if (known.name == container) kept = &known;
    if (kept) return *kept;
    kept = &rest.elements.emplace_back();
    kept->name = container;
    return *kept;
  };
  for_each_child(node, [&](pugi::xml_node child, std::string_view name) {
    if (!take(child, name)) keep().children.push_back(read_element(context, child));
  });
  for (pugi::xml_attribute a = node.first_attribute(); a; a = a.next_attribute()) keep_attribute(keep().attributes, a);
  lose_text(context, node);
}

}  // namespace cambium::inline v0_1::map::detail
