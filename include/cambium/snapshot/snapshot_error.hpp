#pragma once

#include "cambium/core/error.hpp"

namespace cambium::inline v0_1 {

/// A snapshot cannot be taken, written or read.
struct SnapshotError : Error {
  using Error::Error;
};

}  // namespace cambium::inline v0_1
