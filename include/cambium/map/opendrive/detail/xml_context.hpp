#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <pugixml.hpp>

#include "cambium/core/diagnostic.hpp"
#include "cambium/core/text.hpp"
#include "cambium/map/detail/findings.hpp"

namespace cambium::inline v0_1::map::detail {

/// Turns byte offsets into line numbers. Offsets asked for in rising order cost O(1) on average, others O(log lines).
class LineTable {
 public:
  explicit LineTable(std::string_view text) {
    starts_.reserve(text.size() / 48 + 2);
    starts_.push_back(0);
    for (std::size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + 1))
      starts_.push_back(static_cast<std::uint32_t>(at + 1));
  }

  /// Line of the byte at `offset`, the first is 1; 0 for a negative offset.
  [[nodiscard]] int line(std::ptrdiff_t offset) {
    if (offset < 0) return 0;
    auto const byte = static_cast<std::size_t>(offset);
    if (starts_[cursor_] > byte) cursor_ = 0;
    std::size_t steps = 0;
    while (cursor_ + 1 < starts_.size() && starts_[cursor_ + 1] <= byte && ++steps < 16) ++cursor_;
    if (steps == 16) {
      auto const next = std::upper_bound(starts_.begin(), starts_.end(), byte);
      cursor_ = static_cast<std::size_t>(next - starts_.begin()) - 1;
    }
    return static_cast<int>(cursor_ + 1);
  }

 private:
  std::vector<std::uint32_t> starts_;  // a text has at most `largest_map_file` bytes
  std::size_t cursor_ = 0;
};

using cambium::detail::parse_number;
using cambium::detail::trimmed;

/// An element's or attribute's name without its namespace prefix.
[[nodiscard]] inline std::string_view local_name(char const* name) {
  char const* begin = name;
  char const* end = name;
  for (; *end != '\0'; ++end)
    if (*end == ':') begin = end + 1;
  return {begin, static_cast<std::size_t>(end - begin)};
}
[[nodiscard]] inline std::string_view local_name(pugi::xml_node node) { return local_name(node.name()); }

/// The first child element of that local name, or a null node.
[[nodiscard]] inline pugi::xml_node find_child(pugi::xml_node parent, std::string_view name) {
  pugi::xml_node child = parent.first_child();
  while (child && local_name(child) != name) child = child.next_sibling();
  return child;
}

/// Calls `visit(child, local_name)` for every child element, in the file's order.
template <class Visit>
void for_each_child(pugi::xml_node parent, Visit const& visit) {
  // Only elements have names here: the parser is told to drop declarations and processing instructions.
  for (pugi::xml_node child = parent.first_child(); child; child = child.next_sibling())
    if (std::string_view const name = local_name(child); !name.empty()) visit(child, name);
}

/// Calls `visit(child)` for every child element of that local name, in the file's order.
template <class Visit>
void for_each_child(pugi::xml_node parent, std::string_view name, Visit const& visit) {
  for_each_child(parent, [&](pugi::xml_node child, std::string_view found) {
    if (found == name) visit(child);
  });
}

/// Where the reader is in the file, and the list of what it found odd. Sentences are only made when there is something
/// to say.
class XmlContext {
 public:
  XmlContext(std::string_view text, std::string file, std::vector<Diagnostic>& diagnostics)
      : lines_(text), findings_{std::move(file), diagnostics} {}

  [[nodiscard]] int line(pugi::xml_node node) { return lines_.line(node.offset_debug()); }
  [[nodiscard]] std::string const& file() const { return findings_.file; }
  [[nodiscard]] std::vector<Diagnostic> const& found() const { return findings_.list; }

  // What reports is rare: out of the way, the rest of the reader fits into the processor's instruction cache.
  [[gnu::cold]] void report(Severity severity, pugi::xml_node node, std::string sentence) {
    report(severity, line(node), std::string(local_name(node)), std::move(sentence));
  }
  [[gnu::cold]] void report(Severity severity, int line, std::string element, std::string sentence) {
    findings_.add(severity, line, std::move(element), ids(), std::move(sentence));
  }

  [[gnu::cold]] void report_missing(pugi::xml_node node, std::string_view attribute) {
    report(Severity::warning, node, "attribute " + std::string(attribute) + " is missing");
  }
  [[gnu::cold]] void report_no_number(pugi::xml_node node, pugi::xml_attribute found, char const* number) {
    report(Severity::warning, node, std::string(found.name()) + "=\"" + found.value() + "\" is not a finite " + number);
  }

