#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "allocations.hpp"

// How every benchmark of this folder is registered and counted. Includes allocations.hpp: one translation unit only.

namespace yardstick {

inline constexpr char const* per_agent_step = "ns_per_agent_step";
inline constexpr char const* per_copy = "ns_per_copy";
inline constexpr char const* rate = "per_second";
inline constexpr char const* search_rate = "iterations_per_second";
inline constexpr char const* milliseconds = "ms";
inline constexpr char const* per_query = "ns";
inline constexpr char const* allocation_counter = "allocations";

/// Registers `function` (void(benchmark::State&)) as `name`, which stays plain in the output; adds the minimum and
/// maximum over repetitions to the statistics of the library.
template <class Function>
auto* add(std::string const& name, Function&& function) {
  auto const lowest = [](std::vector<double> const& v) { return *std::min_element(v.begin(), v.end()); };
  auto const highest = [](std::vector<double> const& v) { return *std::max_element(v.begin(), v.end()); };
  auto* benchmark = benchmark::RegisterBenchmark(name.c_str(), std::forward<Function>(function));
  return benchmark->ComputeStatistics("min", lowest)->ComputeStatistics("max", highest);
}

namespace detail {
// Runs `action` as often as the library asks; sets the counter `allocations` to the mean per run.
template <class Action>
void run_counted(benchmark::State& state, Action&& action) {
  std::uint64_t const before = allocations();
  for (auto _ : state) {
    action();
    benchmark::ClobberMemory();
  }
  auto const used = static_cast<double>(allocations() - before);
  state.counters[allocation_counter] = used / static_cast<double>(state.iterations());
}

// CPU time [ns] per item, with `items` of them in each run.
[[nodiscard]] inline benchmark::Counter nanoseconds(benchmark::State const& state, double items) {
  double const total = items * static_cast<double>(state.iterations());
  return {total * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert};
}
}  // namespace detail

/// Measures `step`, one step of a world of `agents`: counters ns_per_agent_step and allocations (per step).
template <class Step>
void measure_step(benchmark::State& state, std::size_t agents, Step&& step) {
  detail::run_counted(state, std::forward<Step>(step));
  state.counters[per_agent_step] = detail::nanoseconds(state, static_cast<double>(agents));
}

/// Measures `copy`, one copy: counters ns_per_copy and allocations (per copy).
template <class Copy>
void measure_copy(benchmark::State& state, Copy&& copy) {
  detail::run_counted(state, std::forward<Copy>(copy));
  state.counters[per_copy] = detail::nanoseconds(state, 1.0);
}

/// Measures `action`, say reading a file: counters ms and allocations (per action).
template <class Action>
void measure_duration(benchmark::State& state, Action&& action) {
  detail::run_counted(state, std::forward<Action>(action));
  state.counters[milliseconds] = {static_cast<double>(state.iterations()) * 1e-3,
                                  benchmark::Counter::kIsRate | benchmark::Counter::kInvert};
}

/// Measures `queries`, which asks `count` times: counters ns (per query) and allocations (per query).
template <class Queries>
void measure_queries(benchmark::State& state, std::size_t count, Queries&& queries) {
  detail::run_counted(state, std::forward<Queries>(queries));
  state.counters[allocation_counter] = state.counters[allocation_counter] / static_cast<double>(count);
  state.counters[per_query] = detail::nanoseconds(state, static_cast<double>(count));
}

/// Measures `action`, say one roll-out: counters per_second and allocations (per action).
template <class Action>
void measure_rate(benchmark::State& state, Action&& action) {
  detail::run_counted(state, std::forward<Action>(action));
  state.counters[rate] = {static_cast<double>(state.iterations()), benchmark::Counter::kIsRate};
}

/// Measures `search`, which does `iterations`: counters iterations_per_second and allocations (per search).
template <class Search>
void measure_search(benchmark::State& state, std::size_t iterations, Search&& search) {
  detail::run_counted(state, std::forward<Search>(search));
  state.counters[search_rate] = {static_cast<double>(iterations * state.iterations()), benchmark::Counter::kIsRate};
}

}  // namespace yardstick
