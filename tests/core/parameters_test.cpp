#include <cambium/cambium.hpp>
#include <doctest/doctest.h>

#include "../support/parameter_rows.hpp"

namespace cb = cambium;

TEST_CASE("defaults, units and ranges are those of the file beside") {
  support::check_parameter_rows<cb::Uniform, cb::Normal, cb::Exponential, cb::State>("core");
}
