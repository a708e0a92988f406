#pragma once

#include <cstddef>

namespace cambium::map {

/// Largest file that is read [B]. Detailed maps of large cities have a few hundred MB.
inline constexpr std::size_t largest_map_file = std::size_t{512} << 20;

/// Most elements of an OpenDRIVE file that may lie within each other. OpenDRIVE's own are less than 20 deep; the rest
/// is for user data.
inline constexpr std::size_t deepest_element = 256;

/// Most elements and attributes, together, of an OpenDRIVE file: what it takes in memory grows with them, by up
/// to 200 B each. Maps have one in 20 B of their file or more.
inline constexpr std::size_t most_elements = 30'000'000;

}  // namespace cambium::map
