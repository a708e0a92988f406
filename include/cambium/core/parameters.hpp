#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/described.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/type_info.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// The name of an alternative of a `OneOf` in files: its own, or "name/2" for the second one of that name; empty if no
/// file can hold it.
[[nodiscard]] std::string alternative_name(TypeInfo const& one_of, std::size_t index);
/// The names of all that a file can hold.
[[nodiscard]] std::vector<std::string> alternative_names(TypeInfo const& one_of);
/// The alternative of that name; `alternatives.size()` if a file can hold none.
[[nodiscard]] std::size_t alternative_named(TypeInfo const& one_of, std::string const& name);

/// Calls `visit(type, part)` for what an object consists of: the fields of a struct, what a OneOf or an optional holds,
/// the elements of a list.
template <class Visit>
void for_each_part(TypeInfo const& type, void const* object, Visit const& visit) {
  using Kind = TypeInfo::Kind;
  if (type.kind == Kind::structure) {
    for (auto const& field : type.fields()) visit(field.type(), field.in(object));
  } else if (type.kind == Kind::one_of) {
    visit(type.alternatives[type.index(object)](), type.held(object));
  } else if (type.kind == Kind::optional) {
    if (auto const* const held = type.held(object)) visit(type.element(), held);
  } else if (type.kind == Kind::list) {
    auto const elements = type.elements(object);
    for (std::size_t i = 0; i < elements.count; ++i) visit(type.element(), elements[i]);
  }
}
/// The same with parts that `visit` may change. `where`: for messages of a list that checks its elements.
template <class Visit>
void for_each_part(TypeInfo const& type, void* object, std::string const& where, Visit const& visit) {
  if (type.kind == TypeInfo::Kind::list)
    return type.fill(object, type.elements(object).count, where,
                     [&](std::size_t, void* element, void const*) { visit(type.element(), element); });
  for_each_part(type, static_cast<void const*>(object),
                [&](TypeInfo const& part, void const* place) { visit(part, const_cast<void*>(place)); });
}

/// A key's path from the outermost struct, such as "source.ids[2]". It becomes text only on request.
struct ParameterPath {
  static constexpr std::size_t no_list = std::numeric_limits<std::size_t>::max(), any_element = no_list - 1;

  ParameterPath const* outer;
  char const* name;
  std::size_t element = no_list;  ///< index in the list; where the name is empty, in an element of a list of lists
  bool is_alternative = false;    ///< the name is that of the alternative that a `OneOf` holds

  [[nodiscard]] std::string text() const;
  /// Whether any part of the path stands for all elements of a list ("[]").
  [[nodiscard]] bool is_any_element() const {
    return element == any_element || (outer != nullptr && outer->is_any_element());
  }
  /// The path of an element of the list here.
  [[nodiscard]] ParameterPath at(std::size_t number) const {
    return element == no_list ? ParameterPath{outer, name, number} : ParameterPath{this, "", number};
  }
};

/// Which elements of a list are visited: each one, or a single default element that shows what elements look like.
enum class ListElements : bool { one_default, each };

/// Is told of all plain values in an object, nested ones too, in the order of the descriptions.
class ValueVisitor {
 public:
  virtual void value(ParameterPath const& path, ParameterInfo const& info, PlainValue const& value) = 0;
  virtual void text(ParameterPath const&, ParameterInfo const&, std::string const&) {}
  /// A `OneOf` holds the alternative `name`, as in files; its fields follow.
  virtual void alternative(ParameterPath const&, ParameterInfo const&, std::string const&) {}
  /// A list or an optional holds so many values, which follow.
  virtual void count(ParameterPath const&, ParameterInfo const&, std::size_t) {}
  /// The fields of a struct, or of an alternative, are done.
  virtual void end(ParameterPath const&, TypeInfo const&, void const*) {}

 protected:
  ~ValueVisitor() = default;
};

/// Visits the values in an object, which is at `path`, the field `info` of a struct.
void visit_values(ParameterPath const& path, ParameterInfo const& info, TypeInfo const& type, void const* object,
                  ListElements lists, ValueVisitor& visitor);

/// Calls `edit` with each plain value in an object, which it may change. `where`: for messages of a list that checks
/// its elements.
using EditValue = std::function<void(TypeInfo const& type, void* value)>;
void edit_values(TypeInfo const& type, void* object, std::string const& where, EditValue const& edit);

