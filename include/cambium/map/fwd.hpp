#pragma once

#include <cstdint>

/// Forward declarations of the map room.
namespace cambium::map {

class Map;
struct Lane;
struct LaneCorridor;
struct RoadCorridor;
struct ConflictArea;
struct FreeCorridorOptions;
struct StopLine;
enum class RoadDirection : std::uint8_t;

}  // namespace cambium::map

namespace cambium {
using map::Map;
}
