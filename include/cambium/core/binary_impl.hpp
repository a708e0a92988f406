#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/binary.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/hash.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/nearest_names.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/text.hpp"
#include "cambium/core/type_info.hpp"

namespace cambium::inline v0_1::detail {

inline constexpr std::size_t longest_list = std::size_t{1} << 24;  ///< [elements]
inline constexpr int deepest_struct = 200;
inline constexpr std::size_t most_fields = 127;

/// A bit for each field of a struct.
struct FieldBits {
  std::array<std::uint8_t, most_fields / 8 + 1> bytes;  ///< of eight fields each, the first one's bit the lowest

  [[nodiscard]] static FieldBits all() {
    FieldBits bits;
    bits.bytes.fill(0xff);
    return bits;
  }
  [[nodiscard]] bool operator[](std::size_t field) const { return (bytes[field / 8] >> field % 8 & 1) != 0; }
};

/// Whether a field has the same bits in both structs.
[[nodiscard]] inline bool are_equal(FieldInfo const& field, void const* a, void const* b) {
  auto const *const left = field.in(a), *const right = field.in(b);
  if (field.plain_size == 8) return std::memcmp(left, right, 8) == 0;  // one comparison, as the size is known
  if (field.plain_size == 4) return std::memcmp(left, right, 4) == 0;
  if (field.plain_size == 1) return std::memcmp(left, right, 1) == 0;
  return are_equal(field.type(), left, right, Equality::of_bits);
}

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
    std::shared_ptr<void> last = {};  ///< the latest struct of it
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
    if (has_tags_) sink_.begin(key);
    if (type.kind == Kind::structure) write_struct(type, object, type.assign != nullptr ? like : nullptr);
    if (type.kind == Kind::one_of) write_alternative(type, object);
    if (type.kind == Kind::optional) write_optional(type, object, like);
    if (type.kind == Kind::list) write_list(type, object, like);
    if (has_tags_) sink_.end(key);
  }

 private:
  void put_byte(char const* key, std::uint64_t byte) { sink_.integer(key, byte, 1, false); }
  /// A whole number, of which most are small: in one byte, or in 9.
  void put_whole(char const* key, std::uint64_t number) {
    put_byte(key, std::min<std::uint64_t>(number, 255));
    if (number >= 255) sink_.integer("whole", number, 8, false);
  }
  /// Letter by letter, except between tags: for a whole text, Boost allocates whatever length a file claims.
  void put_text(char const* key, std::string const& text) {
    if (has_tags_) return sink_.text(key, text);
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

  void write_shape(TypeInfo const& type) {
    if (known_.shape(type) != nullptr) return;
    auto const& fields = type.fields();
    put_byte("fields", fields.size() + (type.version > 0 ? 128 : 0));
    if (type.version > 0) put_whole("version", type.version);
    sink_.integer("names", fields.hash, 2, false);
    known_.shapes.push_back({&type, type.version, fields.size()});
  }

  void write_struct(TypeInfo const& type, void const* object, void const* like) {
    auto const& fields = type.fields();
    if (fields.size() > most_fields)
      throw ParameterError(where_, std::string("a struct '") + type.name + "' has more than 127 fields",
                           "put some of them into a struct of their own");
    if (++depth_ > deepest_struct)
      throw ParameterError(where_, std::string("a struct '") + type.name + "' lies within more than 200 others",
                           "nest fewer of them");
    if (like == nullptr) write_shape(type);  // else the reader knows it from there
    auto differs = FieldBits::all();
    if (like != nullptr)
      for (std::size_t k = 0; k < fields.size(); k += 8) {
        unsigned byte = 0;
        for (std::size_t i = k; i < std::min(k + 8, fields.size()); ++i)
          byte |= static_cast<unsigned>(!are_equal(fields[i], object, like)) << (i - k);
        put_byte("differs", byte);
        differs.bytes[k / 8] = static_cast<std::uint8_t>(byte);
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
    known[number].last = {std::shared_ptr<void>(), const_cast<void*>(held)};  // not owned, only read
  }

  void write_optional(TypeInfo const& type, void const* object, void const* like) {
    auto const* const held = type.held(object);
    put_byte("present", held != nullptr);
    if (held != nullptr) write("value", type.element(), held, like != nullptr ? type.held(like) : nullptr);
  }

  void write_list(TypeInfo const& type, void const* object, void const* like) {
    auto const elements = type.elements(object);
    auto const known = like != nullptr ? type.elements(like) : TypeInfo::Elements{};
    if (elements.count > longest_list)
      throw ParameterError(where_, "a list has " + std::to_string(elements.count) + " elements",
                           "split it: a file holds at most 16777216");
    put_whole("length", elements.count);
    for (std::size_t i = 0; i < elements.count; ++i)
      write("item", type.element(), elements[i], i < known.count ? known[i] : i > 0 ? elements[i - 1] : nullptr);
  }

  FieldSink& sink_;
  bool const has_tags_ = sink_.has_tags();
  std::string const& where_;
  KnownTypes known_;
  int depth_ = 0;
};

CAMBIUM_COLD std::size_t bytes_in(TypeInfo const& type, void const* object) {
  if (type.is_trivial) return 0;
  if (type.kind == TypeInfo::Kind::text) return static_cast<std::string const*>(object)->size();
  std::size_t bytes = 0;
  for_each_part(type, object, [&](TypeInfo const& part, void const* place) {
    bytes += bytes_in(part, place) + (type.kind == TypeInfo::Kind::list ? part.size : 0);
  });
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
    if (has_tags_) source_.begin(key);
    if (type.kind == Kind::structure) read_struct(type, object, type.assign != nullptr ? like : nullptr);
    if (type.kind == Kind::one_of) read_alternative(type, object);
    if (type.kind == Kind::optional) read_optional(type, object, info, like);
    if (type.kind == Kind::list) read_list(type, object, info, like);
    if (has_tags_) source_.end(key);
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

  /// Checks a whole number: it may be an index. The range `{}` is none, except of an enum with one value.
  void check_range(TypeInfo const& type, void const* object, ParameterInfo const& info) const {
    bool const has_range = info.choices != nullptr || info.range.low != 0.0 || info.range.high != 0.0;
    if (type.is_real() || !has_range) return;
    auto const value = PlainValue::at(object, type);
    if (!value.in(info.range))
      throw ParameterError(where_ + ": " + info.name,
                           "is " + value_text(info, value) + ", which lies outside of " + range_text(info),
                           "read it with the program that wrote it, or take another copy");
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
    if (has_tags_) {
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
    auto const& all = type.fields();
    auto const told = byte("fields");
    std::size_t const fields = told % 128;
    auto const version = told < 128 ? 0u : static_cast<unsigned>(count("version"));
    auto const names = source_.integer("names", 2, false);
    auto const refuse = [&](std::string const& what, char const* remedy) {
      throw ParameterError(where_, std::string("its struct '") + type.name + "' " + what, remedy);
    };
    if (version > type.version)
      refuse("is of a newer version", "read it with the program that wrote it, or a newer one");
    if (fields > all.size())
      refuse("has more fields than in this program (" + joined(names_of(all), ", ") + ")",
             "read it with the program that wrote it, or a newer one; never remove a field from a description");
    if (version == type.version && names != (fields == all.size() ? all.hash : hash_of_fields(all.first(fields))))
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
      for (std::size_t k = 0; k < shape.fields; k += 8)
        differs.bytes[k / 8] = static_cast<std::uint8_t>(byte("differs"));
    }
    is_old_ = is_old_ || shape.version < type.version;  // from here on, `upgrade` checks
    auto const& fields = type.fields();
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
      known.push_back({&type, alternative_named(type, name)});
      if (known.back().index == type.alternatives.size())
        throw ParameterError(where_,
                             "holds the model '" + name + "', which is not among those of this program (" +
                                 joined(alternative_names(type), ", ") + ")",
                             "read it with the type that was saved");
    }
    if (known[number].one_of != &type) damaged();
    auto const& model = type.alternatives[known[number].index]();
    type.select(object, known[number].index);
    auto* const held = const_cast<void*>(type.held(object));
    auto last = known[number].last;  // as `known` may grow, and hold another one
    read(model.name, model, held, {}, last.get());
    last.reset();
    auto& latest = known_.alternatives[number].last;
    if (latest.use_count() == 1)
      model.assign(latest.get(), held);
    else  // there is none, or one around this still refers to it
      latest = {model.copy(held), model.destroy};
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
    if (type.kind != TypeInfo::Kind::structure)
      return for_each_part(type, object, where_, [&](TypeInfo const& part, void* place) { upgrade(part, place); });
    auto const* const shape = known_.shape(type);
    auto const& fields = type.fields();
    if (shape != nullptr)  // the others are defaults of today
      for (auto const& field : fields.first(shape->fields)) upgrade(field.type(), field.in(object));
    if (type.upgrade != nullptr && shape != nullptr && shape->version < type.version)
      type.upgrade(object, shape->version);
    for (auto const& field : fields) check_ranges(field.type(), field.in(object), field);
    if (type.check != nullptr) type.check(object, where_);
  }

  /// Checks a field that is a number, or holds some; structs in it check their own.
  void check_ranges(TypeInfo const& type, void const* object, ParameterInfo const& info) const {
    if (type.is_plain()) return check_range(type, object, info);
    if (type.kind != TypeInfo::Kind::optional && type.kind != TypeInfo::Kind::list) return;
    for_each_part(type, object, [&](TypeInfo const& part, void const* place) { check_ranges(part, place, info); });
  }

  FieldSource& source_;
  bool const has_tags_ = source_.has_tags();
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

}  // namespace cambium::inline v0_1::detail
