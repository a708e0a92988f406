#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/opendrive/reading_limits.hpp"

namespace cambium::map::detail {

/// Adds a finding to those of a file, unless there are `most_diagnostics`: the last one says that there are more.
[[gnu::cold]] inline void add_finding(std::vector<Diagnostic>& findings, Diagnostic finding) {
  if (findings.size() >= most_diagnostics) return;
  if (findings.size() + 1 == most_diagnostics)
    finding.sentence = "there is more to say of this file than " + std::to_string(most_diagnostics) + " findings";
  findings.push_back(std::move(finding));
}

}  // namespace cambium::map::detail
