// expect: cambium::World: a world shares its map with others; pass the std::shared_ptr<Map const>
Sim make(std::shared_ptr<cambium::Map const> const& map) { return Sim(*map, {.seed = 7}); }
