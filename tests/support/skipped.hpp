#pragma once

#include <string>

namespace support {

/// Says that the running test case is skipped, in whole or in part: `reason` is what is missing and what to do. The
/// program prints how many there were, as tests/run does for all of them. For the thread that runs the tests.
void skip(std::string const& reason);

}  // namespace support
