#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/binary.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/json.hpp"
#include "cambium/core/json_document.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/nearest_names.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/text.hpp"
#include "cambium/core/type_info.hpp"

namespace cambium::inline v0_1::detail {

/// What an optional holds by default: what `usual` holds, else the default of its type.
[[nodiscard]] inline void const* usual_inner(TypeInfo const& optional, void const* usual) {
  auto const* const held = optional.held(usual);
  return held != nullptr ? held : optional.element().usual();
}

/// Turns a struct into a document.
class JsonWriter {
 public:
  JsonWriter(JsonDetail detail, LaneNames const* lanes)
      : writes_all_(detail == JsonDetail::everything), lanes_(lanes) {}

  /// Writes a value; returns whether it has to be in the file, because it differs from `usual`.
  bool write(ParameterPath const& path, ParameterInfo const& info, TypeInfo const& type, void const* object,
             void const* usual, JsonValue& json) const {
    using Kind = TypeInfo::Kind;
    switch (type.kind) {
      case Kind::structure:
        json.value = members(&path, type, object, usual);
        return json.has_parts();
      case Kind::one_of:
        return write_alternative(path, type, object, usual, json);
      case Kind::optional:
        if (auto const* const held = type.held(object)) {
          bool const differs = write(path, info, type.element(), held, usual_inner(type, usual), json);
          return differs || type.held(usual) == nullptr;
        }
        return type.held(usual) != nullptr;
      case Kind::list: {
        auto const elements = type.elements(object);
        std::vector<JsonValue> items(elements.count);
        for (std::size_t i = 0; i < elements.count; ++i)
          write(path.at(i), info, type.element(), elements[i], type.element().usual(), items[i]);
        json.value = std::move(items);
        return elements.count > 0 || type.elements(usual).count > 0;
      }
      case Kind::text:
        if (!is_utf8(*static_cast<std::string const*>(object)))
          throw ParameterError(path.text(), "is no UTF-8 text", "JSON holds no others: write it so, or a binary file");
        json.value = *static_cast<std::string const*>(object);
        break;
      default:
        json = json_of(path, info, type, PlainValue::at(object, type));
    }
    return !are_equal(type, object, usual, Equality::of_bits);  // 0 is not -0
  }

  /// The fields of a struct that have to be in the file.
  [[nodiscard]] std::vector<JsonValue::Member> members(ParameterPath const* path, TypeInfo const& type,
                                                       void const* object, void const* usual) const {
    std::vector<JsonValue::Member> members;
    for (auto const& field : type.fields()) {
      JsonValue::Member member{field.name};
      if (write({path, field.name}, field, field.type(), field.in(object), field.in(usual), member.second) ||
          writes_all_)
        members.push_back(std::move(member));
    }
    return members;
  }

 private:
  bool write_alternative(ParameterPath const& path, TypeInfo const& type, void const* object, void const* usual,
                         JsonValue& json) const {
    auto const index = type.index(object);
    auto const& model = type.alternatives[index]();
    if (!model.is_storable())
      throw ParameterError(path.text(),
                           "holds a struct that is not described, or has no default: a file cannot hold it",
                           "give it `parameters()` and `name`");
    bool const is_usual = type.index(usual) == index;
    ParameterPath const inner_path{&path, model.name};
    auto inner = members(&inner_path, model, type.held(object), is_usual ? type.held(usual) : model.usual());
    bool const is_written = !is_usual || !inner.empty();
    auto name = alternative_name(type, index);
    if (inner.empty())
      json.value = std::move(name);
    else
      json.value = std::vector<JsonValue::Member>{{std::move(name), {std::move(inner)}}};
    return is_written;
  }

  [[nodiscard]] JsonValue json_of(ParameterPath const& path, ParameterInfo const& info, TypeInfo const& type,
                                  PlainValue const& value) const {
    using Kind = TypeInfo::Kind;
    switch (value.kind) {
      case Kind::boolean:
        return {value.bits != 0};
      case Kind::choice:
        return {value_text(info, value)};
      case Kind::id:
      case Kind::lane:
      case Kind::corridor:
        if (value.bits == PlainValue::highest(type).bits) return {std::string("none")};  // of any width
        if (value.kind == Kind::lane && lanes_ != nullptr) return {lanes_->name(static_cast<LaneId>(value.bits))};
        return {value.bits};
      case Kind::signed_integer:
        return {static_cast<std::int64_t>(value.bits)};
      case Kind::unsigned_integer:
        return {value.bits};
      default:
        break;
    }
    if (std::isnan(value.number))
      throw ParameterError(path.text(), "is not a number", "files hold numbers and infinity");
    if (std::isinf(value.number)) return {std::string(value.number > 0 ? "inf" : "-inf")};
    return {value.number};
  }

  bool writes_all_;
  LaneNames const* lanes_;
};

/// Fills a struct from a document.
class JsonReader {
 public:
  JsonReader(std::string const& file, LaneNames const* lanes, JsonValue const& document)
      : file_(file), lanes_(lanes), room_(always + per_value * values_in(document)) {}

