// expect: cambium needs C++20: compile with -std=c++20
#include <cambium/cambium.hpp>
