#pragma once

#include <string>

#include <doctest/doctest.h>

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

/// Checks that the error of `run` contains `part`; after a '^', that it begins so.
void says(std::string const& part, auto const& run) {
  auto const message = error_of(run);
  CAPTURE(part);
  CAPTURE(message);
  CHECK((part.front() == '^' ? message.starts_with(part.substr(1)) : message.find(part) != message.npos));
}

}  // namespace support
