#pragma once

#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium::detail {

CAMBIUM_COLD std::string ParameterPath::text() const {
  std::string own = outer != nullptr ? outer->text() : std::string();
  if (outer != nullptr && *name != '\0') own += '.';
  own += name;
  if (element == any_element)
    own += "[]";
  else if (element != no_list)
    own += "[" + std::to_string(element) + "]";
  return own;
}

template <class Number>
[[nodiscard]] std::string shortest_text(Number value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

CAMBIUM_COLD std::string number_text(double value) { return shortest_text(value); }

/// Name number `index` of "rk4|euler"; empty if there are fewer names.
[[nodiscard]] inline std::string_view choice_name(std::string_view names, std::uint64_t index) {
  for (; index > 0; --index) {
    auto const end = names.find('|');
    if (end == names.npos) return {};
    names.remove_prefix(end + 1);
  }
  return names.substr(0, names.find('|'));
}

CAMBIUM_COLD std::string value_text(ParameterInfo const& info, ParameterValue const& value) {
  using Kind = ParameterValue::Kind;
  switch (value.kind) {
    case Kind::boolean:
      return value.bits != 0 ? "true" : "false";
    case Kind::id:
    case Kind::lane:
      return to_string(static_cast<AgentId>(value.bits));
    case Kind::choice:
      if (auto const name = choice_name(info.choices != nullptr ? info.choices : "", value.bits); !name.empty())
        return std::string(name);
      return std::to_string(value.bits);
    case Kind::signed_integer:
      return std::to_string(static_cast<std::int64_t>(value.bits));
    case Kind::unsigned_integer:
      return std::to_string(value.bits);
    case Kind::single_precision:
      return shortest_text(static_cast<float>(value.number));
    case Kind::number:
      break;
  }
  return shortest_text(value.number);
}

CAMBIUM_COLD std::string with_unit(std::string number, char const* unit) {
  std::string_view const text(unit);
  if (!text.empty() && text != "-") (number += ' ') += text;
  return number;
}

CAMBIUM_COLD std::string range_text(ParameterInfo const& info) {
  if (info.choices != nullptr) {
    std::string names;
    for (char const* c = info.choices; *c != '\0'; ++c) names += *c == '|' ? std::string(", ") : std::string(1, *c);
    return names;
  }
  auto const& range = info.range;
  std::string text = range.low == any_finite.low ? "(-inf"
                     : range.low == positive.low ? "(0"
                                                 : "[" + number_text(range.low);
  return text + ", " + (range.high == any_finite.high ? "inf)" : number_text(range.high) + "]");
}

CAMBIUM_COLD void check_values(char const* name, void const* object, ReadStruct read, std::string const& where) {
  struct Check final : ParameterReader {
    std::string const* where = nullptr;

    [[nodiscard]] std::string place(ParameterPath const& path) const {
      return (where->empty() ? "" : *where + ": ") + path.text();
    }
    void value(ParameterPath const& path, ParameterInfo const& info, ParameterValue const& value,
               ParameterValue const*) override {
      if (value.in(info.range)) return;
      throw ParameterError(
          place(path), "is " + with_unit(value_text(info, value), info.unit),
          (info.choices != nullptr ? "give one of " : "give a value in ") + with_unit(range_text(info), info.unit));
    }
    void own_check(ParameterPath const& path, void const* checked,
                   void (*check)(void const*, std::string const&)) override {
      check(checked, place(path));
    }
  } reader;
  reader.where = &where;
  ParameterPath const root{nullptr, name};
  read(object, nullptr, &root, ListElements::each, reader);
}

CAMBIUM_COLD std::string parameters_table(void const* object, ReadStruct read) {
  struct Table final : ParameterReader {
    std::string rows = "| name | default | unit | range | meaning |\n|---|---|---|---|---|\n";

    void value(ParameterPath const& path, ParameterInfo const& info, ParameterValue const& value,
               ParameterValue const*) override {
      add(path, info, value_text(info, value), value.has_range() ? range_text(info) : "-");
    }
    void text(ParameterPath const& path, ParameterInfo const& info, std::string_view value,
              std::string_view const*) override {
      add(path, info, '"' + std::string(value) + '"', "-");
    }
    void alternative(ParameterPath const& path, ParameterInfo const& info, char const* name) override {
      add(path, info, name, "-");
    }
    void add(ParameterPath const& path, ParameterInfo const& info, std::string const& value, std::string const& range) {
      rows += "| " + path.text() + " | " + (path.is_any_element() ? "-" : value) + " | " + info.unit + " | " + range +
              " | " + info.sentence + " |\n";
    }
  } table;
  read(object, nullptr, nullptr, ListElements::one_default, table);
  return std::move(table.rows);
}

CAMBIUM_COLD std::string parameters_line(char const* name, void const* object, ReadStruct read) {
  struct Line final : ParameterReader {
    std::string line;
    bool is_first = true;

    void value(ParameterPath const& path, ParameterInfo const& info, ParameterValue const& value,
               ParameterValue const*) override {
      add(path, with_unit(value_text(info, value), info.unit));
    }
    void text(ParameterPath const& path, ParameterInfo const&, std::string_view value,
              std::string_view const*) override {
      add(path, '"' + std::string(value) + '"');
    }
    void alternative(ParameterPath const& path, ParameterInfo const&, char const* name) override { add(path, name); }
    void add(ParameterPath const& path, std::string const& value) {
      line += (is_first ? " " : ", ") + path.text() + "=" + value;
      is_first = false;
    }
  } reader;
  reader.line = std::string(name) + ":";
  read(object, nullptr, nullptr, ListElements::each, reader);
  return std::move(reader.line);
}

CAMBIUM_COLD std::uint64_t parameters_hash(char const* name, void const* object, ReadStruct read) {
  struct Hash final : ParameterReader {
    std::uint64_t hash = 0xcbf29ce484222325u;

    void add_bits(std::uint64_t bits) {
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 32;
    }
    void add_text(std::string_view text) {  // eight letters at a time: most of the time goes into names
      add_bits(text.size());
      std::uint64_t word = 0;
      for (std::size_t i = 0; i < text.size(); ++i) {
        word |= std::uint64_t{static_cast<unsigned char>(text[i])} << (8 * (i % 8));
        if (i % 8 != 7 && i + 1 != text.size()) continue;
        add_bits(word);
        word = 0;
      }
    }
    void add_path(ParameterPath const& path, ParameterInfo const& info) {
      for (auto const* key = &path; key != nullptr; key = key->outer) {
        if (key != &path) add_text(key->name);
        if (key->element != key->no_list) add_bits(key->element);
      }
      add_text(info.name);
    }
    void value(ParameterPath const& path, ParameterInfo const& info, ParameterValue const& value,
               ParameterValue const*) override {
      add_path(path, info);
      // + 0.0 turns -0 into 0
      add_bits(value.is_real() ? std::bit_cast<std::uint64_t>(value.number + 0.0) : value.bits);
    }
    void text(ParameterPath const& path, ParameterInfo const& info, std::string_view text,
              std::string_view const*) override {
      add_path(path, info);
      add_text(text);
    }
    void alternative(ParameterPath const& path, ParameterInfo const& info, char const* name) override {
      add_path(path, info);
      add_text(name);
    }
  } hash;
  hash.add_text(name);
  read(object, nullptr, nullptr, ListElements::each, hash);
  return hash.hash;
}

CAMBIUM_COLD bool parameters_equal(void const* a, void const* b, ReadStruct read) {
  struct Equality final : ParameterReader {
    bool holds = true;

    void value(ParameterPath const&, ParameterInfo const&, ParameterValue const& value,
               ParameterValue const* other) override {
      holds = holds && value.number == other->number && value.bits == other->bits;
    }
    void text(ParameterPath const&, ParameterInfo const&, std::string_view text,
              std::string_view const* other) override {
      holds = holds && text == *other;
    }
    void other_length() override { holds = false; }
  } equality;
  read(a, b, nullptr, ListElements::each, equality);
  return equality.holds;
}

}  // namespace cambium::detail
