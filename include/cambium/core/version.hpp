#pragma once

/// The version of the library (semantic versioning). CMake reads it from here.
#define CAMBIUM_VERSION_MAJOR 0
#define CAMBIUM_VERSION_MINOR 1
#define CAMBIUM_VERSION_PATCH 0
