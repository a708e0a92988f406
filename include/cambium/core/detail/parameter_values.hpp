#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "cambium/core/described.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/one_of.hpp"

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
template <class T>
void take_optional(std::optional<T> const&);
/// Whether `F` is a `std::optional` or derived from one.
template <class F>
concept Optional = requires(F const& any) {
  detail::take_optional(any);
};

template <ParameterList F>
using ElementOf = std::remove_cv_t<typename decltype(elements_of(std::declval<F const&>()))::element_type>;

/// A key's path from the outermost struct, such as "source.ids[2]". It becomes text only on request.
struct ParameterPath {
  static constexpr std::size_t no_list = std::numeric_limits<std::size_t>::max(), any_element = no_list - 1;

  ParameterPath const* outer;
  char const* name;
  std::size_t element = no_list;  ///< index in the list; where the name is empty, in an element of a list of lists

  [[nodiscard]] std::string text() const;
  /// Whether any part of the path stands for all elements of a list ("[]").
  [[nodiscard]] bool is_any_element() const {
    return element == any_element || (outer != nullptr && outer->is_any_element());
  }
};

template <class T>
[[nodiscard]] constexpr char const* struct_name() {
  if constexpr (requires { T::name; }) {
    return T::name;
  } else {
    return "parameters";
  }
}

/// A field's value, whatever its type.
struct ParameterValue {
  enum class Kind : std::uint8_t {
    boolean,
    id,
    lane,  ///< an id that files write by road, lane section and number
    choice,
    signed_integer,
    unsigned_integer,
    single_precision,
    number
  };

  Kind kind;
  double number;       ///< compared with the range
  std::uint64_t bits;  ///< the value of an integer, a choice or an id modulo 2^64; else 0

  template <class Value>
  explicit constexpr ParameterValue(Value value)
      : kind(kind_of<Value>()),
        number(static_cast<double>(value)),
        bits(std::is_floating_point_v<Value> ? 0 : static_cast<std::uint64_t>(value)) {}

  [[nodiscard]] constexpr bool has_range() const {
    return kind != Kind::boolean && kind != Kind::id && kind != Kind::lane;
  }
  [[nodiscard]] constexpr bool is_real() const { return kind == Kind::number || kind == Kind::single_precision; }

  /// The value as a `Value`, which it was made of or fits into.
  template <class Value>
  [[nodiscard]] constexpr Value as() const {
    if constexpr (std::is_floating_point_v<Value>)
      return static_cast<Value>(number);
    else
      return static_cast<Value>(bits);
  }
  [[nodiscard]] constexpr bool in(Range range) const {
    return !has_range() || (number >= range.low && number <= range.high);  // false for NaN
  }

 private:
  template <class Value>
  [[nodiscard]] static constexpr Kind kind_of() {
    if constexpr (std::is_same_v<Value, bool>) return Kind::boolean;
    if constexpr (std::is_same_v<Value, LaneId>) return Kind::lane;
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
  /// A field that is text.
  virtual void text(ParameterPath const&, ParameterInfo const&, std::string_view, std::string_view const*) {}
  /// A field that is a `OneOf` holds the alternative `name`; its fields follow.
  virtual void alternative(ParameterPath const&, ParameterInfo const&, char const*) {}
  /// A list has a different length in the second struct, or a `OneOf` holds another alternative; their elements and
  /// fields are skipped.
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
  } else if constexpr (std::is_same_v<Value, std::string>) {
    std::string_view const own(value), of_other(other != nullptr ? *other : value);
    reader.text(path, info, own, other != nullptr ? &of_other : nullptr);
  } else if constexpr (Variant<Value>) {
    if (other != nullptr && other->index() != value.index()) return reader.other_length();
    std::visit(
        [&]<class Model>(Model const& model) {
          reader.alternative(path, info, struct_name<Model>());
          ParameterPath const inner{&path, struct_name<Model>()};
          if constexpr (Described<Model>)
            read_parameters(model, other != nullptr ? std::get_if<Model>(other) : nullptr, &inner, lists, reader);
        },
        value);
  } else if constexpr (Optional<Value>) {
    if (other != nullptr && other->has_value() != value.has_value()) return reader.other_length();
    if (value) read_value(path, info, *value, other != nullptr ? &**other : nullptr, lists, reader);
  } else if constexpr (ParameterList<Value>) {
    auto const element_path = [&](std::size_t i) {
      return path.element == ParameterPath::no_list ? ParameterPath{path.outer, path.name, i}
                                                    : ParameterPath{&path, "", i};
    };
    if (lists == ListElements::one_default)
      return read_value(element_path(ParameterPath::any_element), info, ElementOf<Value>{},
                        static_cast<ElementOf<Value> const*>(nullptr), lists, reader);
    auto const elements = elements_of(value), others = other != nullptr ? elements_of(*other) : elements;
    if (elements.size() != others.size()) return reader.other_length();
    for (std::size_t i = 0; i < elements.size(); ++i)
      read_value(element_path(i), info, elements[i], other != nullptr ? &others[i] : nullptr, lists, reader);
  } else {
    static_assert(
        std::is_arithmetic_v<Value> || std::is_enum_v<Value>,
        "cambium::parameter: a field must be a number, a bool, an enum, an id, a text, another described struct, a "
        "OneOf of these, an optional, or a list");
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