  /// Reads a value. `usual`: what an alternative or an optional is at first, if the object holds another or nothing.
  void read(ParameterPath const& path, ParameterInfo const& info, TypeInfo const& type, void* object, void const* usual,
            JsonValue const& json) const {
    using Kind = TypeInfo::Kind;
    switch (type.kind) {
      case Kind::structure:
        return read_struct(path, type, object, usual, json);
      case Kind::one_of:
        return read_alternative(path, type, object, usual, json);
      case Kind::optional:
        return read_optional(path, info, type, object, usual, json);
      case Kind::list: {
        auto const* const items = json.items();
        if (items == nullptr) refuse(path, json, "a list");
        if (items->size() < type.least || items->size() > type.most)
          throw ParameterError(
              where(path), "has " + std::to_string(items->size()) + " elements",
              std::string(type.least < type.most ? "give at most " : "give ") + std::to_string(type.most));
        auto const& element = type.element();
        take_room(items->size() * (element.size + bytes_in(element, element.usual())));
        return type.fill(object, items->size(), where(path), [&](std::size_t i, void* item, void const*) {
          element.assign(item, element.usual());  // what the file's elements differ from
          read(path.at(i), info, element, item, element.usual(), (*items)[i]);
        });
      }
      case Kind::text:
        if (auto const* const word = json.get<std::string>())
          *static_cast<std::string*>(object) = *word;
        else
          refuse(path, json, "a text, in quotes");
        return;
      default:
        plain(path, info, type, json).store(object, type);
    }
  }

  void read_struct(ParameterPath const& path, TypeInfo const& type, void* object, void const* usual,
                   JsonValue const& json) const {
    auto const* const members = json.members();
    if (members == nullptr) refuse(path, json, "an object");
    auto const& fields = type.fields();
    for (auto const& member : *members) {
      auto const field =
          std::find_if(fields.begin(), fields.end(), [&](FieldInfo const& one) { return one.name == member.first; });
      if (field == fields.end()) {
        std::vector<std::string> within;
        constexpr std::size_t enough = 16;
        if (auto const* const inner = member.second.members())
          for (std::size_t i = 0; i < std::min(enough, inner->size()); ++i) within.push_back((*inner)[i].first);
        throw ParameterError(where(path), "has no field \"" + member.first + "\"",
                             suggest_field(type, member.first, within));
      }
      read({&path, field->name}, *field, field->type(), field->in(object), field->in(usual), member.second);
    }
  }

 private:
  void read_optional(ParameterPath const& path, ParameterInfo const& info, TypeInfo const& type, void* object,
                     void const* usual, JsonValue const& json) const {
    bool const is_null = json.value.index() == 0, was_empty = type.held(object) == nullptr;
    type.select(object, !is_null);
    if (is_null) return;
    auto const& element = type.element();
    auto* const held = const_cast<void*>(type.held(object));
    auto const* const blank = usual_inner(type, usual);
    if (was_empty) {
      take_room(bytes_in(element, blank));
      element.assign(held, blank);
    }
    read(path, info, element, held, blank, json);
  }

  void read_alternative(ParameterPath const& path, TypeInfo const& type, void* object, void const* usual,
                        JsonValue const& json) const {
    auto const* const members = json.members();
    auto const* const word = json.get<std::string>();
    if (word == nullptr && (members == nullptr || members->size() != 1))
      refuse(path, json, "a name, or an object with one: {\"name\": {...}}");
    auto const& name = word != nullptr ? *word : members->front().first;
    auto const chosen = alternative_named(type, name);
    if (chosen == type.alternatives.size()) {
      auto const known = alternative_names(type);
      auto const near = nearest_names(name, known);
      throw ParameterError(where(path), "there is no \"" + name + "\" here",
                           near.empty() ? "give one of " + joined(known, ", ")
                                        : suggestion(name, known) + " There are: " + joined(known, ", "));
    }
    auto const& model = type.alternatives[chosen]();
    auto const* const blank = type.index(usual) == chosen ? type.held(usual) : model.usual();
    if (type.index(object) != chosen) {
      take_room(bytes_in(model, blank));
      type.select(object, chosen);
      model.assign(const_cast<void*>(type.held(object)), blank);
    }
    if (word == nullptr)
      read_struct({&path, model.name}, model, const_cast<void*>(type.held(object)), blank, members->front().second);
  }

