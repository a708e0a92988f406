/// The room `benchmark`: behaviours under test, run on sets of scenarios, and their results.
///
///     ScenarioSet   x   Contenders   --run_benchmark-->   ResultStore (one SQLite file)   -->  tables, reports
///
/// **Contender.** A behaviour under test, with its parameters. It knows how to run a scenario: its behaviour drives the
/// ego (and the other controlled agents), all others keep the drivers that the scenario gives them.
///
/// **Result.** One row a scenario and contender (`RunResult`). It depends on these two and the library alone, so that a
/// benchmark can be interrupted, spread over threads and machines, and repeated.
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

#include "cambium/benchmark/comparison.hpp"
#include "cambium/benchmark/contender.hpp"
#include "cambium/benchmark/executor.hpp"
#include "cambium/benchmark/html_report.hpp"
#include "cambium/benchmark/measure.hpp"
#include "cambium/benchmark/progress.hpp"
#include "cambium/benchmark/read_results.hpp"
#include "cambium/benchmark/report.hpp"
#include "cambium/benchmark/result_group.hpp"
#include "cambium/benchmark/result_store.hpp"
#include "cambium/benchmark/run_on_threads.hpp"
#include "cambium/benchmark/run_result.hpp"
#include "cambium/benchmark/runner.hpp"
#include "cambium/benchmark/statistics.hpp"
#include "cambium/benchmark/table.hpp"
