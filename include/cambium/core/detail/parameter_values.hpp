#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "cambium/core/described.hpp"
#include "cambium/core/ids.hpp"

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

/// A key's path from the outermost struct, such as "source.ids[2]". It becomes text only on request.
struct ParameterPath {
  static constexpr std::size_t no_list = std::numeric_limits<std::size_t>::max(), any_element = no_list - 1;

  ParameterPath const* outer;
  char const* name;
  std::size_t element = no_list;  ///< index in the list

  [[nodiscard]] std::string text() const;
  /// Whether any part of the path stands for all elements of a list ("[]").
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

/// A field's value, whatever its type.
struct ParameterValue {
  enum class Kind : std::uint8_t { boolean, id, choice, signed_integer, unsigned_integer, single_precision, number };

  Kind kind;
  double number;       ///< compared with the range
  std::uint64_t bits;  ///< the value of an integer, a choice or an id modulo 2^64; else 0

  template <class Value>
  explicit constexpr ParameterValue(Value value)
      : kind(kind_of<Value>()),
        number(static_cast<double>(value)),
        bits(std::is_floating_point_v<Value> ? 0 : static_cast<std::uint64_t>(value)) {}

  [[nodiscard]] constexpr bool has_range() const { return kind != Kind::boolean && kind != Kind::id; }
  [[nodiscard]] constexpr bool in(Range range) const {
    return !has_range() || (number >= range.low && number <= range.high);  // false for NaN
  }

 private:
  template <class Value>
  [[nodiscard]] static constexpr Kind kind_of() {
    if constexpr (std::is_same_v<Value, bool>) return Kind::boolean;
    if constexpr (StrongId<Value>) return Kind::id;
    if constexpr (std::is_enum_v<Value>) return Kind::choice;
    if constexpr (std::is_same_v<Value, float>) return Kind::single_precision;
    if constexpr (std::is_floating_point_v<Value>) return Kind::number;
    return std::is_signed_v<Value> ? Kind::signed_integer : Kind::unsigned_integer;
  }
};

/// Reads parameters without knowing their structs. Checks, texts, tables, hashes and comparisons derive from it, so
/// that each is compiled once instead of once per struct.
class ParameterReader {
 public:
  /// One field. `other`: the same field of the second struct if two are read side by side, else null.
  virtual void value(ParameterPath const& path, ParameterInfo const& info, ParameterValue const& value,
                     ParameterValue const* other) = 0;
  /// A list has a different length in the second struct; its elements are skipped.
  virtual void other_length() {}
  /// Called after the fields of a nested struct that has a member `check`; `check(object, where)` calls it.
  virtual void own_check(ParameterPath const&, void const*, void (*)(void const*, std::string const&)) {}

 protected:
  ~ParameterReader() = default;
};

/// Which elements of a list are read: each one, or a single default element that shows what elements look like.
enum class ListElements : bool { one_default, each };

template <class Value>
void read_value(ParameterPath const& path, ParameterInfo const& info, Value const& value, Value const* other,
                ListElements lists, ParameterReader& reader) {
  if constexpr (Described<Value>) {
    read_parameters(value, other, &path, lists, reader);
  } else if constexpr (ParameterList<Value>) {
    if (lists == ListElements::one_default)
      return read_value(ParameterPath{path.outer, path.name, ParameterPath::any_element}, info, ElementOf<Value>{},
                        static_cast<ElementOf<Value> const*>(nullptr), lists, reader);
    auto const elements = elements_of(value), others = other != nullptr ? elements_of(*other) : elements;
    if (elements.size() != others.size()) return reader.other_length();
    for (std::size_t i = 0; i < elements.size(); ++i)
      read_value(ParameterPath{path.outer, path.name, i}, info, elements[i], other != nullptr ? &others[i] : nullptr,
                 lists, reader);
  } else {
    static_assert(
        std::is_arithmetic_v<Value> || std::is_enum_v<Value>,
        "cambium::parameter: a field must be a number, a bool, an enum, an id, another described struct, or a "
        "list of these");
    ParameterValue const of_other(other != nullptr ? *other : value);
    reader.value(path, info, ParameterValue(value), other != nullptr ? &of_other : nullptr);
  }
}

/// Passes every plain value to `reader`, including those in nested structs and lists. `own`: the path of the struct
/// itself; null if keys start with its fields.
template <Described T>
void read_parameters(T const& object, T const* other, ParameterPath const* own, ListElements lists,
                     ParameterReader& reader) {
  for_each_parameter<T>([&](auto const& entry) {
    read_value(ParameterPath{own, entry.name}, entry, object.*entry.field,
               other != nullptr ? &(other->*entry.field) : nullptr, lists, reader);
  });
  if constexpr (requires { object.check(std::string()); })
    if (own != nullptr)
      reader.own_check(*own, &object, [](void const* checked, std::string const& where) {
        static_cast<T const*>(checked)->check(where);
      });
}

}  // namespace cambium::detail
