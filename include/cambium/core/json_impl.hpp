#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/json.hpp"
#include "cambium/core/json_document.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/nearest_names.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/text.hpp"
#include "cambium/core/transfer_parameters.hpp"

namespace cambium::detail {

/// Where a transfer is: keys and elements from the root.
class JsonPath {
 public:
  void push(char const* key) { parts_.push_back({key, 0}); }
  void push(std::size_t element) { parts_.push_back({nullptr, element}); }
  void pop() { parts_.pop_back(); }
  [[nodiscard]] std::string text() const {
    std::string text;
    for (auto const& part : parts_)
      if (part.key == nullptr)
        text += "[" + std::to_string(part.element) + "]";
      else
        (text += text.empty() ? "" : ".") += part.key;
    return text;
  }

 private:
  struct Part {
    char const* key;
    std::size_t element;
  };
  std::vector<Part> parts_;
};

/// Turns a struct into a document.
class JsonWriter final : public ParameterTransfer {
 public:
  JsonWriter(JsonDetail detail, LaneNames const* lanes)
      : writes_all_(detail == JsonDetail::everything), lanes_(lanes) {}

  [[nodiscard]] JsonValue& root() { return *places_.front().value; }

  [[nodiscard]] bool field(char const* key) override {
    path_.push(key);
    places_.push_back({std::make_unique<JsonValue>(), writes_all_, key});
    return true;
  }
  void element(std::size_t index) override {
    path_.push(index);
    places_.push_back({std::make_unique<JsonValue>(), true, nullptr});
  }
  void end() override {
    path_.pop();
    auto place = std::move(places_.back());
    places_.pop_back();
    if (!place.is_written) return;
    auto& parent = places_.back();
    if (place.key == nullptr)
      std::get<std::vector<JsonValue>>(parent.value->value).push_back(std::move(*place.value));
    else
      std::get<std::vector<JsonValue::Member>>(parent.value->value).push_back({place.key, std::move(*place.value)});
  }

  void begin_struct() override {
    auto& place = places_.back();
    if (!place.alternative.empty()) {
      places_.push_back({std::make_unique<JsonValue>(), true, nullptr});
      places_.back().value->value = std::vector<JsonValue::Member>();
    } else {
      place.value->value = std::vector<JsonValue::Member>();
    }
  }
  void end_struct() override {
    auto& place = places_.back();
    if (places_.size() > 1 && !places_[places_.size() - 2].alternative.empty()) {
      auto inner = std::move(place);
      places_.pop_back();
      auto& outer = places_.back();
      auto const name = std::exchange(outer.alternative, {});
      outer.is_written = outer.is_written || inner.value->has_parts();
      if (!inner.value->has_parts())
        outer.value->value = name;
      else
        outer.value->value = std::vector<JsonValue::Member>{{name, std::move(*inner.value)}};
      return;
    }
    place.is_written = place.is_written || place.value->has_parts();
  }
  [[nodiscard]] std::size_t list(std::size_t length, std::size_t usual, bool) override {
    auto& place = places_.back();
    place.value->value = std::vector<JsonValue>();
    place.is_written = place.is_written || length > 0 || usual > 0;
    return length;
  }
  [[nodiscard]] std::size_t alternative(std::span<char const* const> names, std::size_t now,
                                        std::size_t usual) override {
    if (names[now] == nullptr)
      throw ParameterError(where(), "holds a struct that is not described, or has no default: a file cannot hold it",
                           "give it `parameters()` and `name`");
    auto& place = places_.back();
    place.alternative = alternative_name(names, now);
    place.is_written = place.is_written || now != usual;
    return now;
  }
  [[nodiscard]] bool presence(bool now) override {
    places_.back().is_written = places_.back().is_written || now;
    return now;
  }

  [[nodiscard]] ParameterValue value(ParameterInfo const& info, ParameterValue const& now, bool is_usual,
                                     ParameterValue const&, ParameterValue const&) override {
    auto& place = places_.back();
    place.is_written = place.is_written || !is_usual;
    place.value->value = json_of(info, now).value;
    return now;
  }
  void text(std::string& text, bool is_usual) override {
    auto& place = places_.back();
    place.is_written = place.is_written || !is_usual;
    place.value->value = text;
  }

  [[nodiscard]] std::string where() const override { return path_.text(); }

