#pragma once

#include <cstdint>

/// Forward declarations of the map room.
namespace cambium::inline v0_1::map {

class Map;
struct Lane;
struct LaneCorridor;
struct RoadCorridor;
struct ConflictArea;
struct FreeCorridorOptions;
struct StopLine;
enum class RoadDirection : std::uint8_t;

}  // namespace cambium::inline v0_1::map

namespace cambium::inline v0_1 {
using map::Map;
}
