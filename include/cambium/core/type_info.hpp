#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/core/described.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/one_of.hpp"

namespace cambium::inline v0_1 {

struct TypeInfo;

/// A field of a described struct.
struct FieldInfo : ParameterInfo {
  TypeInfo const& (*type)();
  std::size_t offset;      ///< in the struct [bytes]
  std::size_t plain_size;  ///< of a number, bool, enum or id [bytes]; else 0

  [[nodiscard]] void* in(void* object) const { return static_cast<std::byte*>(object) + offset; }
  [[nodiscard]] void const* in(void const* object) const { return static_cast<std::byte const*>(object) + offset; }
};

/// What a type consists of, as data. Code that reads, writes, compares, checks or prints described structs is written
/// for this table, so it is compiled once and not once for each struct. `type_info<T>()` gives the table of a described
/// struct or of anything that can be a field of one.
///
///     structure   fields                          a described struct
///     one_of      alternatives, index, held       a OneOf or variant
///     optional    element, held
///     list        element, elements, fill         an array, a vector, a pointer to one, or what is made from a span
///     text                                        a std::string
///     opaque                                      an alternative without description: no file can hold it
///     the rest                                    plain values: see `PlainValue`
struct TypeInfo {
  enum class Kind : std::uint8_t {
    structure,
    one_of,
    optional,
    list,
    text,
    opaque,
    boolean,
    id,
    lane,      ///< an id that files may write by road, lane section and number
    corridor,  ///< an id that only the agent's road knows
    choice,
    signed_integer,
    unsigned_integer,
    single_precision,
    number
  };
  using Get = TypeInfo const& (*)();
  /// The fields of a struct.
  struct Fields : std::span<FieldInfo const> {
    std::uint16_t hash;  ///< of their names and kinds, see `detail::hash_of_fields`
  };
  /// The elements of a list, one after the other in memory.
  struct Elements {
    void const* first;
    std::size_t count, size;  ///< number; of one [bytes]

    [[nodiscard]] void const* operator[](std::size_t i) const {
      return static_cast<std::byte const*>(first) + i * size;
    }
  };
  /// Called for each element that a list gets: its number, the element, and the one before it, or null.
  using Fill = std::function<void(std::size_t number, void* element, void const* before)>;
  static constexpr std::size_t any_length = std::numeric_limits<std::size_t>::max();

  Kind kind;
  std::size_t size;                                      ///< [bytes]
  bool is_signed = false;                                ///< of an integer, or of the integer that an enum is stored as
  bool is_trivial = false;                               ///< a copy allocates nothing
  char const* name = nullptr;                            ///< its member `name`, else "parameters"
  void const* (*usual)() = nullptr;                      ///< the default value; null for types without one
  void (*assign)(void* to, void const* from) = nullptr;  ///< null for types that cannot be assigned

  // Of a structure.
  Fields const& (*fields)() = nullptr;
  unsigned version = 0;                                                   ///< its member `version`, else 0
  void (*upgrade)(void* object, unsigned from) = nullptr;                 ///< its member `upgrade`; may be null
  void (*check)(void const* object, std::string const& where) = nullptr;  ///< its member `check`; may be null
  void* (*copy)(void const* object) = nullptr;                            ///< on the heap; `destroy` deletes it
  void (*destroy)(void* object) = nullptr;

  // Of a OneOf or an optional.
  std::span<Get const> alternatives = {};              ///< of a OneOf
  std::size_t (*index)(void const* object) = nullptr;  ///< of the alternative that it holds
  void const* (*held)(void const* object) = nullptr;   ///< what it holds; null for nothing
  /// Makes it hold the default value of `alternative`, which has to be one that is storable; an optional: 1, or 0 for
  /// nothing.
  void (*select)(void* object, std::size_t alternative) = nullptr;

  // Of a list or an optional.
  Get element = nullptr;
  std::size_t least = 0, most = any_length;  ///< lengths of a list
  Elements (*elements)(void const* object) = nullptr;
  /// Gives a list `length` elements, one after the other; existing elements are kept and passed to `fill`. `where`: for
  /// messages. Throws `ParameterError` where a list of fixed length has another one; passes on what `fill` and a type
  /// that checks its elements throw, a vector then with the elements so far.
  void (*fill)(void* object, std::size_t length, std::string const& where, Fill const& fill) = nullptr;

