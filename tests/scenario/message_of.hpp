#pragma once

#include <string>

#include "cambium/core/error.hpp"

/// The message of the `Error` that `run` throws; "accepted" where it throws none.
std::string message_of(auto const& run) {
  try {
    static_cast<void>(run());
  } catch (cambium::Error const& error) {
    return error.what();
  }
  return "accepted";
}
