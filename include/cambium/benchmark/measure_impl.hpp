#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "cambium/benchmark/measure.hpp"
#include "cambium/core/macros.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// "least_gap" as "least gap"; a unit at the end ("run_s") is left out.
[[nodiscard]] inline std::string name_of_measure(std::string key, std::string const& unit) {
  for (auto const& [field, name] : {std::pair{"mean_ms", "mean planning time"},
                                    std::pair{"longest_ms", "longest planning time"}, std::pair{"run_s", "run time"}})
    if (key == field) return name;
  std::string const ending = "_" + unit;
  if (key.size() > ending.size() && std::string_view(key).ends_with(ending)) key.resize(key.size() - ending.size());
  std::replace(key.begin(), key.end(), '_', ' ');
  return key;
}

template <class Struct>
void add_measures(std::vector<Measure>& list, Struct ResultGroup::Row::*part) {
  constexpr bool is_time = std::is_same_v<Struct, RunTimes>;
  for_each_parameter<Struct>([&](auto const& entry) {
    using Field = std::remove_cvref_t<decltype(std::declval<Struct&>().*entry.field)>;
    constexpr bool is_text = std::is_same_v<Field, std::string>, is_share = is_text || std::is_same_v<Field, bool>;
    if constexpr (is_share || std::is_arithmetic_v<Field>) {
      Measure measure{.key = entry.name, .unit = is_share ? "%" : entry.unit, .sentence = entry.sentence};
      if (measure.unit == "-") measure.unit.clear();
      measure.name = name_of_measure(measure.key, measure.unit);
      measure.is_share = is_share;
      if constexpr (is_time)
        measure.is_time = true;
      else
        measure.better = Struct::better(measure.key);
      measure.value = [part, field = entry.field,
                       needs_whole_run =
                           !is_share && !is_time && measure.key != "closed_loop_score"](ResultGroup::Row const& row) {
        if (needs_whole_run && !row.result.error.empty()) return std::numeric_limits<double>::quiet_NaN();
        if constexpr (is_text)
          return (row.*part.*field).empty() ? 0.0 : 1.0;
        else
          return static_cast<double>(row.*part.*field);
      };
      list.push_back(std::move(measure));
    }
  });
}

}  // namespace detail

CAMBIUM_COLD std::vector<Measure> const& measures() {
  static std::vector<Measure> const all = [] {
    std::vector<Measure> list;
    detail::add_measures(list, &ResultGroup::Row::result);
    detail::add_measures(list, &ResultGroup::Row::times);
    return list;
  }();
  return all;
}

CAMBIUM_COLD std::size_t measure_index(std::string_view key) {
  return static_cast<std::size_t>(std::ranges::find(measures(), key, &Measure::key) - measures().begin());
}

}  // namespace cambium::inline v0_1
