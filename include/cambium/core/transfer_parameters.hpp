#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/core/described.hpp"
#include "cambium/core/detail/parameter_values.hpp"

namespace cambium::detail {

/// Carries the fields of described structs to a file or from it, without knowing the structs: every file format is one
/// of these. Each call hands over what a field is now and takes what it shall be; who writes a file returns what was
/// handed over. `is_usual` says that the value is the default of its struct.
class ParameterTransfer {
 public:
  /// Whether the file has field `key` of the current struct; `end` follows if so. If not, the field keeps its value.
  [[nodiscard]] virtual bool field(char const* key) = 0;
  /// Goes to an element of the current list; `end` follows.
  virtual void element(std::size_t index) = 0;
  virtual void end() = 0;

  /// The current field or element is a struct: its fields follow, and then `end_struct`.
  virtual void begin_struct() = 0;
  virtual void end_struct() = 0;
  /// It is a list; returns its length. `usual`: its length by default. `is_fixed`: the length must not change.
  [[nodiscard]] virtual std::size_t list(std::size_t length, std::size_t usual, bool is_fixed) = 0;
  /// It is one of several structs, of which the one at `now` is held, by default the one at `usual`; returns which it
  /// shall be. `names`: see `alternative_name`. Then its `begin_struct` follows.
  [[nodiscard]] virtual std::size_t alternative(std::span<char const* const> names, std::size_t now,
                                                std::size_t usual) = 0;
  /// It is optional; returns whether there is a value.
  [[nodiscard]] virtual bool presence(bool now) = 0;

  /// It is a value. `lowest`, `highest`: what its type can hold.
  [[nodiscard]] virtual ParameterValue value(ParameterInfo const& info, ParameterValue const& now, bool is_usual,
                                             ParameterValue const& lowest, ParameterValue const& highest) = 0;
  virtual void text(std::string& text, bool is_usual) = 0;

  /// Where the transfer is, for messages: file and key.
  [[nodiscard]] virtual std::string where() const = 0;

