#pragma once

#include <string>
#include <string_view>

#include "cambium/core/error.hpp"

namespace cambium {

/// How much a finding matters. What leaves nothing usable is no finding: it is thrown.
enum class Severity {
  info,     ///< Odd, but the map is what the file seems to mean.
  warning,  ///< A part of the file was left out or replaced, or may not be meant as it was read.
};

[[nodiscard]] constexpr std::string_view to_string(Severity severity) {
  return severity == Severity::info ? "info" : "warning";
}

/// Something odd in a user's file that did not stop the reading. A value on the result: the library never prints.
struct Diagnostic {
  Severity severity = Severity::warning;
  std::string file;      ///< as the caller named it
  int line = 0;          ///< first line is 1; 0: unknown or the whole file
  std::string element;   ///< what it is about, e.g. "width"
  std::string ids;       ///< where that is, e.g. "road 12, section 0, lane -1"; may be empty
  std::string sentence;  ///< what was found, and what was done about it

  friend bool operator==(Diagnostic const&, Diagnostic const&) = default;
};

/// One line: "file:line: warning: <element> of ids: sentence". The fields hold the file's own words; here control
/// characters are spelled out (\x1b).
[[nodiscard]] inline std::string to_string(Diagnostic const& d) {
  std::string text = d.file;
  if (d.line > 0) text += ":" + std::to_string(d.line);
  text += (text.empty() ? "" : ": ") + std::string(to_string(d.severity)) + ": ";
  if (!d.element.empty()) text += "<" + d.element + ">" + (d.ids.empty() ? "" : " of ");
  text += d.ids;
  if (!d.element.empty() || !d.ids.empty()) text += ": ";
  return detail::printable(text + d.sentence);
}

}  // namespace cambium
