/// The room `core`: ids, states, plans, random streams and distributions, parameter structs, errors, version.
///
/// **Parameters.** A parameter struct lists its fields once, in `parameters()`. Everything else reads that list: range
/// checks, printing, comparing, hashing, file formats and the tables in the READMEs (`core/described.hpp`).
///
/// **Random numbers.** A `RandomStream` is a counter-based generator: its bits are a pure function of (seed, agent,
/// step, purpose). Results therefore depend neither on the order of agents nor on threads.
///
/// **Errors.** Loading and building throw `Error`s; the step path does not throw. `CAMBIUM_ASSERT` guards invariants.
///
/// `core/json.hpp` and `core/json_document.hpp` (need nlohmann_json), `core/binary.hpp`, `core/nearest_names.hpp`,
/// `core/text.hpp` (parses numbers), `core/markup.hpp` (text in HTML and JSON), `core/read_file.hpp`,
/// `core/write_file.hpp`, `core/stable_sort.hpp` and `core/state_vector.hpp` (Eigen) are included by name.
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

#include "cambium/core/constants.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/diagnostic.hpp"
#include "cambium/core/distribution.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/one_of.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/plan.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/random.hpp"
#include "cambium/core/state.hpp"
#include "cambium/core/type_info.hpp"
#include "cambium/core/version.hpp"
