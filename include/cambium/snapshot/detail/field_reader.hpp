#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <boost/serialization/nvp.hpp>
#include <boost/serialization/string.hpp>

#include "cambium/core/parameters.hpp"
#include "cambium/snapshot/detail/field_writer.hpp"

namespace cambium::detail {

/// Reads what a `FieldWriter` has written. Throws `SnapshotError` where the content contradicts itself or is newer than
/// the structs, and `ParameterError` for a whole number out of its range. Real numbers keep their bits, whatever they
/// are: a planner that went wrong may remember NaN. `where`: the source, for messages.
template <class Archive>
class FieldReader {
 public:
  explicit FieldReader(Archive& archive, std::string where = "snapshot")
      : archive_(archive), where_(std::move(where)) {}

  /// Reads `value`, and brings structs of older versions up to date.
  template <class Value>
  void read(char const* key, Value& value) {
    read(key, value, {}, static_cast<Value const*>(nullptr));
    if (is_old_) upgrade(value);
  }

 private:
  template <class Value>
  void read(char const* key, Value& value, ParameterInfo const& info, Value const* like) {
    if constexpr (Described<Value>) {
      tagged(tags_, key, [&] { read_struct(value, like); });
    } else if constexpr (std::is_same_v<Value, std::string>) {
      value = text(key);
    } else if constexpr (Variant<Value>) {
      tagged(tags_, key, [&] { read_alternative(value); });
    } else if constexpr (Optional<Value>) {
      tagged(tags_, key, [&] {
        if (whole("present", 1) == 0) return value.reset();
        if (!value) value.emplace();
        read("value", *value, info, like != nullptr && *like ? &**like : nullptr);
      });
    } else if constexpr (ParameterList<Value>) {
      tagged(tags_, key, [&] { read_list(value, info, like); });
    } else {
      if constexpr (is_long_unsigned<Value>) {
        value = static_cast<Value>(whole(key, std::numeric_limits<decltype(stored(Value{}))>::max()));
      } else {
        auto held = stored(Value{});
        get(key, held);
        value = static_cast<Value>(held);
        if (std::is_same_v<Value, bool> && held > stored(true)) damaged();
      }
      if (!is_old_) check_range(value, info);
    }
  }

  /// Checks a whole number: it may be an index. A range of one value is none: `{}`.
  template <class Value>
  void check_range(Value const& value, ParameterInfo const& info) const {
    if (std::is_integral_v<decltype(stored(value))> && info.range.low < info.range.high &&
        !ParameterValue(value).in(info.range))
      refuse_value(info, ParameterValue(value));
  }

  template <class Value>
  void get(char const* key, Value& value) {
    archive_ >> boost::serialization::make_nvp(key, value);
    read_ += sizeof(value);
  }

  [[nodiscard]] std::uint64_t whole(char const* key, std::uint64_t most) {
    unsigned char small = 0;
    get(key, small);
    std::uint64_t number = small;
    if (small == 255) get("whole", number);
    if (number > most) damaged();
    return number;
  }
  [[nodiscard]] std::string text(char const* key) {
    std::string text;
    if (tags_ != nullptr) {
      get(key, text);
      read_ += text.size();
      return text;
    }
    for (auto left = count(key); left > 0; --left) {
      char letter = 0;
      get(key, letter);
      text += letter;
    }
    return text;
  }
  [[nodiscard]] std::size_t count(char const* key) {
    return static_cast<std::size_t>(whole(key, ArchivedTypes::longest));
  }

  void count_copied(std::size_t bytes) {
    copied_ += bytes;
    if (copied_ > ArchivedTypes::copied + ArchivedTypes::copied_per_byte * read_)
      throw SnapshotError(where_, "expands to far more memory than a file of its size should",
                          "take another copy; if this one is sound, store lists that repeat only once");
  }
  [[noreturn]] void refuse_value(ParameterInfo const& info, ParameterValue const& value) const {
    throw ParameterError(where_ + ": " + info.name, "is " + value_text(info, value),
                         "it lies outside of " + range_text(info) + ", the range of its description");
  }
  [[noreturn]] void damaged() const {
    throw SnapshotError(where_, "its content contradicts itself",
                        "restore the types that were saved; if these are the same, it is damaged");
  }