 protected:
  ~ParameterTransfer() = default;
};

/// Passes every field to `transfer`; `usual`, the same struct with its defaults, side by side with it.
template <Described T>
void transfer_struct(T& object, T const& usual, ParameterTransfer& transfer);

/// The names of a `OneOf`'s alternatives; null for those that no file can hold, because they are not described.
template <class... Models>
[[nodiscard]] std::span<char const* const> names_of(std::variant<Models...> const&) {
  static constexpr char const* names[] = {
      Described<Models> && std::is_default_constructible_v<Models> ? struct_name<Models>() : nullptr...};
  return names;
}

/// The name of an alternative in files: its own, or "name/2" for the second one of that name.
[[nodiscard]] inline std::string alternative_name(std::span<char const* const> names, std::size_t index) {
  if (names[index] == nullptr) return {};
  std::string const name(names[index]);
  int number = 1;
  for (std::size_t i = 0; i < index; ++i) number += names[i] != nullptr && name == names[i];
  return number == 1 ? name : name + "/" + std::to_string(number);
}

template <std::size_t i = 0, class... Models>
void transfer_alternative(std::size_t chosen, std::variant<Models...>& value, std::variant<Models...> const& usual,
                          ParameterTransfer& transfer) {
  if constexpr (i < sizeof...(Models)) {
    using Model = std::variant_alternative_t<i, std::variant<Models...>>;
    if (i != chosen) return transfer_alternative<i + 1>(chosen, value, usual, transfer);
    if constexpr (Described<Model> && std::is_default_constructible_v<Model>) {
      Model const blank = usual.index() == i ? *std::get_if<i>(&usual) : Model{};
      if (value.index() != i) value.template emplace<i>(blank);
      transfer_struct(*std::get_if<i>(&value), blank, transfer);
    }
  }
}

template <class Value>
[[nodiscard]] constexpr Value lowest_of() {
  if constexpr (std::is_enum_v<Value>)
    return static_cast<Value>(std::numeric_limits<std::underlying_type_t<Value>>::lowest());
  else
    return std::numeric_limits<Value>::lowest();
}
template <class Value>
[[nodiscard]] constexpr Value highest_of() {
  if constexpr (std::is_enum_v<Value>)
    return static_cast<Value>(std::numeric_limits<std::underlying_type_t<Value>>::max());
  else
    return std::numeric_limits<Value>::max();
}

template <class Value>
void transfer_value(ParameterInfo const& info, Value& value, Value const& usual, ParameterTransfer& transfer);

template <class Element>
void transfer_elements(ParameterInfo const& info, std::span<Element> elements, ParameterTransfer& transfer) {
  Element const usual{};
  for (std::size_t i = 0; i < elements.size(); ++i) {
    transfer.element(i);
    transfer_value(info, elements[i], usual, transfer);
    transfer.end();
  }
}

/// A list: a vector, a pointer to one, something made of a span, or of a fixed length.
template <ParameterList Value>
void transfer_list(ParameterInfo const& info, Value& value, std::size_t usual, ParameterTransfer& transfer) {
  using Element = ElementOf<Value>;
  auto const elements = elements_of(std::as_const(value));
  if constexpr (std::is_same_v<Value, std::vector<Element>>) {
    value.resize(transfer.list(value.size(), usual, false));
    transfer_elements(info, std::span<Element>(value), transfer);
  } else if constexpr (PointsToElements<Value>) {
    std::vector<Element> list(elements.begin(), elements.end());
    transfer_list(info, list, usual, transfer);
    value = std::make_shared<std::vector<Element> const>(std::move(list));
  } else if constexpr (std::is_constructible_v<Value, std::span<Element const>, std::string>) {
    std::vector<Element> list(elements.begin(), elements.end());
    transfer_list(info, list, usual, transfer);
    value = Value(std::span<Element const>(list), transfer.where());
  } else {
    static_cast<void>(transfer.list(elements.size(), usual, true));
    transfer_elements(info, std::span<Element>(value.data(), elements.size()), transfer);
  }
}

template <class Value>
void transfer_value(ParameterInfo const& info, Value& value, Value const& usual, ParameterTransfer& transfer) {
  if constexpr (Described<Value>) {
    transfer_struct(value, usual, transfer);
  } else if constexpr (std::is_same_v<Value, std::string>) {
    transfer.text(value, value == usual);
  } else if constexpr (Variant<Value>) {
    transfer_alternative(transfer.alternative(names_of(value), value.index(), usual.index()), value, usual, transfer);
  } else if constexpr (Optional<Value>) {
    using Inner = typename Value::value_type;
    if (!transfer.presence(value.has_value())) return value.reset();
    if (!value) value.emplace();
    transfer_value(info, *value, Inner{}, transfer);
  } else if constexpr (ParameterList<Value>) {
    transfer_list(info, value, elements_of(usual).size(), transfer);
  } else {
    value = transfer
                .value(info, ParameterValue(value), value == usual, ParameterValue(lowest_of<Value>()),
                       ParameterValue(highest_of<Value>()))
                .template as<Value>();
  }
}

template <Described T>
void transfer_struct(T& object, T const& usual, ParameterTransfer& transfer) {
  transfer.begin_struct();
  for_each_parameter<T>([&](auto const& entry) {
    if (!transfer.field(entry.name)) return;
    transfer_value(entry, object.*entry.field, usual.*entry.field, transfer);
    transfer.end();
  });
  transfer.end_struct();
}

using TransferStruct = void (*)(void* object, void const* usual, ParameterTransfer& transfer);
template <Described T>
void transfer_any(void* object, void const* usual, ParameterTransfer& transfer) {
  transfer_struct(*static_cast<T*>(object), *static_cast<T const*>(usual), transfer);
}

}  // namespace cambium::detail
