/// The room `observer`: how an agent perceives.
#pragma once

#include "cambium/observer/perfect.hpp"
