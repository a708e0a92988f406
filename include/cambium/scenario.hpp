/// The room `scenario`: random traffic to begin with.
#pragma once

#include "cambium/scenario/lane_traffic.hpp"
