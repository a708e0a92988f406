#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/core/binary.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/hash.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/type_info.hpp"

namespace cambium::detail {

inline constexpr std::size_t longest_list = std::size_t{1} << 24;  ///< [elements]
inline constexpr int deepest_struct = 200;
inline constexpr std::size_t most_fields = 127;

/// Adds letters that say how a field is written.
inline void add_letters(Fnv1a<std::uint32_t>& hash, TypeInfo const& type) {
  auto const add = [&hash](char letter) { hash.add_byte(static_cast<unsigned char>(letter)); };
  switch (type.kind) {
    case TypeInfo::Kind::structure:
      return add('s');
    case TypeInfo::Kind::text:
      return add('t');
    case TypeInfo::Kind::one_of:
      return add('v');
    case TypeInfo::Kind::optional:
      return add('o'), add_letters(hash, type.element());
    case TypeInfo::Kind::list:
      return add('l'), add_letters(hash, type.element());
    default:
      break;
  }
  add(type.is_real() ? 'f' : type.is_long_unsigned() ? 'w' : 'i');
  add(type.is_long_unsigned() ? '8' : static_cast<char>('0' + type.size));  // 'w': of any size
}

/// Hash of the names and kinds of a struct's first fields, so that two that swap places are not read as each other.
[[nodiscard]] inline std::uint16_t hash_of_fields(TypeInfo const& type, std::size_t count) {
  constexpr std::uint32_t is_known = 1u << 16;
  bool const is_whole = count == type.fields().size();
  if (auto const known = type.hash_of_names->load(std::memory_order_relaxed); is_whole && known != 0)
    return static_cast<std::uint16_t>(known);
  Fnv1a<std::uint32_t> hash;
  for (auto const& field : type.fields().first(count)) {
    for (char const* letter = field.name; *letter != '\0'; ++letter) hash.add_byte(static_cast<unsigned char>(*letter));
    add_letters(hash, field.type());
  }
  auto const result = static_cast<std::uint16_t>(hash.value() ^ hash.value() >> 16);
  if (is_whole) type.hash_of_names->store(result | is_known, std::memory_order_relaxed);
  return result;
}

/// A bit for each field of a struct.
struct FieldBits {
  std::array<unsigned char, (most_fields + 7) / 8> bytes{};

  void set(std::size_t i) { bytes[i / 8] = static_cast<unsigned char>(bytes[i / 8] | 1u << i % 8); }
  [[nodiscard]] bool operator[](std::size_t i) const { return (bytes[i / 8] >> i % 8 & 1u) != 0; }
  [[nodiscard]] static FieldBits all() {
    FieldBits bits;
    bits.bytes.fill(0xff);
    return bits;
  }
};

/// The types that have been written or read so far. Writer and reader hold the same.
struct KnownTypes {
  struct Shape {
    TypeInfo const* type;
    unsigned version;
    std::size_t fields;  ///< number of fields in the file, the first ones of the description
  };
  struct Alternative {
    TypeInfo const* one_of;
    std::size_t index;
    std::shared_ptr<void const> last = {};  ///< the latest struct of it
  };
  std::vector<Shape> shapes;
  std::vector<Alternative> alternatives;

  [[nodiscard]] Shape const* shape(TypeInfo const& type) const {
    for (auto const& shape : shapes)
      if (shape.type == &type) return &shape;
    return nullptr;
  }
};

class FieldWriter {
 public:
  FieldWriter(FieldSink& sink, std::string const& where) : sink_(sink), where_(where) {}

  /// `like`: what the reader has already; null if nothing.
  void write(char const* key, TypeInfo const& type, void const* object, void const* like = nullptr) {
    using Kind = TypeInfo::Kind;
    if (type.kind == Kind::text) return put_text(key, *static_cast<std::string const*>(object));
    if (type.is_plain()) return write_plain(key, type, object);
    if (sink_.has_tags()) sink_.begin(key);
    if (type.kind == Kind::structure)
      write_struct(type, object, type.assign != nullptr ? like : nullptr);
    else if (type.kind == Kind::one_of)
      write_alternative(type, object);
    else if (type.kind == Kind::optional)
      write_optional(type, object, like);
    else
      write_list(type, object, like);
    if (sink_.has_tags()) sink_.end(key);
  }

