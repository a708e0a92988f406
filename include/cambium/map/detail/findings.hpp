#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/opendrive/reading_limits.hpp"

namespace cambium::inline v0_1::map::detail {

/// The findings about a file: its reader, the checks and the map building add to one list.
struct Findings {
  std::string file;
  std::vector<Diagnostic>& list;

  /// Adds a finding, unless there are `most_diagnostics`: the last of those says that there are more.
  [[gnu::cold]] void add(Severity severity, int line, std::string element, std::string ids, std::string sentence) {
    if (list.size() >= most_diagnostics) return;
    if (list.size() + 1 == most_diagnostics)
      sentence = "the file has more than " + std::to_string(most_diagnostics) + " findings; the others were left out";
    list.push_back({severity, file, line, std::move(element), std::move(ids), std::move(sentence)});
  }
};

/// " (finding)", to be appended to the message that no road, lane or lanelet is left: the first warning that says that
/// a road, a lane or another element was left out, or the warning to which that one refers. If there is none, the first
/// warning about an element of roads or lanes; empty without one.
[[nodiscard]] inline std::string likely_cause(std::span<Diagnostic const> findings) {
  constexpr std::array<std::string_view, 17> carrying{
      "road", "planView", "geometry",    "line", "arc", "spiral", "poly3",  "paramPoly3", "lanes",
      "lane", "lanelet",  "laneSection", "node", "nd",  "way",    "member", "relation"};
  for (char const* words : {"the road was left out", "the lane was left out", "left out", ""}) {
    Diagnostic const* before = nullptr;
    for (auto const& finding : findings) {
      bool const matters = std::find(carrying.begin(), carrying.end(), finding.element) != carrying.end();
      if (finding.severity == Severity::info || !matters) continue;
      auto const says = [&finding](char const* what) { return finding.sentence.find(what) != std::string::npos; };
      if (says(words))
        return " (" + to_string(before != nullptr && says("see the previous finding") ? *before : finding) + ")";
      before = &finding;
    }
  }
  return {};
}

}  // namespace cambium::inline v0_1::map::detail
