// expect: is no cambium::World
#include <cambium/cambium.hpp>

struct Traffic {};
CAMBIUM_EXTERN_WORLD(Traffic);
