#pragma once

#include <string>
#include <string_view>

#include "cambium/core/error.hpp"

namespace cambium::inline v0_1 {

/// How much a finding matters. A problem that leaves nothing usable is thrown as an `Error` instead.
enum class Severity {
  info,     ///< odd, but the map is most likely as intended
  warning,  ///< a part of the file was left out or replaced, or the map may not be as intended
};

/// "info" or "warning".
[[nodiscard]] constexpr std::string_view to_string(Severity severity) {
  return severity == Severity::info ? "info" : "warning";
}

/// Something odd in a user's file that did not prevent reading it. It is returned with the result: the library never
/// prints.
struct Diagnostic {
  Severity severity = Severity::warning;
  std::string file;      ///< as the caller named it
  int line = 0;          ///< first line is 1; 0: unknown or the whole file
  std::string element;   ///< the element concerned, e.g. "width"
  std::string ids;       ///< the ids of its owners, e.g. "road 12, section 0, lane -1"; may be empty
  std::string sentence;  ///< what was found, and what was done about it

  friend bool operator==(Diagnostic const&, Diagnostic const&) = default;
};

/// One line: "file:line: warning: <element> of ids: sentence". The fields hold text from the file unchanged; this line
/// escapes control characters (as `\x1b`).
[[nodiscard]] inline std::string to_string(Diagnostic const& d) {
  std::string text = d.file;
  if (d.line > 0) text += ":" + std::to_string(d.line);
  text += (text.empty() ? "" : ": ") + std::string(to_string(d.severity)) + ": ";
  if (!d.element.empty()) text += "<" + d.element + ">" + (d.ids.empty() ? "" : " of ");
  text += d.ids;
  if (!d.element.empty() || !d.ids.empty()) text += ": ";
  return detail::printable(text + d.sentence);
}

}  // namespace cambium::inline v0_1