  /// Notes that something in an element is not read: `what` is an attribute, or text. See `report_losses`.
  [[gnu::cold]] void lose(pugi::xml_node node, std::string what) {
    auto const kind = local_name(node);
    for (Loss& known : losses_)
      if (known.element == kind) return static_cast<void>(++known.count);
    losses_.push_back({std::string(kind), std::move(what), ids(), line(node), 1});
  }
  /// Reports what `lose` has noted, once for each kind of element.
  void report_losses() {
    for (Loss& loss : losses_)
      findings_.add(Severity::warning, loss.line, std::move(loss.element), std::move(loss.ids),
                    loss.what + " is unknown there; it was left out" +
                        (loss.count > 1 ? ", like " + std::to_string(loss.count - 1) +
                                              " more attributes and texts in such elements"
                                        : std::string()));
    losses_.clear();
  }

  /// The attribute as a finite number; reports a missing or bad one.
  template <class Number>
  [[nodiscard]] std::optional<Number> number(pugi::xml_node node, char const* attribute) {
    if (pugi::xml_attribute const found = node.attribute(attribute)) return number<Number>(node, found);
    report_missing(node, attribute);
    return std::nullopt;
  }
  /// As above, of an attribute that is there.
  template <class Number>
  [[nodiscard]] std::optional<Number> number(pugi::xml_node node, pugi::xml_attribute found) {
    std::optional<Number> const value = parse_number<Number>(found.value());
    if (!value)
      report_no_number(node, found, std::is_integral_v<Number> ? "whole number" : "number, written like 12.5");
    return value;
  }

  // The reader keeps these up to date while it goes down the tree; they name the place in a diagnostic.
  char const* road = nullptr;
  char const* junction = nullptr;
  std::optional<std::size_t> section;
  std::optional<int> lane;

  struct NamedAttribute {
    std::string_view name;
    pugi::xml_attribute attribute;
    bool is_read = false;
  };
  std::vector<NamedAttribute> attributes;  ///< working memory of `AttributeReader`

 private:
  struct Loss {
    std::string element, what, ids;  ///< of the first one
    int line{}, count{};
  };

  [[nodiscard]] std::string ids() const {
    std::string text;
    auto const add = [&text](char const* kind, std::string const& id) {
      text += (text.empty() ? "" : ", ") + std::string(kind) + " " + id;
    };
    if (road) add("road", road);
    if (junction) add("junction", junction);
    if (section) add("section", std::to_string(*section));
    if (lane) add("lane", std::to_string(*lane));
    return text;
  }

  LineTable lines_;
  Findings findings_;
  std::vector<Loss> losses_;  ///< a handful
};

/// As `find_child`, for what may occur once: further ones are reported, and not read.
[[nodiscard]] inline pugi::xml_node find_only_child(XmlContext& context, pugi::xml_node parent, std::string_view name) {
  pugi::xml_node first;
  for_each_child(parent, name, [&](pugi::xml_node child) {
    if (first)
      context.report(Severity::warning, child, "there is a second <" + std::string(name) + ">; it was left out");
    else
      first = child;
  });
  return first;
}

/// Reports content of an element that should have attributes only; it is not read.
inline void report_content(XmlContext& context, pugi::xml_node node) {
  if (node.first_child()) context.report(Severity::warning, node, "its content was left out");
}

inline void lose_attribute(XmlContext& context, pugi::xml_node node, pugi::xml_attribute attribute) {
  context.lose(node, "attribute " + std::string(attribute.name()));
}

/// As `report_content`, and notes the attributes that are none of those `known`.
template <class Names = std::initializer_list<std::string_view>>
void report_others(XmlContext& context, pugi::xml_node node, Names const& known) {
  report_content(context, node);
  for (pugi::xml_attribute a = node.first_attribute(); a; a = a.next_attribute())
    if (std::find(known.begin(), known.end(), a.name()) == known.end()) lose_attribute(context, node, a);
}

/// Notes text in an element that has none.
inline void lose_text(XmlContext& context, pugi::xml_node node) {
  for (pugi::xml_node child = node.first_child(); child; child = child.next_sibling())
    if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata) context.lose(node, "text");
}

}  // namespace cambium::inline v0_1::map::detail
