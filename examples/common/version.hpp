#pragma once

#include <string>

#include "cambium/core/version.hpp"

namespace examples {

/// The library's version: "0.1.0".
[[nodiscard]] inline std::string version() {
  return std::to_string(CAMBIUM_VERSION_MAJOR) + '.' + std::to_string(CAMBIUM_VERSION_MINOR) + '.' +
         std::to_string(CAMBIUM_VERSION_PATCH);
}

}  // namespace examples