 private:
  [[nodiscard]] JsonValue json_of(ParameterInfo const& info, ParameterValue const& value) const {
    using Kind = ParameterValue::Kind;
    switch (value.kind) {
      case Kind::boolean:
        return {value.bits != 0};
      case Kind::choice:
        return {value_text(info, value)};
      case Kind::id:
      case Kind::lane:
        if (auto const id = static_cast<LaneId>(value.bits); !is_valid(id))
          return {std::string("none")};
        else if (value.kind == Kind::lane && lanes_ != nullptr)
          return {lanes_->name(id)};
        return {value.bits};
      case Kind::signed_integer:
        return {static_cast<std::int64_t>(value.bits)};
      case Kind::unsigned_integer:
        return {value.bits};
      case Kind::single_precision:
      case Kind::number:
        break;
    }
    if (std::isnan(value.number)) throw ParameterError(where(), "is not a number", "files hold numbers and infinity");
    if (std::isinf(value.number)) return {std::string(value.number > 0 ? "inf" : "-inf")};
    return {value.number};
  }

  struct Place {
    std::unique_ptr<JsonValue> value;
    bool is_written = false;
    char const* key = nullptr;
    std::string alternative{};  ///< the name of the alternative that follows
  };

  bool writes_all_;
  LaneNames const* lanes_;
  JsonPath path_;
  std::vector<Place> places_ = [] {
    std::vector<Place> places;
    places.push_back({std::make_unique<JsonValue>(), true, nullptr});
    return places;
  }();
};

/// Fills a struct from a document.
class JsonReader final : public ParameterTransfer {
 public:
  JsonReader(JsonValue const& document, char const* name, std::string const& where, LaneNames const* lanes)
      : file_(where), lanes_(lanes), places_{{&document}} {
    path_.push(name);
  }

  [[nodiscard]] bool field(char const* key) override {
    known_.push_back(key);
    auto& place = places_.back();
    auto const* const members = place.value != nullptr ? place.value->members() : nullptr;
    if (members == nullptr) return false;
    // Files mostly have the keys in the order of the description.
    for (std::size_t i = 0; i < members->size(); ++i) {
      auto const at = (place.next + i) % members->size();
      if ((*members)[at].first != key) continue;
      place.next = at + 1;
      ++place.found;
      path_.push(key);
      places_.push_back({&(*members)[at].second});
      return true;
    }
    return false;
  }
  void element(std::size_t index) override {
    path_.push(index);
    places_.push_back({&(*places_.back().value->items())[index]});
  }
  void end() override {
    path_.pop();
    places_.pop_back();
  }