 private:
  void put_byte(char const* key, std::uint64_t byte) { sink_.integer(key, byte, 1, false); }
  /// A whole number, of which most are small: in one byte, or in 9.
  void put_whole(char const* key, std::uint64_t number) {
    put_byte(key, std::min<std::uint64_t>(number, 255));
    if (number >= 255) sink_.integer("whole", number, 8, false);
  }
  void put_count(char const* key, std::size_t count) {
    if (count > longest_list)
      throw ParameterError(where_, "a list has " + std::to_string(count) + " elements", "a file holds 16 million");
    put_whole(key, count);
  }
  /// Letter by letter, except between tags: for a whole text, Boost allocates whatever length a file claims.
  void put_text(char const* key, std::string const& text) {
    if (sink_.has_tags()) return sink_.text(key, text);
    put_whole(key, text.size());
    for (char const letter : text) sink_.integer(key, static_cast<unsigned char>(letter), 1, true);
  }

  void write_plain(char const* key, TypeInfo const& type, void const* object) {
    if (type.kind == TypeInfo::Kind::number) return sink_.number(key, *static_cast<double const*>(object));
    if (type.kind == TypeInfo::Kind::single_precision) return sink_.number(key, *static_cast<float const*>(object));
    auto const bits = PlainValue::at(object, type).bits;
    if (type.is_long_unsigned()) return put_whole(key, bits);
    sink_.integer(key, bits, type.size, type.is_signed);
  }

  void write_shape(TypeInfo const& type, std::size_t fields) {
    if (known_.shape(type) != nullptr) return;
    put_byte("fields", fields + (type.version > 0 ? 128 : 0));
    if (type.version > 0) put_whole("version", type.version);
    sink_.integer("names", hash_of_fields(type, fields), 2, false);
    known_.shapes.push_back({&type, type.version, fields});
  }

  void write_struct(TypeInfo const& type, void const* object, void const* like) {
    auto const fields = type.fields();
    if (fields.size() > most_fields)
      throw ParameterError(where_, std::string("a struct '") + type.name + "' has more than 127 fields", "nest some");
    if (++depth_ > deepest_struct)
      throw ParameterError(where_, std::string("a struct '") + type.name + "' lies within more than 200 others",
                           "nest fewer of them");
    write_shape(type, fields.size());
    auto differs = FieldBits::all();
    if (like != nullptr) {
      differs = {};
      for (std::size_t i = 0; i < fields.size(); ++i)
        if (!are_equal(fields[i].type(), fields[i].in(object), fields[i].in(like), Equality::of_bits)) differs.set(i);
      for (std::size_t k = 0; k < (fields.size() + 7) / 8; ++k) put_byte("differs", differs.bytes[k]);
    }
    for (std::size_t i = 0; i < fields.size(); ++i)
      if (differs[i])
        write(fields[i].name, fields[i].type(), fields[i].in(object), like != nullptr ? fields[i].in(like) : nullptr);
    --depth_;
  }

  void write_alternative(TypeInfo const& type, void const* object) {
    auto const index = type.index(object);
    auto const& model = type.alternatives[index]();
    if (!model.is_storable())
      throw ParameterError(where_, "a struct is not described, or has no default: no file can hold it",
                           "give it `name` and `parameters()`");
    auto& known = known_.alternatives;
    std::size_t number = 0;
    while (number < known.size() && !(known[number].one_of == &type && known[number].index == index)) ++number;
    put_whole("alternative", number);
    if (number == known.size()) {
      known.push_back({&type, index});
      put_text("name", alternative_name(type, index));
    }
    auto const* const held = type.held(object);
    write(model.name, model, held, known[number].last.get());
    known[number].last = std::shared_ptr<void const>(std::shared_ptr<void>(), held);  // not owned
  }

  void write_optional(TypeInfo const& type, void const* object, void const* like) {
    auto const* const held = type.held(object);
    put_byte("present", held != nullptr);
    if (held != nullptr) write("value", type.element(), held, like != nullptr ? type.held(like) : nullptr);
  }

  void write_list(TypeInfo const& type, void const* object, void const* like) {
    auto const elements = type.elements(object);
    auto const known = like != nullptr ? type.elements(like) : TypeInfo::Elements{};
    put_count("length", elements.count);
    for (std::size_t i = 0; i < elements.count; ++i)
      write("item", type.element(), elements[i], i < known.count ? known[i] : i > 0 ? elements[i - 1] : nullptr);
  }