/// The range of the number at `place` in a struct; every number if it is none of its fields, nor of structs in it.
[[nodiscard]] Range range_at(TypeInfo const& type, void const* object, double const* place);

/// Shortest text that reads back as the same number.
[[nodiscard]] std::string number_text(double value);

/// The value as text: a number as above, a choice by its name, an id by its number or "none".
[[nodiscard]] std::string value_text(ParameterInfo const& info, PlainValue const& value);

/// "15 m/s"; no unit for "-" and "".
[[nodiscard]] std::string with_unit(std::string number, char const* unit);

/// The valid values as text: "[0, 70]", "(0, inf)"; the names of a choice.
[[nodiscard]] std::string range_text(ParameterInfo const& info);

/// `name`: of the struct in messages; null: its own.
void check_values(TypeInfo const& type, void const* object, char const* name, std::string const& where);
[[nodiscard]] std::string parameters_table(TypeInfo const& type);
[[nodiscard]] std::string parameters_line(TypeInfo const& type, void const* object);
[[nodiscard]] std::uint64_t parameters_hash(TypeInfo const& type, void const* object);
void set_number(TypeInfo const& type, void* object, std::string_view key, double number, std::string const& where);
/// A remedy for a `word` that is no field of a struct: a field of nearly that name; else a field of the structs in it,
/// or one whose type has that name, with its key; else the list of fields. `also`: further words to look for there.
[[nodiscard]] std::string suggest_field(TypeInfo const& type, std::string_view word,
                                        std::span<std::string const> also = {});

/// How numbers are compared: by `==`, so that 0 equals -0 and NaN nothing, or bit by bit.
enum class Equality : bool { of_values, of_bits };
[[nodiscard]] bool are_equal(TypeInfo const& type, void const* a, void const* b, Equality equality);

/// Whether the bits of two fields are equal.
template <class Value>
[[nodiscard]] bool same_bits(Value const& a, Value const& b) {
  return are_equal(type_info<Value>(), &a, &b, Equality::of_bits);
}

}  // namespace detail

/// Throws `ParameterError` unless every field is within its range (NaN never is). The message names `where` (a file, an
/// agent), the struct and key, the value and the range. If the struct or a nested one has a member `check`, calls it
/// after the checks of its fields.
template <Described T>
void check_parameters(T const& object, std::string const& where = {}) {
  detail::check_values(type_info<T>(), &object, nullptr, where);
}

/// True when all fields are equal by `==` (so 0 equals -0, and NaN equals nothing), lists element by element. Of
/// alternatives without a description only the types are compared.
template <Described T>
[[nodiscard]] bool equal_parameters(T const& a, T const& b) {
  return detail::are_equal(type_info<T>(), &a, &b, detail::Equality::of_values);
}

/// The parameters of T as a Markdown table with header: name, default, unit, range, meaning. A list is shown by the
/// rows of one element.
template <Described T>
[[nodiscard]] std::string describe_parameters() {
  static_assert(std::is_default_constructible_v<T>);
  return detail::parameters_table(type_info<T>());
}

/// One line for logs: "idm_classic: desired_speed=15 m/s, time_headway=1.5 s". Numbers read back as the same bits.
template <Described T>
[[nodiscard]] std::string to_string(T const& object) {
  return detail::parameters_line(type_info<T>(), &object);
}

/// Hash of the struct's name, its keys and the bits of its values. It is the same on every platform and in every run,
/// and changes when a field is renamed. Equal parameters have equal hashes, also where one program has a field as a
/// struct and another as a `OneOf` that holds that struct.
template <Described T>
[[nodiscard]] std::uint64_t hash_parameters(T const& object) {
  return detail::parameters_hash(type_info<T>(), &object);
}

/// Sets the real number of a described struct that `key` names: "desired_speed", "idm.desired_speed". Throws
/// `ParameterError` at `where` if there is none (with the nearest key), or if `number` is out of its range. Elements of
/// lists have no such key. O(fields of the structs that the key names).
template <Described T>
void set_parameter(T& object, std::string_view key, double number, std::string const& where = {}) {
  detail::set_number(type_info<T>(), &object, key, number, where);
}

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/core/parameters_impl.hpp"
#endif
