#pragma once

/// The version of the library (semantic versioning). CMake reads it from here. Major and minor are also the inline
/// namespace of all headers, so that two versions can be in one program, each in a library of its own.
#define CAMBIUM_VERSION_MAJOR 0
#define CAMBIUM_VERSION_MINOR 1
#define CAMBIUM_VERSION_PATCH 0

#define CAMBIUM_TEXT_OF(number) #number
#define CAMBIUM_VERSION_TEXT(major, minor, patch) \
  CAMBIUM_TEXT_OF(major) "." CAMBIUM_TEXT_OF(minor) "." CAMBIUM_TEXT_OF(patch)

namespace cambium::inline v0_1 {
/// "0.1.0".
inline constexpr char const* library_version =
    CAMBIUM_VERSION_TEXT(CAMBIUM_VERSION_MAJOR, CAMBIUM_VERSION_MINOR, CAMBIUM_VERSION_PATCH);
}  // namespace cambium::inline v0_1
