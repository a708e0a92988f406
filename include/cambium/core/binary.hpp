#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/transfer_parameters.hpp"

/// Described structs as compact bytes, for sets of thousands of scenarios: a bit for each value that is the default,
/// else the value. The bytes fit one version of the structs; JSON is for exchange between versions.
///
///   magic | schema: names of all fields | checksum | length | texts | values | one bit for each value: differs
namespace cambium {

namespace detail {

/// FNV-1a, 64 bit.
class ByteHash {
 public:
  void add(std::string_view bytes) {
    for (char const c : bytes) hash_ = (hash_ ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    hash_ = (hash_ ^ 0xffu) * 0x100000001b3u;  // separates words
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

inline void append_number(std::string& bytes, std::uint64_t number, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(number >> (8 * i) & 0xffu);
}
/// Seven bits a byte, the lowest first; small numbers take one byte.
inline void append_count(std::string& bytes, std::uint64_t number) {
  for (; number >= 0x80u; number >>= 7) bytes += static_cast<char>((number & 0x7fu) | 0x80u);
  bytes += static_cast<char>(number);
}

/// How a value is stored.
[[nodiscard]] inline std::uint64_t stored_bits(ParameterValue const& value) {
  if (value.is_real()) return std::bit_cast<std::uint64_t>(value.number);
  if (value.kind != ParameterValue::Kind::signed_integer) return value.bits;
  auto const number = static_cast<std::int64_t>(value.bits);  // small negative numbers become small ones
  return (value.bits << 1) ^ static_cast<std::uint64_t>(number >> 63);
}

class BinaryWriter final : public ParameterTransfer {
 public:
  [[nodiscard]] bool field(char const*) override { return true; }
  void element(std::size_t) override {}
  void end() override {}
  void begin_struct() override {}
  void end_struct() override {}
  [[nodiscard]] std::size_t list(std::size_t length, std::size_t, bool) override {
    append_count(values_, length);
    return length;
  }
  [[nodiscard]] std::size_t alternative(std::span<char const* const> names, std::size_t now, std::size_t) override {
    if (names[now] == nullptr)
      throw ParameterError("binary file", "a struct is not described, or has no default: no file can hold it",
                           "give it `parameters()` and `name`");
    append_count(values_, now);
    append_count(values_, names.size());
    return now;
  }
  [[nodiscard]] bool presence(bool now) override {
    mark(now);
    return now;
  }
  [[nodiscard]] ParameterValue value(ParameterInfo const&, ParameterValue const& now, bool is_usual,
                                     ParameterValue const&, ParameterValue const&) override {
    bool const is_same = is_usual && !(now.is_real() && now.number == 0.0);  // -0 equals 0, but has other bits
    mark(!is_same);
    if (is_same) return now;
    if (now.is_real())
      append_number(values_, stored_bits(now), 8);
    else
      append_count(values_, stored_bits(now));
    return now;
  }
  void text(std::string& text, bool is_usual) override {
    mark(!is_usual);
    if (is_usual) return;
    auto const [place, is_new] = numbers_.emplace(text, numbers_.size());
    if (is_new) texts_.push_back(text);
    append_count(values_, place->second);
  }
  [[nodiscard]] std::string where() const override { return "binary file"; }

  [[nodiscard]] std::string bytes() const {
    std::string payload;
    append_count(payload, texts_.size());
    for (auto const& text : texts_) {
      append_count(payload, text.size());
      payload += text;
    }
    append_count(payload, values_.size());
    payload += values_;
    append_count(payload, bits_);
    payload += flags_;
    return payload;
  }

 private:
  void mark(bool bit) {
    if (bits_ % 8 == 0) flags_ += '\0';
    if (bit) flags_.back() = static_cast<char>(static_cast<unsigned char>(flags_.back()) | (1u << bits_ % 8));
    ++bits_;
  }

  std::string values_, flags_;
  std::size_t bits_ = 0;
  std::vector<std::string> texts_;
  std::map<std::string, std::size_t> numbers_;
};

class BinaryReader final : public ParameterTransfer {
 public:
  BinaryReader(std::string_view payload, std::string const& where) : where_(where), values_(payload) {
    auto const texts = count(payload.size());
    for (std::uint64_t i = 0; i < texts; ++i) texts_.emplace_back(take(count(values_.size())));
    auto const values = take(count(values_.size()));
    bits_ = count(8 * values_.size());
    flags_ = values_;
    if (flags_.size() != (bits_ + 7) / 8) damaged();
    values_ = values;
  }

  /// Throws unless all was read.
  void finish() const {
    if (!values_.empty() || at_ != bits_) damaged();
  }

  [[nodiscard]] bool field(char const*) override { return true; }
  void element(std::size_t) override {}
  void end() override {}
  void begin_struct() override {
    if (++depth_ > deepest) damaged();
  }
  void end_struct() override { --depth_; }
  [[nodiscard]] std::size_t list(std::size_t length, std::size_t, bool is_fixed) override {
    // An element takes a bit or a byte at least, unless it is a struct without fields.
    auto const read = static_cast<std::size_t>(count(values_.size() + bits_ - at_));
    if (is_fixed && read != length) damaged();
    return read;
  }
  [[nodiscard]] std::size_t alternative(std::span<char const* const> names, std::size_t, std::size_t) override {
    auto const chosen = static_cast<std::size_t>(count(names.size()));
    if (count(names.size()) != names.size() || chosen >= names.size() || names[chosen] == nullptr) damaged();
    return chosen;
  }
  [[nodiscard]] bool presence(bool) override { return bit(); }
  [[nodiscard]] ParameterValue value(ParameterInfo const&, ParameterValue const& now, bool,
                                     ParameterValue const& lowest, ParameterValue const& highest) override {
    auto value = now;
    if (!bit()) return value;
    if (now.is_real()) {
      std::uint64_t bits = 0;
      auto const bytes = take(8);
      for (std::size_t i = 0; i < 8; ++i) bits |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
      value.number = std::bit_cast<double>(bits);
      return value;
    }
    value.bits = count(~std::uint64_t{0});
    if (now.kind == ParameterValue::Kind::signed_integer) {
      value.bits = (value.bits >> 1) ^ (~(value.bits & 1u) + 1u);
      auto const number = static_cast<std::int64_t>(value.bits);
      if (number < static_cast<std::int64_t>(lowest.bits) || number > static_cast<std::int64_t>(highest.bits))
        damaged();
    } else if (value.bits > highest.bits) {
      damaged();
    }
    return value;
  }
  void text(std::string& text, bool) override {
    if (!bit()) return;
    auto const number = count(texts_.size());
    if (number >= texts_.size()) damaged();
    text = texts_[number];
  }
  [[nodiscard]] std::string where() const override { return where_; }

 private:
  static constexpr int deepest = 200;

  [[noreturn]] void damaged() const {
    throw ParameterError(where_, "its content contradicts itself", "it is damaged: take another copy");
  }
  [[nodiscard]] bool bit() {
    if (at_ >= bits_) damaged();
    auto const byte = static_cast<unsigned char>(flags_[at_ / 8]);
    return (byte >> (at_++ % 8) & 1u) != 0;
  }
  [[nodiscard]] std::string_view take(std::uint64_t size) {
    if (size > values_.size()) damaged();
    auto const bytes = values_.substr(0, static_cast<std::size_t>(size));
    values_.remove_prefix(static_cast<std::size_t>(size));
    return bytes;
  }
  /// A number up to `most`.
  [[nodiscard]] std::uint64_t count(std::uint64_t most) {
    std::uint64_t number = 0;
    for (int shift = 0; shift < 70; shift += 7) {
      auto const byte = std::uint64_t{static_cast<unsigned char>(take(1)[0])};
      if (shift == 63 && byte > 1) damaged();
      number |= (byte & 0x7fu) << shift;
      if (byte < 0x80u) {
        if (number > most) damaged();
        return number;
      }
    }
    damaged();
  }

  std::string const& where_;
  std::string_view values_, flags_;
  std::size_t bits_ = 0, at_ = 0;
  std::vector<std::string> texts_;
  int depth_ = 0;
};

inline constexpr std::string_view binary_magic = "cambium\x01";

/// The bytes of a file: the payload behind what identifies it.
[[nodiscard]] inline std::string sealed(std::string const& payload, std::uint64_t schema) {
  std::string bytes(binary_magic);
  ByteHash checksum;
  checksum.add(payload);
  append_number(bytes, schema, 8);
  append_number(bytes, checksum.value(), 8);
  append_number(bytes, payload.size(), 8);
  return bytes + payload;
}

/// The payload of a file. Throws `ParameterError` if it is of another kind, another version, cut short or damaged.
[[nodiscard]] inline std::string_view opened(std::string_view bytes, std::uint64_t schema, std::string const& where) {
  auto const number = [&](std::size_t at) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < 8; ++i) value |= std::uint64_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
    return value;
  };
  constexpr std::size_t head = 32;
  if (bytes.substr(0, 7) != binary_magic.substr(0, 7))
    throw ParameterError(where, "is no binary file of cambium", "give one, or a JSON file");
  if (bytes.size() < head || number(24) != bytes.size() - head)
    throw ParameterError(where, "is cut short, or longer than it should be", "it is damaged: take another copy");
  if (bytes[7] != binary_magic[7] || number(8) != schema)
    throw ParameterError(where, "was written by another version of cambium, or for other structs",
                         "write it anew, or exchange JSON files");
  auto const payload = bytes.substr(head);
  ByteHash checksum;
  checksum.add(payload);
  if (number(16) != checksum.value())
    throw ParameterError(where, "has a wrong checksum", "it is damaged: take another copy");
  return payload;
}

template <Described T>
void add_schema(ByteHash& hash, std::set<std::string>& known);

/// Adds what a field of type `Field` may hold.
template <class Field>
void add_schema_of_field(ByteHash& hash, std::set<std::string>& known) {
  if constexpr (Described<Field>) {
    add_schema<Field>(hash, known);
  } else if constexpr (Variant<Field>) {
    [&]<class... Models>(std::variant<Models...> const*) {
      (
          [&] {
            hash.add(struct_name<Models>());
            if constexpr (Described<Models>) add_schema<Models>(hash, known);
          }(),
          ...);
    }(static_cast<Field const*>(nullptr));
  } else if constexpr (Optional<Field>) {
    add_schema_of_field<typename Field::value_type>(hash, known);
  } else if constexpr (!std::is_same_v<Field, std::string> && ParameterList<Field>) {
    add_schema_of_field<ElementOf<Field>>(hash, known);
  }
}

template <Described T>
void add_schema(ByteHash& hash, std::set<std::string>& known) {
  std::string description(struct_name<T>());
  if constexpr (std::is_default_constructible_v<T>) description += describe_parameters<T>();
  hash.add(description);
  if (!known.insert(std::move(description)).second) return;  // structs may hold each other, as goals do
  for_each_parameter<T>(
      [&]<class Owner, class Field>(Parameter<Owner, Field> const&) { add_schema_of_field<Field>(hash, known); });
}

/// Hash of the names, ranges and defaults of a struct's fields, and of all alternatives that it may hold.
template <Described T>
[[nodiscard]] std::uint64_t schema_of() {
  ByteHash hash;
  std::set<std::string> known;
  add_schema<T>(hash, known);
  return hash.value();
}

}  // namespace detail

/// Whether `bytes` begin as `to_binary` begins them.
[[nodiscard]] inline bool is_binary(std::string_view bytes) {
  return bytes.starts_with(detail::binary_magic.substr(0, 7));
}

/// The struct as bytes. Throws `ParameterError` if a `OneOf` holds a struct without a description. O(fields).
template <Described T>
[[nodiscard]] std::string to_binary(T const& object) {
  T const usual{};
  detail::BinaryWriter writer;
  auto copy = object;  // a transfer writes back what it was given
  detail::transfer_any<T>(&copy, &usual, writer);
  return detail::sealed(writer.bytes(), detail::schema_of<T>());
}

/// A struct from bytes. Throws `ParameterError` if they are of another kind or version, cut short or damaged, or if a
/// value is out of range. O(bytes).
template <Described T>
[[nodiscard]] T from_binary(std::string_view bytes, std::string const& where = "binary file") {
  auto const payload = detail::opened(bytes, detail::schema_of<T>(), where);
  T const usual{};
  T object{};
  detail::BinaryReader reader(payload, where);
  detail::transfer_any<T>(&object, &usual, reader);
  reader.finish();
  check_parameters(object, where);
  return object;
}

}  // namespace cambium
