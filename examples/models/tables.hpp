#pragma once

#include <cstdio>
#include <string>
#include <type_traits>

#include "cambium/behavior/drivers.hpp"
#include "cambium/core/parameters.hpp"

/// Models as Markdown, from the descriptions in their code.
namespace models {

namespace cb = cambium;

/// A model's source; "-" if it names none.
template <class M>
[[nodiscard]] std::string source_of() {
  if constexpr (requires { M::source; })
    return M::source;
  else
    return "-";
}

/// A parameter's value as text: a number with four digits ("33.33 m/s"), the size of a list of structs ("3 *window*"),
/// or the elements of another list ("1 m, 2 m").
template <class Value>
[[nodiscard]] std::string value_text(Value const& value, cb::ParameterInfo const& info) {
  if constexpr (cb::detail::ParameterList<Value>) {
    auto const list = cb::detail::elements_of(value);
    using Element = cb::detail::ElementOf<Value>;
    if constexpr (cb::Described<Element>)
      return std::to_string(list.size()) + " *" + cb::detail::struct_name<Element>() + "*";
    if constexpr (cb::detail::Variant<Element>) return list.empty() ? "none" : std::to_string(list.size());
    std::string text;
    if constexpr (!cb::Described<Element> && !cb::detail::Variant<Element>)
      for (auto const& element : list) text += (text.empty() ? "" : ", ") + value_text(element, info);
    return text;
  } else if constexpr (std::is_floating_point_v<Value>) {
    char number[32];
    std::snprintf(number, sizeof number, "%.4g", value);
    return cb::detail::with_unit(number, info.unit);
  } else {
    return cb::detail::with_unit(cb::detail::value_text(info, cb::PlainValue::at(&value, cb::type_info<Value>())),
                                 info.unit);
  }
}

/// Escapes the asterisks in `text` for Markdown.
[[nodiscard]] inline std::string markdown(std::string const& text) {
  std::string result;
  for (char const c : text) result += c == '*' ? std::string("\\*") : std::string(1, c);
  return result;
}

/// Those that a driver heeds: "*speed_limit*, *bends* with lateral_acceleration 3 m/s^2".
template <class... Heeds>
[[nodiscard]] std::string part_text(cb::Heeding<Heeds...> const& heeds);
/// `Bends` with another default.
template <int percent>
[[nodiscard]] std::string part_text(cb::BendsFor<percent> const& bends);

/// "*idm*", or "*idm* with desired_speed 23 m/s": the struct and what differs from its own defaults.
template <class Part>
[[nodiscard]] std::string part_text(Part const& part) {
  std::string others;
  Part const defaults{};
  cb::for_each_parameter<Part>([&](auto const& entry) {
    auto const& value = part.*entry.field;
    if constexpr (cb::Described<std::remove_cvref_t<decltype(value)>>) {
      if (!cb::equal_parameters(value, defaults.*entry.field))
        others += (others.empty() ? "" : ", ") + std::string(entry.name) + " " + part_text(value);
    } else if (value_text(value, entry) != value_text(defaults.*entry.field, entry)) {
      others += (others.empty() ? "" : ", ") + std::string(entry.name) + " " + value_text(value, entry);
    }
  });
  return "*" + std::string(cb::detail::struct_name<Part>()) + "*" + (others.empty() ? "" : " with " + others);
}

template <class... Heeds>
std::string part_text(cb::Heeding<Heeds...> const& heeds) {
  std::string text;
  ((text += (text.empty() ? "" : ", ") + part_text(heeds.template get<Heeds>())), ...);
  return text.empty() ? "none" : text;
}
template <int percent>
std::string part_text(cb::BendsFor<percent> const& bends) {
  return part_text(static_cast<cb::Bends const&>(bends));
}

/// "`time_headway` 1.5 s, `course` *lane_change_course*": all parameters with values and units.
template <cb::Described M>
[[nodiscard]] std::string values_of(M const& model) {
  std::string text;
  cb::for_each_parameter<M>([&](auto const& entry) {
    auto const& value = model.*entry.field;
    text += (text.empty() ? "`" : ", `") + std::string(entry.name) + "` ";
    if constexpr (cb::Described<std::remove_cvref_t<decltype(value)>>) {
      std::string const unit(entry.unit);
      text += (unit == "-" ? "" : "[" + unit + "] ") + part_text(value);
    } else {
      text += value_text(value, entry);
    }
  });
  return text.empty() ? "-" : text;
}

template <class M>
[[nodiscard]] std::string defaults_of() {
  if constexpr (cb::Described<M>)
    return values_of(M{});
  else
    return "-";
}

/// The page of one model: its law, its source, and a table of its parameters with ranges and meanings.
template <class M>
[[nodiscard]] std::string page_of(std::string const& type) {
  std::string text =
      "### " + type + " (" + M::name + ")\n\n" + markdown(M::summary) + "\n\nSource: " + source_of<M>() + "\n\n";
  if constexpr (cb::Described<M>) text += cb::describe_parameters<M>();
  return text;
}

/// A row of a room's table.
template <class M>
[[nodiscard]] std::string row_of(std::string const& type) {
  return "| `" + type + "` | " + markdown(M::summary) + " | " + source_of<M>() + " | " + defaults_of<M>() + " |\n";
}

}  // namespace models
