#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/core/parameters.hpp"
#include "cambium/core/transfer_parameters.hpp"

// What the writer and the reader of an archive know of the described types in it.

namespace cambium::detail {

/// Version of the fields of `T`: its `static constexpr unsigned version`, else 0.
template <class T>
[[nodiscard]] constexpr unsigned version_of() {
  if constexpr (requires { typename std::integral_constant<unsigned, T::version>; })
    return T::version;
  else
    return 0;
}

/// Calls `f(*get_if<i>(&value), i)` for the alternative that `value` holds, as a constant.
template <std::size_t i = 0, class... Models, class F>
void with_alternative(std::variant<Models...> const& value, F const& f) {
  if constexpr (i < sizeof...(Models)) {
    if (value.index() != i) return with_alternative<i + 1>(value, f);
    f(*std::get_if<i>(&value), std::integral_constant<std::size_t, i>{});
  }
}

template <class... Models>
[[nodiscard]] bool same_alternative(std::variant<Models...> const& a, std::variant<Models...> const& b);

/// Whether the bits of two fields are equal.
template <class Value>
[[nodiscard]] bool same_bits(Value const& a, Value const& b) {
  if constexpr (Described<Value>) {
    bool same = true;
    for_each_parameter<Value>([&](auto const& p) { same = same && same_bits(a.*p.field, b.*p.field); });
    return same;
  } else if constexpr (std::is_same_v<Value, std::string>) {
    return a == b;
  } else if constexpr (Variant<Value>) {
    return a.index() == b.index() && same_alternative(a, b);
  } else if constexpr (Optional<Value>) {
    return a.has_value() == b.has_value() && (!a || same_bits(*a, *b));
  } else if constexpr (ParameterList<Value>) {
    auto const left = elements_of(a), right = elements_of(b);
    bool same = left.size() == right.size();
    for (std::size_t i = 0; same && i < left.size(); ++i) same = same_bits(left[i], right[i]);
    return same;
  } else if constexpr (std::is_same_v<Value, double>) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  } else if constexpr (std::is_same_v<Value, float>) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
  } else {
    return a == b;
  }
}

template <class... Models>
[[nodiscard]] bool same_alternative(std::variant<Models...> const& a, std::variant<Models...> const& b) {
  bool same = false;
  with_alternative(a, [&]<class Model>(Model const& model, auto place) {
    if constexpr (Described<Model>) same = same_bits(model, *std::get_if<place>(&b));
  });
  return same;
}

/// Number of a struct's fields.
template <Described T>
[[nodiscard]] constexpr std::size_t field_count() {
  std::size_t count = 0;
  for_each_parameter<T>([&count](auto const&) { ++count; });
  return count;
}

/// A field's value as archives hold it.
template <class Value>
[[nodiscard]] constexpr auto stored(Value value) {
  if constexpr (std::is_enum_v<Value>)
    return static_cast<std::underlying_type_t<Value>>(value);
  else if constexpr (std::is_same_v<Value, bool>)
    return static_cast<unsigned char>(value);
  else
    return value;
}

template <class Value>
inline constexpr bool is_long_unsigned = std::is_unsigned_v<decltype(stored(Value{}))> && sizeof(Value) >= 4;

/// Calls `add` with letters that say how archives hold a field.
template <class Value>
constexpr void add_kind(auto const& add) {
  if constexpr (Described<Value>) {
    add('s');
  } else if constexpr (std::is_same_v<Value, std::string>) {
    add('t');
  } else if constexpr (Variant<Value>) {
    add('v');
  } else if constexpr (Optional<Value>) {
    add('o');
    add_kind<typename Value::value_type>(add);
  } else if constexpr (ParameterList<Value>) {
    add('l');
    add_kind<ElementOf<Value>>(add);
  } else {
    bool const is_whole = is_long_unsigned<Value>;  // of any size
    add(std::is_floating_point_v<Value> ? 'f' : is_whole ? 'w' : 'i');
    add(is_whole ? '8' : static_cast<char>('0' + sizeof(Value)));
  }
}

