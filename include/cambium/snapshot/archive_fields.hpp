#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <boost/serialization/level.hpp>
#include <boost/serialization/nvp.hpp>
#include <boost/serialization/tracking.hpp>

#include "cambium/core/parameters.hpp"
#include "cambium/core/transfer_parameters.hpp"
#include "cambium/snapshot/snapshot_error.hpp"

/// Described structs in archives of Boost.Serialization: with this header, `archive & behavior` works for every struct
/// that describes its fields. The archive holds
///
///     struct:       once a type its `version` and number of fields; then each field, or
///                   bits for those that differ from a struct that the reader has already, and these fields
///     alternative:  its number; once a type its name
///     list:         its length, where that may change; each element by its differences from the one before
///
/// New fields go to the end of a description: an older archive leaves them at their defaults. A struct whose fields
/// change otherwise counts up its `static constexpr unsigned version` (0 where there is none) and has a member
/// `upgrade(unsigned from)`, which is called after its fields were read from an older archive.
namespace cambium::detail {

/// Whether the bits of two fields are equal.
template <class Value>
[[nodiscard]] bool same_bits(Value const& a, Value const& b) {
  if constexpr (Described<Value>) {
    bool same = true;
    for_each_parameter<Value>([&](auto const& p) { same = same && same_bits(a.*p.field, b.*p.field); });
    return same;
  } else if constexpr (std::is_same_v<Value, std::string>) {
    return a == b;
  } else if constexpr (Variant<Value>) {
    return a.index() == b.index() && std::visit(
                                         [&b]<class Model>(Model const& model) {
                                           if constexpr (Described<Model>)
                                             return same_bits(model, *std::get_if<Model>(&b));
                                           else
                                             return false;
                                         },
                                         a);
  } else if constexpr (Optional<Value>) {
    return a.has_value() == b.has_value() && (!a || same_bits(*a, *b));
  } else if constexpr (ParameterList<Value>) {
    auto const left = elements_of(a), right = elements_of(b);
    if (left.size() != right.size()) return false;
    for (std::size_t i = 0; i < left.size(); ++i)
      if (!same_bits(left[i], right[i])) return false;
    return true;
  } else if constexpr (std::is_same_v<Value, double>) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  } else if constexpr (std::is_same_v<Value, float>) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
  } else {
    return a == b;
  }
}