  FieldSink& sink_;
  std::string const& where_;
  KnownTypes known_;
  int depth_ = 0;
};

/// How much memory a copy of an object needs besides its own [bytes].
[[nodiscard]] inline std::size_t bytes_in(TypeInfo const& type, void const* object) {
  std::size_t bytes = 0;
  if (type.is_trivial) return bytes;
  switch (type.kind) {
    case TypeInfo::Kind::structure:
      for (auto const& field : type.fields()) bytes += bytes_in(field.type(), field.in(object));
      break;
    case TypeInfo::Kind::text:
      bytes = static_cast<std::string const*>(object)->size();
      break;
    case TypeInfo::Kind::one_of:
      bytes = bytes_in(type.alternatives[type.index(object)](), type.held(object));
      break;
    case TypeInfo::Kind::optional:
      if (auto const* const held = type.held(object)) bytes = bytes_in(type.element(), held);
      break;
    case TypeInfo::Kind::list: {
      auto const elements = type.elements(object);
      for (std::size_t i = 0; i < elements.count; ++i) bytes += elements.size + bytes_in(type.element(), elements[i]);
      break;
    }
    default:
      break;
  }
  return bytes;
}

class FieldReader {
 public:
  FieldReader(FieldSource& source, std::string const& where) : source_(source), where_(where) {}

  void read(char const* key, TypeInfo const& type, void* object) {
    read(key, type, object, {}, nullptr);
    if (is_old_) upgrade(type, object);
  }

 private:
  void read(char const* key, TypeInfo const& type, void* object, ParameterInfo const& info, void const* like) {
    using Kind = TypeInfo::Kind;
    if (type.kind == Kind::text) return static_cast<void>(*static_cast<std::string*>(object) = text(key));
    if (type.is_plain()) return read_plain(key, type, object, info);
    if (source_.has_tags()) source_.begin(key);
    if (type.kind == Kind::structure)
      read_struct(type, object, type.assign != nullptr ? like : nullptr);
    else if (type.kind == Kind::one_of)
      read_alternative(type, object);
    else if (type.kind == Kind::optional)
      read_optional(type, object, info, like);
    else
      read_list(type, object, info, like);
    if (source_.has_tags()) source_.end(key);
  }

  void read_plain(char const* key, TypeInfo const& type, void* object, ParameterInfo const& info) {
    read_ += type.size;
    if (type.kind == TypeInfo::Kind::number) return source_.number(key, *static_cast<double*>(object));
    if (type.kind == TypeInfo::Kind::single_precision) return source_.number(key, *static_cast<float*>(object));
    PlainValue value{type.kind, 0.0, 0};
    value.bits = type.is_long_unsigned() ? whole(key, PlainValue::highest(type).bits)
                                         : source_.integer(key, type.size, type.is_signed);
    if (type.kind == TypeInfo::Kind::boolean && value.bits > 1) damaged();
    value.store(object, type);
    if (!is_old_) check_range(type, object, info);
  }

  /// Checks a whole number: it may be an index. A range of one value is none: `{}`.
  void check_range(TypeInfo const& type, void const* object, ParameterInfo const& info) const {
    if (type.is_real() || !(info.range.low < info.range.high)) return;
    auto const value = PlainValue::at(object, type);
    if (!value.in(info.range))
      throw ParameterError(where_ + ": " + info.name, "is " + value_text(info, value),
                           "it lies outside of " + range_text(info) + ", the range of its description");
  }

  [[nodiscard]] std::uint64_t byte(char const* key) {
    ++read_;
    return source_.integer(key, 1, false);
  }
  [[nodiscard]] std::uint64_t whole(char const* key, std::uint64_t most) {
    auto number = byte(key);
    if (number == 255) {
      number = source_.integer("whole", 8, false);
      read_ += 8;
    }
    if (number > most) damaged();
    return number;
  }
  [[nodiscard]] std::size_t count(char const* key) { return static_cast<std::size_t>(whole(key, longest_list)); }
  [[nodiscard]] std::string text(char const* key) {
    if (source_.has_tags()) {
      auto text = source_.text(key);
      read_ += text.size();
      return text;
    }
    std::string text;
    for (auto left = whole(key, ~std::uint64_t{0}); left > 0; --left)
      text += static_cast<char>(source_.integer(key, 1, true));
    read_ += text.size();
    return text;
  }

  void count_copied(std::size_t bytes) {
    constexpr std::uint64_t always = 1u << 26, per_byte = 256;
    copied_ += bytes;
    if (copied_ > always + per_byte * read_)
      throw ParameterError(where_, "expands to far more memory than a file of its size should",
                           "take another copy; if this one is sound, store lists that repeat only once");
  }
  [[noreturn]] void damaged() const {
    throw ParameterError(where_, "its content contradicts itself",
                         "read it with the types that were written; if these are the same, it is damaged");
  }

