#include "road.hpp"

CAMBIUM_INSTANTIATE_WORLD(field::Sim);
