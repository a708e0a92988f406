// expect: is no cambium::World
struct Traffic {};
CAMBIUM_EXTERN_WORLD(Traffic);
