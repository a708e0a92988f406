#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cambium/benchmark/result_group.hpp"

namespace cambium {

/// Which values of a measure are better.
enum class Better { neither, more, less };

/// A quantity of each run that reports show: a share of scenarios (of a bool or an error), or a mean (of a number).
struct Measure {
  std::string key{};       ///< the field's name in the database
  std::string name{};      ///< for people: "least gap"
  std::string unit{};      ///< "m"; "%" of shares, "" of pure numbers
  std::string sentence{};  ///< what it means
  bool is_share = false;
  Better better = Better::neither;
  std::function<double(ResultGroup::Row const&)> value{};  ///< 0 or 1 of a share; not finite where there is nothing
};

/// All measures, in the order of the fields of `RunResult` and `RunTimes`: a field that is described there is a measure
/// here. Better or worse are outcomes, safety and the closed-loop score. Neither are speeds, gaps and the like, of
/// which a good driver may have more or less; time-outs, which lack success; and times, which depend on the machine.
[[nodiscard]] std::vector<Measure> const& measures();

}  // namespace cambium

#ifndef CAMBIUM_COMPILED
#include "cambium/benchmark/measure_impl.hpp"
#endif
