/// The room `observer`: how an agent perceives.
#pragma once

#include "cambium/observer/delayed.hpp"
#include "cambium/observer/observer_chain.hpp"
#include "cambium/observer/observer_model.hpp"
#include "cambium/observer/observer_set.hpp"
#include "cambium/observer/occluded.hpp"
#include "cambium/observer/parametric.hpp"
#include "cambium/observer/perfect.hpp"