/// Hashes of the names and kinds of a struct's first fields, from none to all, so that two that swap places are not
/// read as each other.
template <Described T>
[[nodiscard]] constexpr std::array<std::uint16_t, field_count<T>() + 1> hashes_of_fields() {
  std::array<std::uint16_t, field_count<T>() + 1> hashes{};
  std::uint32_t hash = 0x811c9dc5u;  // FNV-1a
  auto const add = [&hash](char letter) { hash = (hash ^ static_cast<unsigned char>(letter)) * 0x01000193u; };
  std::size_t i = 0;
  for_each_parameter<T>([&](auto const& p) {
    hashes[i++] = static_cast<std::uint16_t>(hash ^ hash >> 16);
    for (char const* letter = p.name; *letter != '\0'; ++letter) add(*letter);
    add_kind<std::remove_cvref_t<decltype(std::declval<T&>().*p.field)>>(add);
  });
  hashes[i] = static_cast<std::uint16_t>(hash ^ hash >> 16);
  return hashes;
}
template <Described T>
inline constexpr auto field_hashes = hashes_of_fields<T>();

/// What this program knows of a described struct.
struct KnownStruct {
  char const* name;
  unsigned version;
  std::size_t fields;           ///< how many it has
  std::uint16_t const* hashes;  ///< see `hashes_of_fields`
  bool upgrades;                ///< from older versions
};
template <class T>
concept Upgrades = requires(T& object) {
  object.upgrade(0u);
};
template <Described T>
inline constexpr KnownStruct known_struct{struct_name<T>(), version_of<T>(), field_count<T>(), field_hashes<T>.data(),
                                          Upgrades<T>};

template <class T>
inline constexpr char type_key{};  ///< its address stands for the type

/// The types that an archive has described so far. Writer and reader hold the same.
class ArchivedTypes {
 public:
  static constexpr std::size_t longest = std::size_t{1} << 24;  ///< elements of a list
  static constexpr int deepest = 200;                           ///< nested structs
  /// How much a reader may copy: this, plus so much for each byte that it reads [bytes].
  static constexpr std::size_t copied = std::size_t{1} << 26, copied_per_byte = 64;

  struct Shape {
    KnownStruct const* type;
    unsigned version;
    std::size_t fields;  ///< number of fields in the archive, the first ones of the description
  };
  struct Alternative {
    void const* variant;
    std::size_t index;
    std::shared_ptr<void const> last = {};  ///< the latest struct of it
  };

  [[nodiscard]] Shape const* shape(KnownStruct const& type) const {
    for (auto const& shape : shapes_)
      if (shape.type == &type) return &shape;
    return nullptr;
  }
  void add(Shape const& shape) { shapes_.push_back(shape); }

  /// The number of an alternative among those told of; how many these are if it is none of them.
  [[nodiscard]] std::size_t number_of(void const* variant, std::size_t index) const {
    std::size_t i = 0;
    while (i < alternatives_.size() && !(alternatives_[i].variant == variant && alternatives_[i].index == index)) ++i;
    return i;
  }
  [[nodiscard]] std::vector<Alternative>& alternatives() { return alternatives_; }

  ArchivedTypes() {
    shapes_.reserve(64);
    alternatives_.reserve(16);
  }

 private:
  std::vector<Shape> shapes_;
  std::vector<Alternative> alternatives_;
};

template <class Value>
[[nodiscard]] constexpr bool has_list();
template <class... Models>
[[nodiscard]] constexpr bool any_has_list(std::variant<Models...> const*) {
  return (has_list<Models>() || ...);
}
/// Whether copies of a value may need memory besides its own.
template <class Value>
[[nodiscard]] constexpr bool has_list() {
  if constexpr (Described<Value>) {
    bool any = false;
    for_each_parameter<Value>(
        [&any]<class Owner, class Field>(Parameter<Owner, Field> const&) { any = any || has_list<Field>(); });
    return any;
  } else if constexpr (Variant<Value>) {
    return any_has_list(static_cast<Value const*>(nullptr));
  } else if constexpr (Optional<Value>) {
    return has_list<typename Value::value_type>();
  } else {
    return std::is_same_v<Value, std::string> || (ParameterList<Value> && !PointsToElements<Value>);
  }
}

/// How much memory a copy of `value` needs besides its own [bytes].
template <class Value>
[[nodiscard]] std::size_t bytes_in(Value const& value) {
  std::size_t bytes = 0;
  if constexpr (!has_list<Value>())
    return bytes;
  else if constexpr (Described<Value>)
    for_each_parameter<Value>([&](auto const& p) { bytes += bytes_in(value.*p.field); });
  else if constexpr (std::is_same_v<Value, std::string>)
    bytes = value.size();
  else if constexpr (Variant<Value>)
    with_alternative(value, [&](auto const& model, auto) { bytes = bytes_in(model); });
  else if constexpr (Optional<Value>)
    bytes = value ? bytes_in(*value) : 0;
  else
    for (auto const& element : elements_of(value)) bytes += sizeof(element) + bytes_in(element);
  return bytes;
}

}  // namespace cambium::detail