  [[nodiscard]] KnownTypes::Shape read_shape(TypeInfo const& type) {
    if (auto const* known = known_.shape(type)) return *known;
    auto const told = byte("fields");
    std::size_t const fields = told % 128;
    auto const version = told < 128 ? 0u : static_cast<unsigned>(count("version"));
    auto const names = source_.integer("names", 2, false);
    auto const refuse = [&](std::string const& what, char const* remedy) {
      throw ParameterError(where_, std::string("its struct '") + type.name + "' " + what, remedy);
    };
    if (version > type.version)
      refuse("is of a newer version", "read it with the program that wrote it, or a newer one");
    if (fields > type.fields().size())
      refuse("has more fields than in this program",
             "read it with the program that wrote it, or a newer one; never remove a field from a description");
    if (version == type.version && names != hash_of_fields(type, fields))
      refuse("was saved with other fields, or in another order",
             "append new fields; if one changes its name or meaning, increase the struct's `version`");
    if (version < type.version && type.upgrade == nullptr)
      refuse("is of version " + std::to_string(version) + ", and this program knows no way from there",
             "give the struct a member `upgrade(unsigned from)`, or read it with an older program");
    known_.shapes.push_back({&type, version, fields});
    return known_.shapes.back();
  }

  void read_struct(TypeInfo const& type, void* object, void const* like) {
    if (++depth_ > deepest_struct) damaged();
    auto const shape = read_shape(type);
    auto differs = FieldBits::all();
    if (like != nullptr) {
      count_copied(bytes_in(type, like));
      type.assign(object, like);
      for (std::size_t k = 0; k < (shape.fields + 7) / 8; ++k)
        differs.bytes[k] = static_cast<unsigned char>(byte("differs"));
    }
    is_old_ = is_old_ || shape.version < type.version;  // from here on, `upgrade` checks
    auto const fields = type.fields();
    for (std::size_t i = 0; i < fields.size(); ++i)
      if (i >= shape.fields)
        set_default(type, fields[i], object);
      else if (differs[i])
        read(fields[i].name, fields[i].type(), fields[i].in(object), fields[i],
             like != nullptr ? fields[i].in(like) : nullptr);
    if (type.check != nullptr && !is_old_) type.check(object, where_);
    --depth_;
  }

  /// Sets a field that an older file does not have.
  void set_default(TypeInfo const& type, FieldInfo const& field, void* object) const {
    if (type.usual == nullptr)
      throw ParameterError(where_, std::string("its struct '") + type.name + "' has no '" + field.name + "' yet",
                           "read it with an older program: there is no default to give it");
    field.type().assign(field.in(object), field.in(type.usual()));
  }

  void read_alternative(TypeInfo const& type, void* object) {
    auto const number = count("alternative");
    auto& known = known_.alternatives;
    if (number > known.size()) damaged();
    if (number == known.size()) {
      auto const name = text("name");
      std::size_t index = 0;
      while (index < type.alternatives.size() && (name.empty() || alternative_name(type, index) != name)) ++index;
      if (index == type.alternatives.size()) refuse_model(name, type);
      known.push_back({&type, index});
    }
    if (known[number].one_of != &type) damaged();
    auto const& model = type.alternatives[known[number].index]();
    type.select(object, known[number].index);
    auto* const held = const_cast<void*>(type.held(object));
    auto const last = known[number].last;  // as `known` may grow
    read(model.name, model, held, {}, last.get());
    known_.alternatives[number].last = std::shared_ptr<void const>(model.copy(held), model.destroy);
  }
  [[noreturn]] void refuse_model(std::string const& name, TypeInfo const& type) const {
    std::string ours;
    for (auto const& known : alternative_names(type)) ours += (ours.empty() ? "" : ", ") + known;
    throw ParameterError(where_,
                         "holds the model '" + name + "', which is not among those of this program (" + ours + ")",
                         "read it with the type that was saved");
  }

  void read_optional(TypeInfo const& type, void* object, ParameterInfo const& info, void const* like) {
    auto const present = byte("present");
    if (present > 1) damaged();
    type.select(object, present);
    if (present == 1)
      read("value", type.element(), const_cast<void*>(type.held(object)), info,
           like != nullptr ? type.held(like) : nullptr);
  }

  void read_list(TypeInfo const& type, void* object, ParameterInfo const& info, void const* like) {
    auto const known = like != nullptr ? type.elements(like) : TypeInfo::Elements{};
    auto const length = count("length");
    if (length < type.least || length > type.most) damaged();
    auto const& element = type.element();
    type.fill(object, length, where_, [&](std::size_t i, void* item, void const* before) {
      if (type.least < type.most) count_copied(element.size);
      read("item", element, item, info, i < known.count ? known[i] : before);
    });
  }