  [[nodiscard]] ArchivedTypes::Shape read_shape(KnownStruct const& type) {
    if (auto const* known = types_.shape(type)) return *known;
    unsigned char told = 0;
    get("fields", told);
    std::size_t const fields = told % 128;
    auto const version = told < 128 ? 0u : static_cast<unsigned>(count("version"));
    std::uint16_t names = 0;
    get("names", names);
    auto const refuse = [&](std::string const& what, char const* remedy) {
      throw SnapshotError(where_, std::string("its struct '") + type.name + "' " + what, remedy);
    };
    if (version > type.version)
      refuse("is of a newer version", "read it with the program that wrote it, or a newer one");
    if (fields > type.fields)
      refuse("has more fields than in this program",
             "read it with the program that wrote it, or a newer one; never remove a field from a description");
    if (version == type.version && names != type.hashes[fields])
      refuse("was saved with other fields, or in another order",
             "append new fields; if one changes its name or meaning, increase the struct's `version`");
    if (version < type.version && !type.upgrades)
      refuse("is of version " + std::to_string(version) + ", and this program knows no way from there",
             "give the struct a member `upgrade(unsigned from)`, or read it with an older program");
    types_.add({&type, version, fields});
    return {&type, version, fields};
  }

  template <Described T>
  void read_struct(T& object, T const* like) {
    if (++depth_ > ArchivedTypes::deepest) damaged();
    auto const known = read_shape(known_struct<T>);
    if (like != nullptr) {
      count_copied(bytes_in(*like));
      object = *like;
    }
    std::array<unsigned char, (field_count<T>() + 7) / 8> differs{};
    differs.fill(0xff);
    if (like != nullptr)
      for (std::size_t k = 0; k < (known.fields + 7) / 8 && k < differs.size(); ++k) get("differs", differs[k]);
    is_old_ = is_old_ || known.version < version_of<T>();  // from here on, `upgrade` checks
    std::size_t i = 0;
    for_each_parameter<T>([&](auto const& p) {
      if (i < known.fields && (differs[i / 8] >> i % 8 & 1u) != 0)
        read(p.name, object.*p.field, p, like != nullptr ? &(like->*p.field) : nullptr);
      else if (i >= known.fields)
        set_default(object, p);
      ++i;
    });
    if constexpr (requires { object.check(where_); })
      if (!is_old_) object.check(where_);
    --depth_;
  }

  /// Sets a field that an older file does not have.
  template <class T, class Field>
  void set_default(T& object, Field const& p) const {
    if constexpr (std::is_default_constructible_v<T>)
      object.*p.field = T{}.*p.field;
    else
      throw SnapshotError(where_, std::string("its struct '") + struct_name<T>() + "' has no '" + p.name + "' yet",
                          "read it with an older program: there is no default to give it");
  }

  template <class... Models>
  void read_alternative(std::variant<Models...>& value) {
    auto const names = names_of(value);
    auto const* const key = &type_key<std::variant<Models...>>;
    auto const number = count("alternative");
    if (number > types_.alternatives().size()) damaged();
    if (number == types_.alternatives().size()) {
      auto const name = text("name");
      std::size_t index = 0;
      while (index < names.size() && (names[index] == nullptr || alternative_name(names, index) != name)) ++index;
      if (index == names.size()) refuse_model(name, names);
      types_.alternatives().push_back({key, index});
    }
    if (types_.alternatives()[number].variant != key) damaged();
    read_chosen(types_.alternatives()[number].index, value, number);
  }

