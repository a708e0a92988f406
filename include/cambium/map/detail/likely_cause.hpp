#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>

#include "cambium/core/diagnostic.hpp"

namespace cambium::map::detail {

/// " (finding)" for a message that no road or lane is left: the first warning about one by which something was left
/// out, or the one that this refers to; else the first one about any; empty where there is none.
[[nodiscard]] inline std::string likely_cause(std::span<Diagnostic const> findings) {
  constexpr std::array<std::string_view, 11> carrying{"road",  "planView",   "geometry", "line", "arc",        "spiral",
                                                      "poly3", "paramPoly3", "lanes",    "lane", "laneSection"};
  Diagnostic const* first = nullptr;
  Diagnostic const* before = nullptr;
  for (auto const& finding : findings) {
    bool const matters = std::find(carrying.begin(), carrying.end(), finding.element) != carrying.end();
    if (finding.severity == Severity::info || !matters) continue;
    auto const says = [&finding](char const* words) { return finding.sentence.find(words) != std::string::npos; };
    bool const follows = before != nullptr && says("see the finding before");
    if (follows || says("left out")) return " (" + to_string(follows ? *before : finding) + ")";
    before = &finding;
    if (first == nullptr) first = &finding;
  }
  return first == nullptr ? std::string() : " (" + to_string(*first) + ")";
}

}  // namespace cambium::map::detail
