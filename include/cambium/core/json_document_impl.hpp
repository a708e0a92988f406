#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/json_document.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium::inline v0_1::detail {

/// "line 3, column 7": the place of byte `offset` (from 0).
[[nodiscard]] inline std::string place_in(std::string_view text, std::size_t offset) {
  auto const before = text.substr(0, std::min(offset, text.size()));
  auto const line = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1;
  auto const begin = before.rfind('\n');
  auto const column = before.size() - (begin == before.npos ? 0 : begin + 1) + 1;
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

/// Builds a document from the parser's events.
class JsonBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  JsonBuilder(std::string_view text, std::string const& where) : text_(text), where_(where) {}

  [[nodiscard]] JsonValue& root() { return root_; }

  bool null() override { return add({}); }
  bool boolean(bool value) override { return add({value}); }
  bool number_integer(std::int64_t value) override { return add({value}); }
  bool number_unsigned(std::uint64_t value) override { return add({value}); }
  bool number_float(double value, std::string const&) override { return add({value}); }
  bool string(std::string& value) override { return add({std::move(value)}); }
  bool binary(nlohmann::json::binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open({std::vector<JsonValue::Member>()}); }
  bool start_array(std::size_t) override { return open({std::vector<JsonValue>()}); }
  bool key(std::string& value) override {
    std::get<std::vector<JsonValue::Member>>(open_.back()->value).push_back({std::move(value)});
    return true;
  }
  bool end_object() override {
    names_.clear();
    for (auto const& member : *open_.back()->members()) names_.push_back(member.first);
    std::sort(names_.begin(), names_.end());
    if (auto const twice = std::adjacent_find(names_.begin(), names_.end()); twice != names_.end())
      throw ParameterError(where_, "the key \"" + std::string(*twice) + "\" is there twice in one object",
                           "remove one of them");
    return close();
  }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t position, std::string const& token, nlohmann::json::exception const& error) override {
    auto const at = std::min(position > 0 ? position - 1 : 0, text_.size());
    bool const is_end = at >= text_.find_last_not_of(" \t\r\n") + 1;
    bool const is_number = dynamic_cast<nlohmann::json::out_of_range const*>(&error) != nullptr;
    throw ParameterError(where_ + ", " + place_in(text_, at),
                         is_end && !is_number ? "the text ends too early"
                         : is_number          ? "the number " + token + " is too large"
                                              : "this is no JSON (at '" + last_of(token) + "')",
                         is_number ? "give one below 1.8e308" : "compare with a file that cambium wrote");
  }

 private:
  static constexpr std::size_t deepest = 100;

  /// The last 20 characters of what the parser could not read.
  [[nodiscard]] static std::string last_of(std::string const& token) {
    return token.size() <= 20 ? token : token.substr(token.size() - 20);
  }

  JsonValue* place(JsonValue&& value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    auto& parent = open_.back()->value;
    if (auto* const items = std::get_if<std::vector<JsonValue>>(&parent)) return &items->emplace_back(std::move(value));
    auto& member = std::get<std::vector<JsonValue::Member>>(parent).back().second;
    member = std::move(value);
    return &member;
  }
  bool add(JsonValue&& value) {
    place(std::move(value));
    return true;
  }
  bool open(JsonValue&& value) {
    if (open_.size() >= deepest)
      throw ParameterError(where_, "objects and lists are nested deeper than " + std::to_string(deepest),
                           "compare with a file that cambium wrote");
    open_.push_back(place(std::move(value)));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  std::string_view text_;
  std::string const& where_;
  JsonValue root_;
  std::vector<std::string_view> names_;  ///< scratch of `end_object`
  std::vector<JsonValue*> open_;  ///< from the root to the current object or list; parents do not move while open
};

CAMBIUM_COLD JsonValue parse_json(std::string_view text, std::string const& where) {
  JsonBuilder builder(text, where);
  nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
  return std::move(builder.root());
}

CAMBIUM_COLD bool is_utf8(std::string const& text) {
  try {
    (void)nlohmann::json(text).dump();
    return true;
  } catch (nlohmann::json::type_error const&) {
    return false;
  }
}

CAMBIUM_COLD bool print_flat(JsonValue const& value, std::size_t most, std::string& text) {
  auto const list = [&](auto const& parts, char begin, char end, auto const& print) {
    text += begin;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (i > 0) text += ", ";
      if (!print(parts[i])) return false;
    }
    text += end;
    return text.size() <= most;
  };
  if (auto const* const items = value.items())
    return list(*items, '[', ']', [&](JsonValue const& item) { return print_flat(item, most, text); });
  if (auto const* const members = value.members())
    return list(*members, '{', '}', [&](JsonValue::Member const& member) {
      print_flat({member.first}, most, text);
      text += ": ";
      return print_flat(member.second, most, text);
    });
  if (auto const* const truth = value.get<bool>())
    text += *truth ? "true" : "false";
  else if (auto const* const integer = value.get<std::int64_t>())
    text += std::to_string(*integer);
  else if (auto const* const natural = value.get<std::uint64_t>())
    text += std::to_string(*natural);
  else if (auto const* const number = value.get<double>())
    text += *number == 0.0 && std::signbit(*number) ? "-0.0" : number_text(*number);  // "-0" reads as an integer
  else if (auto const* const word = value.get<std::string>())
    text += nlohmann::json(*word).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  else
    text += "null";
  return text.size() <= most;
}

inline void print_broken(JsonValue const& value, std::size_t indent, std::size_t width, std::string& text) {
  auto const begin = text.size();
  if (print_flat(value, begin + width - std::min(indent, width), text) || !value.has_parts()) return;
  text.resize(begin);
  auto const* const members = value.members();
  std::size_t const size = members != nullptr ? members->size() : value.items()->size();
  text += members != nullptr ? "{" : "[";
  for (std::size_t i = 0; i < size; ++i) {
    (text += i == 0 ? "\n" : ",\n").append(indent + 1, ' ');
    if (members != nullptr) {
      print_flat({(*members)[i].first}, std::string::npos, text);
      text += ": ";
    }
    print_broken(members != nullptr ? (*members)[i].second : (*value.items())[i], indent + 1, width, text);
  }
  (text += '\n').append(indent, ' ');
  text += members != nullptr ? "}" : "]";
}

CAMBIUM_COLD std::string print_json(JsonValue const& document, std::size_t width) {
  std::string text;
  print_broken(document, 0, width, text);
  return text += '\n';
}

}  // namespace cambium::inline v0_1::detail
