#pragma once

#include <string>
#include <string_view>

#include "cambium/benchmark/executor.hpp"
#include "cambium/core/binary.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/type_info.hpp"

/// Outcomes of jobs as bytes, for messages between processes of one program.
namespace cambium::inline v0_1::detail {

[[nodiscard]] inline std::string outcome_bytes(JobOutcome const& outcome) {
  return binary_of(type_info<JobOutcome>(), &outcome);
}

/// Throws `Error` if the bytes are cut short, or of another program.
[[nodiscard]] inline JobOutcome read_outcome(std::string_view bytes) {
  JobOutcome outcome;
  try {
    read_binary(bytes, type_info<JobOutcome>(), &outcome, "message");
  } catch (ParameterError const& problem) {
    throw Error("", problem.what(), "run the same build of the program in all processes");
  }
  return outcome;
}

}  // namespace cambium::inline v0_1::detail
