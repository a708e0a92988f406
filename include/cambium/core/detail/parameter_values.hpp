#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "cambium/core/described.hpp"

namespace cambium::detail {

template <class F>
concept HasElements = requires(F const list) {
  std::span(list.data(), list.size());
};
template <class F>
concept PointsToElements = requires(F const list) {
  static_cast<bool>(list);
  std::span(list->data(), list->size());
};
/// A field that is a list.
template <class F>
concept ParameterList = HasElements<F> || PointsToElements<F>;

/// Its elements; none where a pointer is null.
template <ParameterList F>
[[nodiscard]] constexpr auto elements_of(F const& list) {
  if constexpr (HasElements<F>) {
    return std::span(list.data(), list.size());
  } else {
    using Elements = decltype(std::span(list->data(), list->size()));
    return list ? Elements(list->data(), list->size()) : Elements();
  }
}
template <ParameterList F>
using ElementOf = std::remove_cv_t<typename decltype(elements_of(std::declval<F const&>()))::element_type>;

/// A key's path from the outermost struct, made into text only when somebody reads it.
struct ParameterPath {
  static constexpr std::size_t no_list = std::numeric_limits<std::size_t>::max(), any_element = no_list - 1;

  ParameterPath const* outer;
  char const* name;
  std::size_t element = no_list;  ///< place in the list

  [[nodiscard]] std::string text() const {
    auto const own = element == no_list       ? std::string(name)
                     : element == any_element ? std::string(name) + "[]"
                                              : std::string(name) + "[" + std::to_string(element) + "]";
    return outer != nullptr ? outer->text() + "." + own : own;
  }
  /// Whether it leads through some element of a list.
  [[nodiscard]] bool is_any_element() const {
    return element == any_element || (outer != nullptr && outer->is_any_element());
  }
};

template <Described T>
[[nodiscard]] constexpr char const* struct_name() {
  if constexpr (requires { T::name; }) {
    return T::name;
  } else {
    return "parameters";
  }
}

template <bool each_element, Described T, class F>
constexpr void visit_values(T const& object, ParameterPath const* outer, F&& f);

template <bool each_element, class Entry, class Value, class F>
constexpr void visit_value(ParameterPath const& path, Entry const& entry, Value const& value, F&& f) {
  if constexpr (Described<Value>) {
    visit_values<each_element>(value, &path, f);
  } else if constexpr (ParameterList<Value> && each_element) {
    std::size_t i = 0;
    for (auto const& element : elements_of(value))
      visit_value<each_element>(ParameterPath{path.outer, path.name, i++}, entry, element, f);
  } else if constexpr (ParameterList<Value>) {
    visit_value<each_element>(ParameterPath{path.outer, path.name, ParameterPath::any_element}, entry,
                              ElementOf<Value>{}, f);
  } else {
    static_assert(
        std::is_arithmetic_v<Value> || std::is_enum_v<Value>,
        "cambium::parameter: a field must be a number, a bool, an enum, an id, another described struct, or a "
        "list of these.");
    f(path, entry, value);
  }
}

/// Calls `f(path, parameter, value)` for each field that is a plain value, those of nested structs and of lists
/// included; of lists either each element or, to show what elements are, a default one.
template <bool each_element, Described T, class F>
constexpr void visit_values(T const& object, ParameterPath const* outer, F&& f) {
  for_each_parameter<T>([&](auto const& entry) {
    visit_value<each_element>(ParameterPath{outer, entry.name}, entry, object.*entry.field, f);
  });
}

}  // namespace cambium::detail