  /// Calls `upgrade` of the structs in an object that the file had in an older version, the innermost first, and checks
  /// what `read` has not. A pass of its own: until all is read, the next struct may refer to one as it was written.
  void upgrade(TypeInfo const& type, void* object) {
    switch (type.kind) {
      case TypeInfo::Kind::structure: {
        auto const* const shape = known_.shape(type);
        auto const fields = type.fields();
        if (shape != nullptr)  // the others are defaults of today
          for (auto const& field : fields.first(shape->fields)) upgrade(field.type(), field.in(object));
        if (type.upgrade != nullptr && shape != nullptr && shape->version < type.version)
          type.upgrade(object, shape->version);
        for (auto const& field : fields) check_ranges(field.type(), field.in(object), field);
        if (type.check != nullptr) type.check(object, where_);
        return;
      }
      case TypeInfo::Kind::one_of:
        return upgrade(type.alternatives[type.index(object)](), const_cast<void*>(type.held(object)));
      case TypeInfo::Kind::optional:
        if (auto const* const held = type.held(object)) upgrade(type.element(), const_cast<void*>(held));
        return;
      case TypeInfo::Kind::list:
        return type.fill(object, type.elements(object).count, where_,
                         [&](std::size_t, void* item, void const*) { upgrade(type.element(), item); });
      default:
        return;
    }
  }

  void check_ranges(TypeInfo const& type, void const* object, ParameterInfo const& info) const {
    if (type.is_plain()) return check_range(type, object, info);
    if (type.kind == TypeInfo::Kind::optional) {
      if (auto const* const held = type.held(object)) check_ranges(type.element(), held, info);
    } else if (type.kind == TypeInfo::Kind::list) {
      auto const elements = type.elements(object);
      for (std::size_t i = 0; i < elements.count; ++i) check_ranges(type.element(), elements[i], info);
    }
  }

  FieldSource& source_;
  std::string const& where_;
  KnownTypes known_;
  int depth_ = 0;
  std::uint64_t read_ = 0, copied_ = 0;  ///< [bytes]
  bool is_old_ = false;                  ///< a struct was of an older version
};

CAMBIUM_COLD void write_fields(FieldSink& sink, char const* key, TypeInfo const& type, void const* object,
                               std::string const& where) {
  FieldWriter(sink, where).write(key, type, object);
}

CAMBIUM_COLD void read_fields(FieldSource& source, char const* key, TypeInfo const& type, void* object,
                              std::string const& where) {
  FieldReader(source, where).read(key, type, object);
}

/// Bytes before the content of a binary file: its kind and version, a checksum, and the length.
inline constexpr std::string_view binary_magic = "cambium\x02";
inline constexpr std::size_t binary_head = 24;

CAMBIUM_COLD std::string binary_of(TypeInfo const& type, void const* object) {
  std::string content;
  ByteSink sink(content);
  write_fields(sink, type.name, type, object, "binary file");
  return sealed(content);
}

CAMBIUM_COLD std::string sealed(std::string const& content) {
  std::string bytes(binary_magic);
  ByteSink head(bytes);
  head.integer("checksum", checksum_of(content), 8, false);
  head.integer("length", content.size(), 8, false);
  return bytes + content;
}

CAMBIUM_COLD void read_binary(std::string_view bytes, TypeInfo const& type, void* object, std::string const& where) {
  if (!is_binary(bytes)) throw ParameterError(where, "is no binary file of cambium", "give one, or a JSON file");
  if (bytes.size() < binary_head) throw ParameterError(where, "is cut short", "it is damaged: take another copy");
  if (!bytes.starts_with(binary_magic))
    throw ParameterError(where, "was written by another version of cambium", "write it anew, or exchange JSON files");
  ByteSource head(bytes.substr(binary_magic.size()), where);
  auto const checksum = head.integer("checksum", 8, false);
  auto const content = bytes.substr(binary_head);
  if (head.integer("length", 8, false) != content.size())
    throw ParameterError(where, "is cut short, or longer than it should be", "it is damaged: take another copy");
  if (checksum != checksum_of(content))
    throw ParameterError(where, "has a wrong checksum", "it is damaged: take another copy");
  ByteSource source(content, where);
  read_fields(source, type.name, type, object, where);
  if (!source.rest().empty())
    throw ParameterError(where, "holds more than was read", "it is damaged: take another copy");
}

}  // namespace cambium::detail
