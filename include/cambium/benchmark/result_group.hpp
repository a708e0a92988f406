#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cambium/benchmark/run_result.hpp"

namespace cambium::inline v0_1 {

/// The results of one behaviour, with one set of parameters and one version of cambium, on one set of scenarios.
struct ResultGroup {
  /// One run.
  struct Row {
    std::int64_t scenario = 0;
    std::uint64_t seed = 0;
    RunResult result{};
    RunTimes times{};
    std::string population{};  ///< see `TrafficPopulation`
  };

  std::uint64_t set_hash = 0;
  std::string set{};        ///< title
  std::string set_label{};  ///< the title, and what tells the set from others of that title
  std::string source{};     ///< what names the set on the command line: "--set merging"; empty: unknown
  std::string behavior{};
  std::uint64_t parameters_hash = 0;
  std::string parameters{};  ///< as text
  std::string command{};     ///< what runs it, without the set: "examples/run benchmark"; empty: unknown
  std::string version{};
  std::string label{};      ///< the behaviour's name, and what tells it from others of that name
  std::vector<Row> rows{};  ///< by scenario
};

}  // namespace cambium::inline v0_1
