#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

namespace cambium {

/// Names an agent for its whole life. Ids that a world gives are never used again after the agent left.
enum class AgentId : std::uint32_t {};
/// Names a static object of a world.
enum class ObjectId : std::uint32_t {};
/// Dense index of a road in its `Map`. The file's own id is `Road::name`.
enum class RoadId : std::uint32_t {};
/// Dense index of a lane (one lane of one lane section) in its `Map`.
enum class LaneId : std::uint32_t {};
/// Dense index of a junction in its `Map`.
enum class JunctionId : std::uint32_t {};
/// Dense index of a traffic light in its `Map`.
enum class LightId : std::uint32_t {};

template <class Id>
concept StrongId = std::is_enum_v<Id> && std::is_same_v<std::underlying_type_t<Id>, std::uint32_t>;

/// The value that names nothing.
template <StrongId Id>
inline constexpr Id none = static_cast<Id>(std::numeric_limits<std::uint32_t>::max());

/// The id's number, to index arrays with.
template <StrongId Id>
[[nodiscard]] constexpr std::size_t index_of(Id id) {
  return static_cast<std::size_t>(id);
}

template <StrongId Id>
[[nodiscard]] constexpr bool is_valid(Id id) {
  return id != none<Id>;
}

/// The id's number in decimal, "none" for `none<Id>`.
template <StrongId Id>
[[nodiscard]] std::string to_string(Id id) {
  return is_valid(id) ? std::to_string(static_cast<std::uint32_t>(id)) : std::string("none");
}

}  // namespace cambium