  [[noreturn]] void refuse_model(std::string const& name, std::span<char const* const> names) const {
    std::string ours;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] != nullptr) ours += (ours.empty() ? "" : ", ") + alternative_name(names, i);
    throw SnapshotError(where_,
                        "holds the model '" + name + "', which is not among those of this program (" + ours + ")",
                        "read it with the type that was saved");
  }

  template <std::size_t i = 0, class... Models>
  void read_chosen(std::size_t chosen, std::variant<Models...>& value, std::size_t number) {
    if constexpr (i < sizeof...(Models)) {
      using Model = std::variant_alternative_t<i, std::variant<Models...>>;
      if (i != chosen) return read_chosen<i + 1>(chosen, value, number);
      if constexpr (Described<Model> && std::is_default_constructible_v<Model>) {
        auto& model = value.template emplace<i>();
        auto const last = std::static_pointer_cast<Model const>(types_.alternatives()[number].last);
        read(struct_name<Model>(), model, {}, last.get());
        types_.alternatives()[number].last = std::make_shared<Model const>(model);
      }
    }
  }

  template <ParameterList Value>
  void read_list(Value& value, ParameterInfo const& info, Value const* like) {
    using Element = ElementOf<Value>;
    auto const known = like != nullptr ? elements_of(*like) : std::span<Element const>();
    auto const length = count("length");
    if constexpr (requires { Value::static_capacity; })
      if (length > Value::static_capacity) damaged();
    if constexpr (requires { value.push_back(Element{}); }) {
      value.clear();
      read_elements(value, length, info, known);
    } else if constexpr (is_made_of_list<Value>) {
      std::vector<Element> list;
      read_elements(list, length, info, known);
      make_list(value, std::move(list));
    } else {
      if (length != value.size()) damaged();
      for (std::size_t i = 0; i < length; ++i)
        read("item", value.data()[i], info, i < known.size() ? &known[i] : i > 0 ? &value.data()[i - 1] : nullptr);
    }
  }

  template <class Value>
  static constexpr bool is_made_of_list =
      PointsToElements<Value> || std::is_constructible_v<Value, std::span<ElementOf<Value> const>, std::string>;

  /// A list that cannot be changed in place.
  template <class Value>
  void make_list(Value& value, std::vector<ElementOf<Value>>&& list) const {
    if constexpr (PointsToElements<Value>)
      value = std::make_shared<std::vector<ElementOf<Value>> const>(std::move(list));
    else
      value = list.empty() ? Value{} : Value(std::span<ElementOf<Value> const>(list), where_);
  }

  template <class List, class Element>
  void read_elements(List& list, std::size_t length, ParameterInfo const& info, std::span<Element const> known) {
    for (std::size_t i = 0; i < length; ++i) {
      count_copied(sizeof(Element));
      Element element{};
      read("item", element, info, i < known.size() ? &known[i] : i > 0 ? &list[i - 1] : nullptr);
      list.push_back(std::move(element));
    }
  }

  /// Calls `upgrade` of the structs in `value` that the archive had in an older version, the innermost first, and
  /// checks what `read` has not. A pass of its own: until all is read, the next struct may refer to one as it was
  /// written.
  template <class Value>
  void upgrade(Value& value) {
    if constexpr (Described<Value>) {
      auto const* const shape = types_.shape(known_struct<Value>);
      std::size_t left = shape != nullptr ? shape->fields : 0;  // the others are defaults of today
      for_each_parameter<Value>([&](auto const& p) {
        if (left > 0) upgrade(value.*p.field);
        left -= left > 0;
      });
      if constexpr (Upgrades<Value>)
        if (shape != nullptr && shape->version < version_of<Value>()) value.upgrade(shape->version);
      for_each_parameter<Value>([&](auto const& p) { check_ranges(value.*p.field, p); });
      if constexpr (requires { value.check(where_); }) value.check(where_);
    } else if constexpr (Variant<Value>) {
      with_alternative(value, [&]<class Model>(Model const&, auto place) { upgrade(*std::get_if<place>(&value)); });
    } else if constexpr (Optional<Value>) {
      if (value) upgrade(*value);
    } else if constexpr (ParameterList<Value> && !std::is_same_v<Value, std::string>) {
      upgrade_list(value);
    }
  }

  template <ParameterList Value>
  void upgrade_list(Value& value) {
    auto const known = elements_of(value);
    std::vector<ElementOf<Value>> list(known.begin(), known.end());
    for (auto& element : list) upgrade(element);
    if constexpr (requires { value.push_back(list[0]); }) {
      value.clear();
      for (auto& element : list) value.push_back(std::move(element));
    } else if constexpr (is_made_of_list<Value>) {
      make_list(value, std::move(list));
    } else {
      std::move(list.begin(), list.end(), value.data());
    }
  }

  template <class Value>
  void check_ranges(Value const& value, ParameterInfo const& info) const {
    if constexpr (Described<Value> || Variant<Value> || std::is_same_v<Value, std::string>) {
      return;
    } else if constexpr (Optional<Value>) {
      if (value) check_ranges(*value, info);
    } else if constexpr (ParameterList<Value>) {
      for (auto const& element : elements_of(value)) check_ranges(element, info);
    } else {
      check_range(value, info);
    }
  }

  Archive& archive_;
  ArchiveTags* tags_ = tags_of(archive_);
  std::string where_;
  ArchivedTypes types_;
  int depth_ = 0;
  std::size_t read_ = 0, copied_ = 0;  ///< [bytes]
  bool is_old_ = false;                ///< a struct was of an older version
};

}  // namespace cambium::detail
