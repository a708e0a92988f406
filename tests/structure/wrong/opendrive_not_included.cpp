// expect: cambium::load_opendrive: include <cambium/map/opendrive.hpp>
auto load() { return cambium::load_opendrive("maps/merging.xodr").map; }
