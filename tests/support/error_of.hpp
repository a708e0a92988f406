#pragma once

#include <string>

#include "cambium/core/error.hpp"

namespace support {

/// The message of the error of this kind that `run` throws; "no error" where it throws none.
template <class Kind = cambium::Error>
std::string error_of(auto const& run) {
  try {
    static_cast<void>(run());
  } catch (Kind const& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace support
