#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace cambium::inline v0_1 {

namespace detail {

/// A number for messages: six significant digits, no trailing zeros.
[[nodiscard]] std::string rounded_text(double value);

/// `text` with control characters (ASCII and U+0080 to U+009F) escaped as \x1b, because text from a file may contain
/// terminal commands.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace detail

/// Base class of everything the library throws. The step path never throws. `what()` reads "where: what; remedy", with
/// control characters escaped (as `\x1b`).
class Error : public std::runtime_error {
 public:
  /// `where`: file, line, element, key or id; `what`: one clause; `remedy`: what the user can do (may be empty).
  Error(std::string_view where, std::string_view what, std::string_view remedy = {});

  [[nodiscard]] std::string const& where() const { return where_; }

 private:
  std::string where_;
};

/// A parameter is missing, not a number, or outside its range.
struct ParameterError : Error {
  using Error::Error;
};

/// A map cannot be read or built, or a query names something that the map does not contain.
struct MapError : Error {
  using Error::Error;
};

/// A world cannot do what it was asked to: an unknown agent, a position off the map, a route that does not exist.
struct WorldError : Error {
  using Error::Error;
};

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/core/error_impl.hpp"
#endif
