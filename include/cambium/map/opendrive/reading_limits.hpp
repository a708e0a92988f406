#pragma once

#include <cstddef>

namespace cambium::inline v0_1::map {

/// Largest file that is read [B]. Detailed maps of large cities have a few hundred MB.
inline constexpr std::size_t largest_map_file = std::size_t{512} << 20;

/// Most elements of an OpenDRIVE file that may lie within each other. OpenDRIVE's own are less than 20 deep; the rest
/// is for user data.
inline constexpr std::size_t deepest_element = 256;

/// Most elements and attributes, together, of an OpenDRIVE file. Each takes up to 300 B of memory, so a file at the
/// limit 4.5 GB. Maps have one every 20 B of their file, or fewer.
inline constexpr std::size_t most_elements = 15'000'000;

/// Most diagnostics that reading a file gives; the last one says that there are more.
inline constexpr std::size_t most_diagnostics = 100'000;

}  // namespace cambium::inline v0_1::map
