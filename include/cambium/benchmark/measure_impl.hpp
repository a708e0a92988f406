#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "cambium/benchmark/measure.hpp"
#include "cambium/core/macros.hpp"

namespace cambium {

namespace detail {

[[nodiscard]] inline Better better_of(std::string_view key) {
  for (char const* more : {"success", "rss_compliance", "closed_loop_score"})
    if (key == more) return Better::more;
  for (char const* less :
       {"collision", "at_fault", "off_road", "off_route", "error", "hard_brakings", "others_collided"})
    if (key == less) return Better::less;
  return Better::neither;
}

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
  for_each_parameter<Struct>([&](auto const& entry) {
    using Field = std::remove_cvref_t<decltype(std::declval<Struct&>().*entry.field)>;
    constexpr bool is_text = std::is_same_v<Field, std::string>, is_share = is_text || std::is_same_v<Field, bool>;
    if constexpr (is_share || std::is_arithmetic_v<Field>) {
      Measure measure{.key = entry.name, .unit = is_share ? "%" : entry.unit, .sentence = entry.sentence};
      if (measure.unit == "-") measure.unit.clear();
      measure.name = name_of_measure(measure.key, measure.unit);
      measure.is_share = is_share;
      measure.better = better_of(measure.key);
      measure.value = [part, field = entry.field,
                       needs_whole_run = !is_share && std::is_same_v<Struct, RunResult> &&
                                         measure.key != "closed_loop_score"](ResultGroup::Row const& row) {
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

}  // namespace cambium
