/// The room `world`: the world and its frames, what an agent sees of it, neighbours, predictions, static objects.
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

#include "cambium/world/agent_spec.hpp"
#include "cambium/world/frame.hpp"
#include "cambium/world/observed_world.hpp"
#include "cambium/world/plane_index.hpp"
#include "cambium/world/prediction.hpp"
#include "cambium/world/roster.hpp"
#include "cambium/world/static_object.hpp"
#include "cambium/world/step_result.hpp"
#include "cambium/world/traffic_index.hpp"
#include "cambium/world/traffic_query.hpp"
#include "cambium/world/world.hpp"
