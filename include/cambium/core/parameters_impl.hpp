#pragma once

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/hash.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/nearest_names.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/text.hpp"
#include "cambium/core/type_info.hpp"

namespace cambium::inline v0_1 {

CAMBIUM_COLD PlainValue PlainValue::at(void const* object, TypeInfo const& type) {
  PlainValue value{type.kind, 0.0, 0};
  if (type.kind == TypeInfo::Kind::number) {
    std::memcpy(&value.number, object, sizeof value.number);
  } else if (type.kind == TypeInfo::Kind::single_precision) {
    float number = 0;
    std::memcpy(&number, object, sizeof number);
    value.number = static_cast<double>(number);
  } else {
    auto const read = [&]<class Whole>(Whole whole) {
      std::memcpy(&whole, object, sizeof whole);
      value.number = static_cast<double>(whole);
      value.bits = static_cast<std::uint64_t>(whole);
    };
    detail::with_integer(type.size, type.is_signed, read);
  }
  return value;
}

CAMBIUM_COLD void PlainValue::store(void* object, TypeInfo const& type) const {
  if (type.kind == TypeInfo::Kind::number) {
    std::memcpy(object, &number, sizeof number);
  } else if (type.kind == TypeInfo::Kind::single_precision) {
    auto const single = static_cast<float>(number);
    std::memcpy(object, &single, sizeof single);
  } else {
    detail::with_integer(type.size, type.is_signed, [&]<class Whole>(Whole) {
      auto const whole = static_cast<Whole>(type.kind == TypeInfo::Kind::boolean ? bits != 0 : bits);
      std::memcpy(object, &whole, sizeof whole);
    });
  }
}

CAMBIUM_COLD PlainValue PlainValue::lowest(TypeInfo const& type) {
  std::uint64_t bits = 0;
  detail::with_integer(type.size, type.is_signed, [&]<class Whole>(Whole) {
    bits = static_cast<std::uint64_t>(std::numeric_limits<Whole>::lowest());
  });
  return {type.kind, static_cast<double>(static_cast<std::int64_t>(bits)), bits};
}

CAMBIUM_COLD PlainValue PlainValue::highest(TypeInfo const& type) {
  std::uint64_t bits = 0;
  detail::with_integer(type.size, type.is_signed, [&]<class Whole>(Whole) {
    bits = static_cast<std::uint64_t>(std::numeric_limits<Whole>::max());
  });
  return {type.kind, static_cast<double>(bits), bits};
}

}  // namespace cambium::inline v0_1

namespace cambium::inline v0_1::detail {

/// Adds a code for the binary form of a field.
inline void add_letters(Fnv1a<std::uint32_t>& hash, TypeInfo const& type) {
  using Kind = TypeInfo::Kind;
  auto const add = [&hash](char letter) { hash.add_byte(static_cast<unsigned char>(letter)); };
  switch (type.kind) {
    case Kind::structure:
      return add('s');
    case Kind::text:
      return add('t');
    case Kind::one_of:
      return add('v');
    case Kind::optional:
    case Kind::list:
      add(type.kind == Kind::list ? 'l' : 'o');
      return add_letters(hash, type.element());
    default:
      add(type.is_real() ? 'f' : type.is_long_unsigned() ? 'w' : 'i');
      add(type.is_long_unsigned() ? '8' : static_cast<char>('0' + type.size));  // 'w': of any size
  }
}

CAMBIUM_COLD std::uint16_t hash_of_fields(std::span<FieldInfo const> fields) {
  Fnv1a<std::uint32_t> hash;
  for (auto const& field : fields) {
    for (char const letter : std::string_view(field.name)) hash.add_byte(static_cast<unsigned char>(letter));
    add_letters(hash, field.type());
  }
  return static_cast<std::uint16_t>(hash.value() ^ hash.value() >> 16);
}

CAMBIUM_COLD std::string alternative_name(TypeInfo const& one_of, std::size_t index) {
  auto const& model = one_of.alternatives[index]();
  if (!model.is_storable()) return {};
  std::string const name(model.name);
  int number = 1;
  for (std::size_t i = 0; i < index; ++i) {
    auto const& other = one_of.alternatives[i]();
    number += other.is_storable() && name == other.name;
  }
  return number == 1 ? name : name + "/" + std::to_string(number);
}

CAMBIUM_COLD std::vector<std::string> alternative_names(TypeInfo const& one_of) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < one_of.alternatives.size(); ++i)
    if (one_of.alternatives[i]().is_storable()) names.push_back(alternative_name(one_of, i));
  return names;
}

