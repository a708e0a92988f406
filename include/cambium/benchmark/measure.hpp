#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/benchmark/result_group.hpp"

namespace cambium::inline v0_1 {

/// A quantity of each run that reports show: a share of scenarios (of a bool or an error), or a mean (of a number).
struct Measure {
  std::string key{};       ///< the field's name in the database
  std::string name{};      ///< for people: "least gap"
  std::string unit{};      ///< "m"; "%" of shares, "" of pure numbers
  std::string sentence{};  ///< what it means
  bool is_share = false;
  bool is_time = false;  ///< a field of `RunTimes`, which depends on the machine
  Better better = Better::neither;
  std::function<double(ResultGroup::Row const&)> value{};  ///< 0 or 1 of a share; not finite where there is nothing
};

/// All measures, in the order of the fields of `RunResult` and `RunTimes`: a field that is described there is a measure
/// here. `RunResult::better` says which values are better; of times, which depend on the machine, neither are.
[[nodiscard]] std::vector<Measure> const& measures();

/// The place of a measure in `measures()`. Precondition: there is one of that key.
[[nodiscard]] std::size_t measure_index(std::string_view key);

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/benchmark/measure_impl.hpp"
#endif
