#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "cambium/core/described.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/type_info.hpp"

/// The binary form of described structs, shared by scenario sets, snapshots and messages between processes. It has what
/// versions of a struct need: fields may be appended, and a struct with a `version` and an `upgrade` may change.
///
///     struct:       once a type its version, number of fields and a hash of their names; then each field, or, where
///                   the reader has a similar struct already, bits for the fields that differ, and these
///     alternative:  a number; with a new one the name
///     list:         the length; each element by what differs from the one before
namespace cambium::inline v0_1 {

namespace detail {

/// Where fields are written to: bytes, or an archive of Boost.Serialization.
class FieldSink {
 public:
  /// An integer of 1, 2, 4 or 8 bytes.
  virtual void integer(char const* key, std::uint64_t bits, std::size_t size, bool is_signed) = 0;
  virtual void number(char const* key, double value) = 0;
  virtual void number(char const* key, float value) = 0;

  /// Whether the format nests named tags, as XML does. Only then the following are called.
  [[nodiscard]] virtual bool has_tags() const { return false; }
  virtual void begin(char const*) {}
  virtual void end(char const*) {}
  virtual void text(char const*, std::string const&) {}

 protected:
  ~FieldSink() = default;
};

/// Where fields are read from; see `FieldSink`.
class FieldSource {
 public:
  [[nodiscard]] virtual std::uint64_t integer(char const* key, std::size_t size, bool is_signed) = 0;
  virtual void number(char const* key, double& value) = 0;
  virtual void number(char const* key, float& value) = 0;

  [[nodiscard]] virtual bool has_tags() const { return false; }
  virtual void begin(char const*) {}
  virtual void end(char const*) {}
  [[nodiscard]] virtual std::string text(char const*) { return {}; }

 protected:
  ~FieldSource() = default;
};

/// Numbers as bytes, the lowest first.
class ByteSink final : public FieldSink {
 public:
  explicit ByteSink(std::string& bytes) : bytes_(bytes) {}

  void integer(char const*, std::uint64_t bits, std::size_t size, bool) override {
    for (std::size_t i = 0; i < size; ++i) bytes_ += static_cast<char>(bits >> (8 * i) & 0xffu);
  }
  void number(char const* key, double value) override { integer(key, std::bit_cast<std::uint64_t>(value), 8, false); }
  void number(char const* key, float value) override { integer(key, std::bit_cast<std::uint32_t>(value), 4, false); }

 private:
  std::string& bytes_;
};

class ByteSource final : public FieldSource {
 public:
  ByteSource(std::string_view bytes, std::string_view where) : bytes_(bytes), where_(where) {}

  [[nodiscard]] std::string_view rest() const { return bytes_; }

  [[nodiscard]] std::uint64_t integer(char const*, std::size_t size, bool is_signed) override {
    if (size > bytes_.size()) throw ParameterError(where_, "ends too early", "it is damaged: take another copy");
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) bits |= std::uint64_t{static_cast<unsigned char>(bytes_[i])} << (8 * i);
    bytes_.remove_prefix(size);
    if (is_signed && size < 8 && (bits >> (8 * size - 1) & 1u) != 0) bits |= ~std::uint64_t{0} << (8 * size);
    return bits;
  }
  void number(char const* key, double& value) override { value = std::bit_cast<double>(integer(key, 8, false)); }
  void number(char const* key, float& value) override {
    value = std::bit_cast<float>(static_cast<std::uint32_t>(integer(key, 4, false)));
  }

 private:
  std::string_view bytes_, where_;
};

/// How much memory a copy of an object needs besides its own [bytes].
[[nodiscard]] std::size_t bytes_in(TypeInfo const& type, void const* object);

/// Writes an object. Throws `ParameterError` at `where` if it holds a struct that is not described, a struct nested
/// more than 200 deep, or a list of more than 16 million elements.
void write_fields(FieldSink& sink, char const* key, TypeInfo const& type, void const* object, std::string const& where);

/// Reads what `write_fields` has written, and brings structs of older versions up to date. Throws `ParameterError`
/// where the content contradicts itself, is newer than the structs, or has a whole number out of its range. Real
/// numbers keep their bits, whatever they are: a planner that went wrong may remember NaN. Allocates at most 64 MiB
/// plus 256 bytes for each byte read. `where`: the source, for messages.
void read_fields(FieldSource& source, char const* key, TypeInfo const& type, void* object, std::string const& where);

/// The bytes of a file with this content.
[[nodiscard]] std::string sealed(std::string const& content);
[[nodiscard]] std::string binary_of(TypeInfo const& type, void const* object);
void read_binary(std::string_view bytes, TypeInfo const& type, void* object, std::string const& where);

}  // namespace detail

/// Whether `bytes` begin as `to_binary` begins them.
[[nodiscard]] inline bool is_binary(std::string_view bytes) { return bytes.starts_with("cambium"); }

/// The struct as bytes, with a checksum. Throws `ParameterError` if a `OneOf` holds a struct without a description.
/// O(fields).
template <Described T>
[[nodiscard]] std::string to_binary(T const& object) {
  return detail::binary_of(type_info<T>(), &object);
}

/// A struct from bytes. Throws `ParameterError` if they are of another kind, cut short or damaged, of a newer version
/// of a struct, or if a value is out of range. O(bytes).
template <Described T>
[[nodiscard]] T from_binary(std::string_view bytes, std::string const& where = "binary file") {
  T object{};
  detail::read_binary(bytes, type_info<T>(), &object, where);
  check_parameters(object, where);
  return object;
}

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/core/binary_impl.hpp"
#endif