  /// Whether it is a number, bool, enum or id.
  [[nodiscard]] constexpr bool is_plain() const { return kind >= Kind::boolean; }
  [[nodiscard]] constexpr bool is_real() const { return kind >= Kind::single_precision; }
  /// Whether it is an integer, an enum or an id without a sign, of four bytes or more.
  [[nodiscard]] constexpr bool is_long_unsigned() const { return is_plain() && !is_real() && !is_signed && size >= 4; }
  /// Whether a file can hold it as an alternative.
  [[nodiscard]] constexpr bool is_storable() const {
    return kind == Kind::structure && usual != nullptr && assign != nullptr && copy != nullptr;
  }
};

/// The table of a type.
template <class T>
[[nodiscard]] TypeInfo const& type_info();

namespace detail {
/// Hash of the names and kinds of fields, so that two that swap places are not read as each other.
[[nodiscard]] std::uint16_t hash_of_fields(std::span<FieldInfo const> fields);

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
concept ParameterList = !std::is_same_v<F, std::string> && (HasElements<F> || PointsToElements<F>);

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

template <class T>
void take_optional(std::optional<T> const&);
/// Whether `F` is a `std::optional` or derived from one.
template <class F>
concept Optional = requires(F const& any) {
  detail::take_optional(any);
};

template <class T>
[[nodiscard]] constexpr char const* struct_name() {
  if constexpr (requires { T::name; }) {
    return T::name;
  } else {
    return "parameters";
  }
}

/// Calls `f` with an integer of this size [bytes] and sign.
template <class F>
auto with_integer(std::size_t size, bool is_signed, F const& f) {
  auto const of = [&](auto natural) { return is_signed ? f(std::make_signed_t<decltype(natural)>()) : f(natural); };
  return size == 1   ? of(std::uint8_t())
         : size == 2 ? of(std::uint16_t())
         : size == 4 ? of(std::uint32_t())
                     : of(std::uint64_t());
}

/// The table of a field.
template <class T>
[[nodiscard]] constexpr TypeInfo::Get type_of_field() {
  static_assert(Described<T> || std::is_same_v<T, std::string> || Variant<T> || Optional<T> || ParameterList<T> ||
                    std::is_arithmetic_v<T> || std::is_enum_v<T>,
                "cambium::parameter: a field must be a number, a bool, an enum, an id, a text, another described "
                "struct, a OneOf of these, an optional, or a list");
  return &type_info<T>;
}

/// The table of an element of a list, or of an optional value.
template <class T>
[[nodiscard]] constexpr TypeInfo::Get type_of_element() {
  static_assert(std::is_default_constructible_v<T> && std::is_copy_assignable_v<T>,
                "cambium::parameter: what a list or an optional holds must have a default and be assignable");
  return type_of_field<T>();
}

template <class T>
[[nodiscard]] constexpr TypeInfo::Kind plain_kind() {
  using Kind = TypeInfo::Kind;
  if constexpr (std::is_same_v<T, bool>) return Kind::boolean;
  if constexpr (std::is_same_v<T, LaneId>) return Kind::lane;
  if constexpr (std::is_same_v<T, CorridorId>) return Kind::corridor;
  if constexpr (StrongId<T>) return Kind::id;
  if constexpr (std::is_enum_v<T>) return Kind::choice;
  if constexpr (std::is_same_v<T, float>) return Kind::single_precision;
  if constexpr (std::is_floating_point_v<T>) return Kind::number;
  return std::is_signed_v<T> ? Kind::signed_integer : Kind::unsigned_integer;
}

/// Number of a struct's fields.
template <Described T>
[[nodiscard]] constexpr std::size_t field_count() {
  std::size_t count = 0;
  for_each_parameter<T>([&count](auto const&) { ++count; });
  return count;
}

/// The offset of a member in its struct, found as by `offsetof` in memory without an object: some structs have no
/// default.
template <class T, class Owner, class Field>
[[nodiscard]] std::size_t offset_of(Field Owner::*member) {
  alignas(T) static std::byte memory[sizeof(T)]{};
  auto const* const field = &(reinterpret_cast<T const*>(memory)->*member);
  return static_cast<std::size_t>(reinterpret_cast<std::byte const*>(field) - memory);
}

template <Described T>
[[nodiscard]] TypeInfo::Fields const& fields_of() {
  static auto const list = [] {
    std::array<FieldInfo, field_count<T>()> all;
    auto next = all.begin();
    for_each_parameter<T>([&]<class Owner, class Field>(Parameter<Owner, Field> const& parameter) {
      static_cast<ParameterInfo&>(*next) = parameter;
      next->type = type_of_field<Field>();
      next->offset = offset_of<T>(parameter.field);
      next->plain_size = std::is_class_v<Field> ? 0 : sizeof(Field);
      ++next;
    });
    return all;
  }();
  static TypeInfo::Fields const fields{list, hash_of_fields(list)};
  return fields;
}

template <class T>
concept HasUpgrade = requires(T& object) {
  object.upgrade(0u);
};
template <class T>
concept HasCheck = requires(T const& object) {
  object.check(std::string());
};

template <Described T>
void describe_structure(TypeInfo& info) {
  info.fields = &fields_of<T>;
  if constexpr (requires { typename std::integral_constant<unsigned, T::version>; }) info.version = T::version;
  if constexpr (HasUpgrade<T>)
    info.upgrade = [](void* object, unsigned from) { static_cast<T*>(object)->upgrade(from); };
  if constexpr (HasCheck<T>)
    info.check = [](void const* object, std::string const& where) { static_cast<T const*>(object)->check(where); };
  if constexpr (std::is_copy_constructible_v<T>) {
    info.copy = [](void const* object) -> void* { return new T(*static_cast<T const*>(object)); };
    info.destroy = [](void* object) { delete static_cast<T*>(object); };
  }
}

template <class Model, std::size_t i, class Variant>
void select_if(Variant& value, std::size_t alternative) {
  if constexpr (std::is_default_constructible_v<Model>)
    if (i == alternative) value.template emplace<i>();
}

/// `T` is a OneOf, or another variant of these models.
template <class T, class... Models, std::size_t... i>
void describe_one_of(TypeInfo& info, std::variant<Models...> const*, std::index_sequence<i...>) {
  using Variant = std::variant<Models...>;
  static constexpr TypeInfo::Get alternatives[] = {&type_info<Models>...};
  info.alternatives = alternatives;
  info.index = [](void const* object) { return static_cast<Variant const*>(static_cast<T const*>(object))->index(); };
  info.held = [](void const* object) {
    Variant const* const value = static_cast<T const*>(object);
    void const* held = nullptr;
    ((held = held != nullptr ? held : std::get_if<i>(value)), ...);
    return held;
  };
  info.select = [](void* object, std::size_t alternative) {
    Variant& value = *static_cast<T*>(object);
    (select_if<Models, i>(value, alternative), ...);
  };
}
template <class T, class... Models>
void describe_one_of(TypeInfo& info, std::variant<Models...> const* none) {
  describe_one_of<T>(info, none, std::index_sequence_for<Models...>());
}

template <Optional T>
void describe_optional(TypeInfo& info) {
  static_assert(!Optional<typename T::value_type>,
                "cambium::parameter: JSON cannot tell an empty optional from one that holds an empty optional");
  info.element = type_of_element<typename T::value_type>();
  info.held = [](void const* object) -> void const* {
    auto const& value = *static_cast<T const*>(object);
    return value ? &*value : nullptr;
  };
  info.select = [](void* object, std::size_t alternative) {
    auto& value = *static_cast<T*>(object);
    if (alternative == 0)
      value.reset();
    else if (!value)
      value.emplace();
  };
}

template <class T>
concept GrowingList = requires(T& list) {
  list.push_back(list.data()[0]);
  list.pop_back();
};

template <ParameterList T>
void fill_list(T& list, std::size_t length, std::string const& where, TypeInfo::Fill const& fill) {
  using Element = ElementOf<T>;
  if constexpr (GrowingList<T>) {
    if constexpr (requires { list.reserve(length); })
      list.reserve(std::min(length, std::size_t{256}));  // a damaged file may claim any length
    while (list.size() > length) list.pop_back();
    for (std::size_t i = 0; i < length; ++i) {
      if (i == list.size()) list.push_back(Element{});
      fill(i, &list.data()[i], i > 0 ? &list.data()[i - 1] : nullptr);
    }
  } else if constexpr (PointsToElements<T> || std::is_constructible_v<T, std::span<Element const>, std::string>) {
    auto const elements = elements_of(list);
    std::vector<Element> grown(elements.begin(), elements.end());
    fill_list(grown, length, where, fill);
    if constexpr (PointsToElements<T>)
      list = std::make_shared<std::vector<Element> const>(std::move(grown));
    else
      list = grown.empty() ? T{} : T(std::span<Element const>(grown), where);
  } else {
    if (length != list.size())
      throw ParameterError(where, "has " + std::to_string(length) + " elements", "give " + std::to_string(list.size()));
    for (std::size_t i = 0; i < length; ++i) fill(i, &list.data()[i], i > 0 ? &list.data()[i - 1] : nullptr);
  }
}

template <ParameterList T>
void describe_list(TypeInfo& info) {
  using Element = ElementOf<T>;
  info.element = type_of_element<Element>();
  if constexpr (requires { T::static_capacity; }) {
    info.most = T::static_capacity;
  } else if constexpr (requires { std::tuple_size<T>::value; }) {
    info.least = info.most = std::tuple_size_v<T>;
  }
  info.elements = [](void const* object) -> TypeInfo::Elements {
    auto const elements = elements_of(*static_cast<T const*>(object));
    return {elements.data(), elements.size(), sizeof(Element)};
  };
  info.fill = [](void* object, std::size_t length, std::string const& where, TypeInfo::Fill const& fill) {
    fill_list(*static_cast<T*>(object), length, where, fill);
  };
}

template <class T>
[[nodiscard]] TypeInfo make_type_info() {
  using Kind = TypeInfo::Kind;
  TypeInfo info{Kind::opaque, sizeof(T)};
  info.is_trivial = std::is_trivially_copyable_v<T>;
  info.name = struct_name<T>();
  if constexpr (std::is_default_constructible_v<T>)
    info.usual = []() -> void const* {
      static T const usual{};
      return &usual;
    };
  if constexpr (std::is_copy_assignable_v<T>)
    info.assign = [](void* to, void const* from) { *static_cast<T*>(to) = *static_cast<T const*>(from); };
  if constexpr (Described<T>) {
    info.kind = Kind::structure;
    describe_structure<T>(info);
  } else if constexpr (std::is_same_v<T, std::string>) {
    info.kind = Kind::text;
  } else if constexpr (Variant<T>) {
    info.kind = Kind::one_of;
    describe_one_of<T>(info, static_cast<T const*>(nullptr));
  } else if constexpr (Optional<T>) {
    info.kind = Kind::optional;
    describe_optional<T>(info);
  } else if constexpr (ParameterList<T>) {
    info.kind = Kind::list;
    describe_list<T>(info);
  } else if constexpr (!std::is_class_v<T>) {
    static_assert(sizeof(T) <= 8, "cambium::parameter: a number has at most 8 bytes; take double for long double");
    info.kind = plain_kind<T>();
    info.is_signed = std::is_signed_v<T>;
    if constexpr (std::is_enum_v<T>) info.is_signed = std::is_signed_v<std::underlying_type_t<T>>;
  }
  return info;
}

}  // namespace detail

template <class T>
TypeInfo const& type_info() {
  static TypeInfo const info = detail::make_type_info<T>();
  return info;
}

/// A number, bool, enum or id of any type. Its functions take only types with `is_plain()`.
struct PlainValue {
  TypeInfo::Kind kind;
  double number;       ///< compared with the range
  std::uint64_t bits;  ///< the value of an integer, a choice or an id modulo 2^64; else 0

  /// The value of a plain type at `object`.
  [[nodiscard]] static PlainValue at(void const* object, TypeInfo const& type);
  /// The lowest and the highest value of a plain type.
  [[nodiscard]] static PlainValue lowest(TypeInfo const& type);
  [[nodiscard]] static PlainValue highest(TypeInfo const& type);
  /// Writes it to an object of the type that it was made for: no other fits its number and bits.
  void store(void* object, TypeInfo const& type) const;

  [[nodiscard]] bool is_id() const { return kind >= TypeInfo::Kind::id && kind <= TypeInfo::Kind::corridor; }
  [[nodiscard]] bool is_real() const { return kind >= TypeInfo::Kind::single_precision; }
  [[nodiscard]] bool has_range() const { return kind != TypeInfo::Kind::boolean && !is_id(); }
  [[nodiscard]] bool in(Range range) const {
    if (!has_range()) return true;
    double const rounding = kind == TypeInfo::Kind::single_precision ? 0x1p-24 : 0.0;  // a bound may be no float
    return (number >= range.low || range.low - number <= rounding * std::abs(range.low)) &&
           (number <= range.high || number - range.high <= rounding * std::abs(range.high));  // false for NaN
  }
};

}  // namespace cambium::inline v0_1
