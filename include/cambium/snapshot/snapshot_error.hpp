#pragma once

#include "cambium/core/error.hpp"

namespace cambium {

/// A snapshot cannot be taken, written or read.
struct SnapshotError : Error {
  using Error::Error;
};

}  // namespace cambium