  [[nodiscard]] PlainValue plain(ParameterPath const& path, ParameterInfo const& info, TypeInfo const& type,
                                 JsonValue const& json) const {
    using Kind = TypeInfo::Kind;
    auto const* const word = json.get<std::string>();
    switch (type.kind) {
      case Kind::boolean:
        if (auto const* const truth = json.get<bool>()) return with_bits(type, *truth);
        refuse(path, json, "true or false");
      case Kind::choice:
        if (word == nullptr) refuse(path, json, "one of " + range_text(info) + ", in quotes");
        return choice(path, info, type, *word);
      case Kind::id:
      case Kind::lane:
      case Kind::corridor:
        if (word != nullptr && *word == "none") return PlainValue::highest(type);
        if (type.kind == Kind::lane && lanes_ != nullptr) {
          if (word == nullptr) refuse(path, json, "a lane's name, in quotes");
          return with_bits(type, index_of(lanes_->lane(*word)));
        }
        return integer(path, type, json);
      case Kind::signed_integer:
      case Kind::unsigned_integer:
        return integer(path, type, json);
      default:
        break;
    }
    PlainValue number{type.kind, 0.0, 0};
    if (auto const* const real = json.get<double>())
      number.number = *real;
    else if (auto const* const positive = json.get<std::uint64_t>())
      number.number = static_cast<double>(*positive);
    else if (auto const* const negative = json.get<std::int64_t>())
      number.number = static_cast<double>(*negative);
    else if (word != nullptr && (*word == "inf" || *word == "-inf"))
      number.number = std::numeric_limits<double>::infinity() * (*word == "inf" ? 1.0 : -1.0);
    else
      refuse(path, json, "a number");
    return number;
  }

  /// How many values a document has, with those in others.
  [[nodiscard]] static std::size_t values_in(JsonValue const& json) {
    std::size_t count = 1;
    if (auto const* const items = json.items())
      for (auto const& item : *items) count += values_in(item);
    if (auto const* const members = json.members())
      for (auto const& member : *members) count += values_in(member.second);
    return count;
  }
  void take_room(std::size_t bytes) const {
    if (bytes > room_)
      throw ParameterError(file_, "expands to far more memory than a file of its size should",
                           "take another copy; if this one is sound, use the binary form");
    room_ -= bytes;
  }

  [[nodiscard]] std::string where(ParameterPath const& path) const { return file_ + ": " + path.text(); }
  [[noreturn]] void refuse(ParameterPath const& path, JsonValue const& json, std::string const& expected) const {
    std::string found;
    if (!print_flat(json, 40, found)) found = json.kind();
    throw ParameterError(where(path), "is " + found, "give " + expected);
  }

  [[nodiscard]] static PlainValue with_bits(TypeInfo const& type, std::uint64_t bits) {
    return {type.kind, static_cast<double>(bits), bits};
  }

  [[nodiscard]] PlainValue choice(ParameterPath const& path, ParameterInfo const& info, TypeInfo const& type,
                                  std::string const& word) const {
    auto const names = split(info.choices, "|");
    auto const at = static_cast<std::size_t>(std::find(names.begin(), names.end(), word) - names.begin());
    if (at < names.size()) return with_bits(type, at);
    throw ParameterError(where(path), "is \"" + word + "\"", suggestion(word, {names.begin(), names.end()}));
  }

  [[nodiscard]] PlainValue integer(ParameterPath const& path, TypeInfo const& type, JsonValue const& json) const {
    auto const* const natural = json.get<std::uint64_t>();
    auto const* const negative = json.get<std::int64_t>();
    auto const least = PlainValue::lowest(type);
    auto const most = type.kind == TypeInfo::Kind::signed_integer || type.kind == TypeInfo::Kind::unsigned_integer
                          ? PlainValue::highest(type)
                          : with_bits(type, PlainValue::highest(type).bits - 1);  // the highest id is none
    bool const is_integer = natural != nullptr || negative != nullptr;
    bool const is_below = negative != nullptr && (!type.is_signed || *negative < static_cast<std::int64_t>(least.bits));
    bool const is_above = natural != nullptr && *natural > most.bits;
    if (!is_integer || is_below || is_above)
      refuse(path, json,
             "an integer without fraction or exponent, from " + value_text({}, least) + " to " + value_text({}, most));
    auto const bits = natural != nullptr ? *natural : static_cast<std::uint64_t>(*negative);
    return {type.kind, negative != nullptr ? static_cast<double>(*negative) : static_cast<double>(bits), bits};
  }

  static constexpr std::size_t always = std::size_t{1} << 26, per_value = 1024;  // [bytes]

  std::string const& file_;
  LaneNames const* lanes_;
  mutable std::size_t room_;  ///< for elements of lists that are still to come [bytes]
};

CAMBIUM_COLD JsonValue json_value(TypeInfo const& type, void const* object, JsonDetail detail, LaneNames const* lanes) {
  return {JsonWriter(detail, lanes).members(nullptr, type, object, type.usual())};
}

CAMBIUM_COLD void read_json_value(JsonValue const& document, TypeInfo const& type, void* object, char const* name,
                                  std::string const& where, LaneNames const* lanes) {
  JsonReader(where, lanes, document).read_struct({nullptr, name}, type, object, type.usual(), document);
}

}  // namespace cambium::inline v0_1::detail
