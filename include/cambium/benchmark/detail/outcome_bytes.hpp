#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include "cambium/benchmark/executor.hpp"
#include "cambium/core/binary.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/error.hpp"

/// Outcomes of jobs as bytes, for messages between processes of one program.
namespace cambium::detail {

inline void append_text(std::string& bytes, std::string_view text) {
  append_number(bytes, text.size(), 8);
  bytes += text;
}

/// Reads what `append_number` (of 8 bytes) and `append_text` have written. Throws `Error` at the end of the bytes.
class MessageReader {
 public:
  explicit MessageReader(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] std::uint64_t number() {
    std::uint64_t value = 0;
    auto const read = take(8);
    for (std::size_t i = 0; i < 8; ++i) value |= std::uint64_t{static_cast<unsigned char>(read[i])} << (8 * i);
    return value;
  }
  [[nodiscard]] std::string text() { return std::string(take(number())); }
  [[nodiscard]] std::string_view rest() const { return bytes_; }

 private:
  [[nodiscard]] std::string_view take(std::uint64_t size) {
    if (size > bytes_.size())
      throw Error("message", "is cut short", "run the same build of the program in all processes");
    auto const read = bytes_.substr(0, static_cast<std::size_t>(size));
    bytes_.remove_prefix(static_cast<std::size_t>(size));
    return read;
  }

  std::string_view bytes_;
};

template <class Struct>
void append_fields(std::string& bytes, Struct const& object) {
  for_each_parameter<Struct>([&](auto const& entry) {
    auto const& field = object.*entry.field;
    using Field = std::remove_cvref_t<decltype(field)>;
    if constexpr (std::is_same_v<Field, std::string>)
      append_text(bytes, field);
    else if constexpr (std::is_same_v<Field, double>)
      append_number(bytes, std::bit_cast<std::uint64_t>(field), 8);
    else
      append_number(bytes, static_cast<std::uint64_t>(field), 8);
  });
}
template <class Struct>
void read_fields(MessageReader& reader, Struct& object) {
  for_each_parameter<Struct>([&](auto const& entry) {
    auto& field = object.*entry.field;
    using Field = std::remove_cvref_t<decltype(field)>;
    if constexpr (std::is_same_v<Field, std::string>)
      field = reader.text();
    else if constexpr (std::is_same_v<Field, double>)
      field = std::bit_cast<double>(reader.number());
    else
      field = static_cast<Field>(reader.number());
  });
}

[[nodiscard]] inline std::string outcome_bytes(JobOutcome const& outcome) {
  std::string bytes;
  append_fields(bytes, outcome.result);
  append_fields(bytes, outcome.times);
  append_text(bytes, outcome.replay);
  append_text(bytes, outcome.snapshot);
  append_text(bytes, outcome.problem);
  append_number(bytes, outcome.setup, 8);
  return bytes;
}
[[nodiscard]] inline JobOutcome read_outcome(std::string_view bytes) {
  MessageReader reader(bytes);
  JobOutcome outcome;
  read_fields(reader, outcome.result);
  read_fields(reader, outcome.times);
  outcome.replay = reader.text();
  outcome.snapshot = reader.text();
  outcome.problem = reader.text();
  outcome.setup = reader.number();
  return outcome;
}

}  // namespace cambium::detail