  void begin_struct() override {
    auto& place = places_.back();
    if (place.alternative != nullptr) {
      path_.push(place.alternative);
      places_.push_back({place.inner});
    }
    auto& own = places_.back();
    own.first_known = known_.size();
    if (own.value != nullptr && own.value->members() == nullptr) refuse("an object");
  }
  void end_struct() override {
    auto const& place = places_.back();
    if (place.value != nullptr && place.found < place.value->members()->size()) {
      std::vector<std::string> const known(known_.begin() + static_cast<std::ptrdiff_t>(place.first_known),
                                           known_.end());
      for (auto const& [key, value] : *place.value->members())
        if (std::find(known.begin(), known.end(), key) == known.end())
          throw ParameterError(where(), "has no field \"" + key + "\"", suggestion(key, known));
    }
    known_.resize(place.first_known);
    if (places_.size() > 1 && places_[places_.size() - 2].alternative != nullptr) {
      path_.pop();
      places_.pop_back();
      places_.back().alternative = nullptr;
    }
  }
  [[nodiscard]] std::size_t list(std::size_t length, std::size_t, bool is_fixed) override {
    auto const* const items = places_.back().value->items();
    if (items == nullptr) refuse("a list");
    if (is_fixed && items->size() != length)
      throw ParameterError(where(), "has " + std::to_string(items->size()) + " elements",
                           "give " + std::to_string(length));
    return items->size();
  }
  [[nodiscard]] std::size_t alternative(std::span<char const* const> names, std::size_t, std::size_t) override {
    auto& place = places_.back();
    auto const* const members = place.value->members();
    auto const* const word = place.value->get<std::string>();
    if (word == nullptr && (members == nullptr || members->size() != 1))
      refuse("a name, or an object with one: {\"name\": {...}}");
    auto const& chosen = word != nullptr ? *word : members->front().first;
    std::vector<std::string> known;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == nullptr) continue;
      known.push_back(alternative_name(names, i));
      if (known.back() != chosen) continue;
      place.alternative = names[i];
      place.inner = word != nullptr ? nullptr : &members->front().second;
      return i;
    }
    std::string all;
    for (auto const& name : known) all += (all.empty() ? "" : ", ") + name;
    auto const near = nearest_names(chosen, known);
    throw ParameterError(where(), "there is no \"" + chosen + "\" here",
                         (near.empty() ? "" : suggestion(chosen, known) + " ") + ("There are: " + all));
  }
  [[nodiscard]] bool presence(bool) override { return places_.back().value->value.index() != 0; }

  [[nodiscard]] ParameterValue value(ParameterInfo const& info, ParameterValue const& now, bool,
                                     ParameterValue const& lowest, ParameterValue const& highest) override {
    using Kind = ParameterValue::Kind;
    auto const& json = *places_.back().value;
    auto const* const word = json.get<std::string>();
    switch (now.kind) {
      case Kind::boolean:
        if (auto const* const truth = json.get<bool>()) return ParameterValue(*truth);
        refuse("true or false");
      case Kind::choice:
        if (word == nullptr) refuse("one of " + range_text(info) + ", in quotes");
        return choice(info, now, *word);
      case Kind::id:
      case Kind::lane:
        if (word != nullptr && *word == "none") return with_bits(now, highest.bits);
        if (now.kind == Kind::lane && lanes_ != nullptr) {
          if (word == nullptr) refuse("a lane's name, in quotes");
          return ParameterValue(lanes_->lane(*word, where()));
        }
        return integer(json, now, lowest, highest);
      case Kind::signed_integer:
      case Kind::unsigned_integer:
        return integer(json, now, lowest, highest);
      case Kind::single_precision:
      case Kind::number:
        break;
    }
    auto number = now;
    if (auto const* const real = json.get<double>())
      number.number = *real;
    else if (auto const* const positive = json.get<std::uint64_t>())
      number.number = static_cast<double>(*positive);
    else if (auto const* const negative = json.get<std::int64_t>())
      number.number = static_cast<double>(*negative);
    else if (word != nullptr && (*word == "inf" || *word == "-inf"))
      number.number =
          *word == "inf" ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity();
    else
      refuse("a number");
    return number;
  }
  void text(std::string& text, bool) override {
    auto const* const word = places_.back().value->get<std::string>();
    if (word == nullptr) refuse("a text, in quotes");
    text = *word;
  }

  [[nodiscard]] std::string where() const override { return file_ + ": " + path_.text(); }

 private:
  [[noreturn]] void refuse(std::string const& expected) const {
    std::string found;
    if (!print_flat(*places_.back().value, 40, found)) found = places_.back().value->kind();
    throw ParameterError(where(), "is " + found, "give " + expected);
  }

  [[nodiscard]] static ParameterValue with_bits(ParameterValue value, std::uint64_t bits) {
    value.bits = bits;
    value.number = static_cast<double>(bits);
    return value;
  }

  [[nodiscard]] ParameterValue choice(ParameterInfo const& info, ParameterValue const& now,
                                      std::string const& word) const {
    std::vector<std::string> names;
    for (auto const name : split(info.choices, "|")) {
      if (name == word) return with_bits(now, names.size());
      names.emplace_back(name);
    }
    throw ParameterError(where(), "is \"" + word + "\"", suggestion(word, names));
  }

  [[nodiscard]] ParameterValue integer(JsonValue const& json, ParameterValue const& now, ParameterValue const& lowest,
                                       ParameterValue const& highest) const {
    auto const* const natural = json.get<std::uint64_t>();
    auto const* const negative = json.get<std::int64_t>();
    if (natural == nullptr && negative == nullptr) refuse("an integer");
    bool const is_below = negative != nullptr && (now.kind != ParameterValue::Kind::signed_integer ||
                                                  *negative < static_cast<std::int64_t>(lowest.bits));
    auto const most =
        now.kind == ParameterValue::Kind::id ? with_bits(highest, highest.bits - 1) : highest;  // not none
    bool const is_above = natural != nullptr && *natural > most.bits;
    if (is_below || is_above) refuse("an integer from " + value_text({}, lowest) + " to " + value_text({}, most));
    auto value = with_bits(now, natural != nullptr ? *natural : static_cast<std::uint64_t>(*negative));
    if (negative != nullptr) value.number = static_cast<double>(*negative);
    return value;
  }

  struct Place {
    JsonValue const* value;             ///< null: an alternative without fields in the file
    std::size_t first_known = 0;        ///< its keys in `known_` begin here
    std::size_t next = 0, found = 0;    ///< member to look at first; number of keys found
    char const* alternative = nullptr;  ///< that follows
    JsonValue const* inner = nullptr;   ///< its fields
  };

  std::string const& file_;
  LaneNames const* lanes_;
  JsonPath path_;
  std::vector<Place> places_;
  std::vector<char const*> known_;  ///< keys of the structs that are being read
};

CAMBIUM_COLD JsonValue json_value(void* object, void const* usual, TransferStruct transfer, JsonDetail detail,
                                  LaneNames const* lanes) {
  JsonWriter writer(detail, lanes);
  transfer(object, usual, writer);
  return std::move(writer.root());
}

CAMBIUM_COLD void read_json_value(JsonValue const& document, char const* name, void* object, void const* usual,
                                  TransferStruct transfer, std::string const& where, LaneNames const* lanes) {
  JsonReader reader(document, name, where, lanes);
  transfer(object, usual, reader);
}

}  // namespace cambium::detail
