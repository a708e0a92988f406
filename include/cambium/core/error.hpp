#pragma once

#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>

namespace cambium {

namespace detail {

/// A number for messages: six digits, no trailing zeros.
[[nodiscard]] inline std::string rounded_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace detail

/// Root of everything the library throws, and only outside the step path. `what()` reads "where: what; remedy".
class Error : public std::runtime_error {
 public:
  /// `where`: file, line, element, key or id; `what`: one clause; `remedy`: what the user can do (may be empty).
  Error(std::string where, std::string const& what, std::string const& remedy = {})
      : std::runtime_error((where.empty() ? "" : where + ": ") + what + (remedy.empty() ? "" : "; " + remedy)),
        where_(std::move(where)) {}

  [[nodiscard]] std::string const& where() const { return where_; }

 private:
  std::string where_;
};

/// A parameter is missing, not a number, or outside its range.
struct ParameterError : Error {
  using Error::Error;
};

/// A map cannot be read or built, or a query names something that it does not have.
struct MapError : Error {
  using Error::Error;
};

/// A world was asked for something that it cannot do: an unknown agent, a position off the map, a route that does not
/// exist.
struct WorldError : Error {
  using Error::Error;
};

}  // namespace cambium
