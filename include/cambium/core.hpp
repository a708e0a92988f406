/// The room `core`: ids, states, plans, random streams and distributions, parameter structs, errors, version. What
/// reads numbers from texts and writes files is included by name: `core/text.hpp`, `core/write_file.hpp`.
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

#include "cambium/core/described.hpp"
#include "cambium/core/diagnostic.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/one_of.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/plan.hpp"
#include "cambium/core/random.hpp"
#include "cambium/core/state.hpp"
#include "cambium/core/version.hpp"