CAMBIUM_COLD std::size_t alternative_named(TypeInfo const& one_of, std::string const& name) {
  std::size_t index = 0;
  while (index < one_of.alternatives.size() && (name.empty() || alternative_name(one_of, index) != name)) ++index;
  return index;
}

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

CAMBIUM_COLD std::string value_text(ParameterInfo const& info, PlainValue const& value) {
  using Kind = TypeInfo::Kind;
  switch (value.kind) {
    case Kind::boolean:
      return value.bits != 0 ? "true" : "false";
    case Kind::id:
    case Kind::lane:
    case Kind::corridor:
      return to_string(static_cast<AgentId>(value.bits));
    case Kind::choice:
      if (auto const names = split(info.choices != nullptr ? info.choices : "", "|"); value.bits < names.size())
        if (auto const name = names[value.bits]; !name.empty()) return std::string(name);
      return std::to_string(value.bits);
    case Kind::signed_integer:
      return std::to_string(static_cast<std::int64_t>(value.bits));
    case Kind::unsigned_integer:
      return std::to_string(value.bits);
    case Kind::single_precision:
      return shortest_text(static_cast<float>(value.number));
    default:
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
  if (info.choices != nullptr) return joined(split(info.choices, "|"), ", ");
  auto const& range = info.range;
  std::string text = range.low == any_finite.low ? "(-inf"
                     : range.low == positive.low ? "(0"
                                                 : "[" + number_text(range.low);
  return text + ", " + (range.high == any_finite.high ? "inf)" : number_text(range.high) + "]");
}

/// Visits the fields of a struct. `own`: its path; null if keys start with its fields.
inline void visit_fields(TypeInfo const& type, void const* object, ParameterPath const* own, ListElements lists,
                         ValueVisitor& visitor) {
  for (auto const& field : type.fields())
    visit_values({own, field.name}, field, field.type(), field.in(object), lists, visitor);
  if (own != nullptr) visitor.end(*own, type, object);
}

CAMBIUM_COLD void visit_values(ParameterPath const& path, ParameterInfo const& info, TypeInfo const& type,
                               void const* object, ListElements lists, ValueVisitor& visitor) {
  switch (type.kind) {
    case TypeInfo::Kind::structure:
      return visit_fields(type, object, &path, lists, visitor);
    case TypeInfo::Kind::text:
      return visitor.text(path, info, *static_cast<std::string const*>(object));
    case TypeInfo::Kind::one_of: {
      auto const& model = type.alternatives[type.index(object)]();
      ParameterPath const inner{&path, model.name, ParameterPath::no_list, true};
      auto const named = alternative_name(type, type.index(object));
      visitor.alternative(path, info, named.empty() ? model.name : named);
      if (model.kind == TypeInfo::Kind::structure)
        return visit_fields(model, type.held(object), &inner, lists, visitor);
      return visitor.end(inner, model, type.held(object));
    }
    case TypeInfo::Kind::optional:
      visitor.count(path, info, type.held(object) != nullptr ? 1 : 0);
      if (auto const* const held = type.held(object)) visit_values(path, info, type.element(), held, lists, visitor);
      return;
    case TypeInfo::Kind::list: {
      auto const& element = type.element();
      if (lists == ListElements::one_default)
        return visit_values(path.at(ParameterPath::any_element), info, element, element.usual(), lists, visitor);
      auto const elements = type.elements(object);
      visitor.count(path, info, elements.count);
      for (std::size_t i = 0; i < elements.count; ++i)
        visit_values(path.at(i), info, element, elements[i], lists, visitor);
      return;
    }
    case TypeInfo::Kind::opaque:
      return;
    default:
      visitor.value(path, info, PlainValue::at(object, type));
  }
}

CAMBIUM_COLD void edit_values(TypeInfo const& type, void* object, std::string const& where, EditValue const& edit) {
  if (type.is_plain()) return edit(type, object);
  for_each_part(type, object, where, [&](TypeInfo const& part, void* place) { edit_values(part, place, where, edit); });
}

CAMBIUM_COLD Range range_at(TypeInfo const& type, void const* object, double const* place) {
  for (auto const& field : type.fields()) {
    auto const& inner = field.type();
    if (inner.kind == TypeInfo::Kind::number && field.in(object) == place) return field.range;
    if (inner.kind != TypeInfo::Kind::structure) continue;
    auto const range = range_at(inner, field.in(object), place);
    if (range.low != any_finite.low || range.high != any_finite.high) return range;
  }
  return any_finite;
}

CAMBIUM_COLD void check_values(TypeInfo const& type, void const* object, char const* name, std::string const& where) {
  struct Check final : ValueVisitor {
    std::string const* where = nullptr;

    [[nodiscard]] std::string place(ParameterPath const& path) const {
      return (where->empty() ? "" : *where + ": ") + path.text();
    }
    void value(ParameterPath const& path, ParameterInfo const& info, PlainValue const& value) override {
      if (value.in(info.range)) return;
      throw ParameterError(
          place(path), "is " + with_unit(value_text(info, value), info.unit),
          (info.choices != nullptr ? "give one of " : "give a value in ") + with_unit(range_text(info), info.unit));
    }
    void end(ParameterPath const& path, TypeInfo const& type, void const* checked) override {
      if (type.check != nullptr) type.check(checked, place(path));
    }
  } reader;
  reader.where = &where;
  ParameterPath const root{nullptr, name != nullptr ? name : type.name};
  visit_fields(type, object, &root, ListElements::each, reader);
}

/// Is told of all values as texts; `value` is null for texts and alternatives.
class TextVisitor : public ValueVisitor {
 public:
  virtual void add(ParameterPath const& path, ParameterInfo const& info, std::string text, PlainValue const* value) = 0;
  void value(ParameterPath const& path, ParameterInfo const& info, PlainValue const& value) final {
    add(path, info, value_text(info, value), &value);
  }
  void text(ParameterPath const& path, ParameterInfo const& info, std::string const& text) final {
    add(path, info, '"' + text + '"', nullptr);
  }
  void alternative(ParameterPath const& path, ParameterInfo const& info, std::string const& name) final {
    add(path, info, name, nullptr);
  }

 protected:
  ~TextVisitor() = default;
};

CAMBIUM_COLD std::string parameters_table(TypeInfo const& type) {
  struct Table final : TextVisitor {
    std::string rows = "| name | default | unit | range | meaning |\n|---|---|---|---|---|\n";

    void add(ParameterPath const& path, ParameterInfo const& info, std::string text, PlainValue const* value) override {
      auto const range = value != nullptr && value->has_range() ? range_text(info) : "-";
      rows += "| " + path.text() + " | " + (path.is_any_element() ? "-" : text) + " | " + info.unit + " | " + range +
              " | " + info.sentence + " |\n";
    }
  } table;
  visit_fields(type, type.usual(), nullptr, ListElements::one_default, table);
  return std::move(table.rows);
}

CAMBIUM_COLD std::string parameters_line(TypeInfo const& type, void const* object) {
  struct Line final : TextVisitor {
    std::vector<std::string> values;

    void add(ParameterPath const& path, ParameterInfo const& info, std::string text, PlainValue const* value) override {
      values.push_back(path.text() + "=" + (value != nullptr ? with_unit(std::move(text), info.unit) : text));
    }
  } line;
  visit_fields(type, object, nullptr, ListElements::each, line);
  return type.name + std::string(line.values.empty() ? ":" : ": ") + joined(line.values, ", ");
}

CAMBIUM_COLD std::uint64_t parameters_hash(TypeInfo const& type, void const* object) {
  struct Hash final : ValueVisitor {
    std::uint64_t hash = 0;

    void add_bits(std::uint64_t bits) { hash = mixed(hash, bits); }
    void add_text(std::string_view text) { add_bits(checksum_of(text)); }
    void add_path(ParameterPath const& path) {
      for (auto const* key = &path; key != nullptr; key = key->outer) {
        if (!key->is_alternative) add_text(key->name);
        if (key->element != key->no_list) add_bits(key->element);
      }
    }
    void value(ParameterPath const& path, ParameterInfo const&, PlainValue const& value) override {
      add_path(path);
      // + 0.0 turns -0 into 0
      add_bits(value.is_real() ? std::bit_cast<std::uint64_t>(value.number + 0.0) : value.bits);
    }
    void text(ParameterPath const& path, ParameterInfo const&, std::string const& text) override {
      add_path(path);
      add_text(text);
    }
    void count(ParameterPath const& path, ParameterInfo const&, std::size_t parts) override {
      add_path(path);
      add_bits(parts);
    }
    void alternative(ParameterPath const& path, ParameterInfo const&, std::string const& name) override {
      if (name.find('/') == name.npos) return;  // `end` adds it
      add_path(path);
      add_text(name);
    }
    void end(ParameterPath const& path, TypeInfo const& type, void const*) override {
      add_path(path);
      add_text(type.name);
    }
  } hash;
  hash.add_text(type.name);
  visit_fields(type, object, nullptr, ListElements::each, hash);
  return hash.hash;
}

CAMBIUM_COLD bool are_equal(TypeInfo const& type, void const* a, void const* b, Equality equality) {
  // Equal bytes are equal fields; the reverse does not hold, because of padding.
  if (equality == Equality::of_bits && type.is_trivial && type.kind != TypeInfo::Kind::opaque &&
      std::memcmp(a, b, type.size) == 0)
    return true;
  switch (type.kind) {
    case TypeInfo::Kind::structure:
      for (auto const& field : type.fields())
        if (!are_equal(field.type(), field.in(a), field.in(b), equality)) return false;
      return true;
    case TypeInfo::Kind::text:
      return *static_cast<std::string const*>(a) == *static_cast<std::string const*>(b);
    case TypeInfo::Kind::one_of:
      return type.index(a) == type.index(b) &&
             are_equal(type.alternatives[type.index(a)](), type.held(a), type.held(b), equality);
    case TypeInfo::Kind::optional: {
      auto const *const left = type.held(a), *const right = type.held(b);
      if (left == nullptr || right == nullptr) return left == right;
      return are_equal(type.element(), left, right, equality);
    }
    case TypeInfo::Kind::list: {
      auto const left = type.elements(a), right = type.elements(b);
      bool same = left.count == right.count;
      for (std::size_t i = 0; same && i < left.count; ++i)
        same = are_equal(type.element(), left[i], right[i], equality);
      return same;
    }
    case TypeInfo::Kind::opaque:
      return equality == Equality::of_values;
    default:
      break;
  }
  if (equality == Equality::of_bits || !type.is_real()) return std::memcmp(a, b, type.size) == 0;
  return PlainValue::at(a, type).number == PlainValue::at(b, type).number;
}

/// The key of the first field that `is_meant` in the structs within a struct, those nearest to the top first.
CAMBIUM_COLD std::string key_within(TypeInfo const& type, std::function<bool(FieldInfo const&)> const& is_meant,
                                    int depth = 4) {
  auto const search = [&](auto const& find) -> std::string {
    for (auto const& field : type.fields())
      if (field.type().kind == TypeInfo::Kind::structure)
        if (std::string const key = find(field.type()); !key.empty()) return field.name + ("." + key);
    return "";
  };
  auto const key = search([&](TypeInfo const& part) -> std::string {
    for (auto const& field : part.fields())
      if (is_meant(field)) return field.name;
    return "";
  });
  if (!key.empty() || depth == 0) return key;
  return search([&](TypeInfo const& part) { return key_within(part, is_meant, depth - 1); });
}

CAMBIUM_COLD std::string suggest_field(TypeInfo const& type, std::string_view word, std::span<std::string const> also) {
  auto const names = names_of(type.fields());
  if (!nearest_names(word, names).empty()) return suggestion(word, names);
  auto const is_called = [](std::string_view wanted) {
    return [wanted](FieldInfo const& field) { return field.name == wanted; };
  };
  auto const is_near = [&](FieldInfo const& field) { return !nearest_names(word, {field.name}).empty(); };
  for (auto const& field : type.fields())
    if (field.type().kind == TypeInfo::Kind::structure && field.type().name == word)
      return "is it " + std::string(field.name) + "?";
  for (auto const& key : {key_within(type, is_called(word)), key_within(type, is_near)})
    if (!key.empty()) return "is it " + key + "?";
  for (auto const& other : also)
    if (auto const key = key_within(type, is_called(other)); !key.empty()) return "its " + other + " may be " + key;
  return suggestion(word, names);
}

CAMBIUM_COLD void set_number(TypeInfo const& type, void* object, std::string_view key, double number,
                             std::string const& where) {
  auto const place = (where.empty() ? "" : where + ": ") + (key.empty() ? "the empty key" : std::string(key));
  auto const refuse = [&](std::string const& remedy) {
    throw ParameterError(place, "there is no number of that key", remedy);
  };
  char const* const of_list = "elements of lists have no key: set the list in a file";
  auto const* here = &type;
  ParameterInfo const* info = nullptr;
  auto const enter = [&](TypeInfo const& part, void const* at) {
    here = &part;
    object = const_cast<void*>(at);
  };
  auto const enter_optional = [&] {
    if (here->kind != TypeInfo::Kind::optional) return;
    auto const* const held = here->held(object);
    if (held == nullptr) refuse("it is in an optional that holds nothing");
    enter(here->element(), held);
  };
  for (auto const name : split(key, ".")) {
    enter_optional();
    std::vector<std::string> names;
    if (here->kind == TypeInfo::Kind::one_of) {
      auto const index = here->index(object);
      names.push_back(alternative_name(*here, index));
      if (name == names[0]) {
        enter(here->alternatives[index](), here->held(object));
        continue;
      }
    } else if (here->kind == TypeInfo::Kind::structure) {
      auto const& fields = here->fields();
      auto const field = std::find_if(fields.begin(), fields.end(), [&](auto const& f) { return f.name == name; });
      if (field != fields.end()) {
        info = &*field;
        enter(field->type(), field->in(object));
        continue;
      }
    }
    bool const is_element = here->kind == TypeInfo::Kind::list || name.find('[') != name.npos;
    bool const is_struct = here->kind == TypeInfo::Kind::structure;
    refuse(is_element ? of_list : is_struct ? suggest_field(*here, name) : suggestion(name, names));
  }
  enter_optional();
  if (!here->is_plain()) refuse(here->kind == TypeInfo::Kind::list ? of_list : "name a number in it");
  if (!here->is_real()) throw ParameterError(place, "is no real number", "name another parameter");
  auto value = PlainValue::at(object, *here);
  bool const is_single = here->kind == TypeInfo::Kind::single_precision;
  value.number = is_single ? static_cast<double>(static_cast<float>(number)) : number;  // as it is stored
  if (!value.in(info->range))
    throw ParameterError(place, "is " + with_unit(number_text(value.number), info->unit),
                         "give a value in " + with_unit(range_text(*info), info->unit));
  value.store(object, *here);
}

}  // namespace cambium::inline v0_1::detail
