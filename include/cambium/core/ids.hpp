#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace cambium::inline v0_1 {

/// Names an agent for its whole life. A world never reuses an id after the agent has left.
enum class AgentId : std::uint32_t {};
/// Names a static object of a world.
enum class ObjectId : std::uint32_t {};
/// Index of an agent among the agents of a world, or of an object among its objects. When one leaves, those behind it
/// move up.
enum class Slot : std::uint32_t {};
/// Dense index of a road in its `Map`. The file's own id is `Road::name`.
enum class RoadId : std::uint32_t {};
/// Dense index of a lane (one lane of one lane section) in its `Map`.
enum class LaneId : std::uint32_t {};
/// Dense index of a junction in its `Map`.
enum class JunctionId : std::uint32_t {};
/// Dense index of a traffic light in its `Map`.
enum class LightId : std::uint32_t {};

/// Number of a lane corridor in its `map::RoadCorridor`.
enum class CorridorId : std::uint16_t {};
/// Number of a piece (one lane's stretch) in its `map::LaneCorridor`.
enum class PieceId : std::uint16_t {};

namespace detail {
template <class T, class... Ids>
inline constexpr bool is_among = (std::is_same_v<T, Ids> || ...);
}  // namespace detail

/// Whether an enum is an id. It is true for the ids above; for your own, say
/// `template <> inline constexpr bool cambium::is_id<DepotId> = true;`.
template <class T>
inline constexpr bool is_id =
    detail::is_among<T, AgentId, ObjectId, Slot, RoadId, LaneId, JunctionId, LightId, CorridorId, PieceId>;

/// An enum that numbers things and has no named values. Its highest number is `none`; files hold the number, which
/// needs neither names nor a range.
template <class Id>
concept StrongId = is_id<Id> && std::is_enum_v<Id> &&(std::is_same_v<std::underlying_type_t<Id>, std::uint32_t> ||
                                                      std::is_same_v<std::underlying_type_t<Id>, std::uint16_t>);

/// The invalid id, which names nothing.
template <StrongId Id>
inline constexpr Id none = static_cast<Id>(std::numeric_limits<std::underlying_type_t<Id>>::max());

/// The id's number, as an array index.
template <StrongId Id>
[[nodiscard]] constexpr std::size_t index_of(Id id) {
  return static_cast<std::size_t>(id);
}

/// Whether an id names something: it is not `none`.
template <StrongId Id>
[[nodiscard]] constexpr bool is_valid(Id id) {
  return id != none<Id>;
}

/// Moves to the next number.
template <StrongId Id>
constexpr Id& operator++(Id& id) {
  return id = static_cast<Id>(index_of(id) + 1);
}

/// A vector that can also be indexed by ids of one type.
template <class T, StrongId Id>
struct IdVector : std::vector<T> {
  using std::vector<T>::vector;
  using std::vector<T>::operator[];

  [[nodiscard]] T& operator[](Id id) { return (*this)[index_of(id)]; }
  [[nodiscard]] T const& operator[](Id id) const { return (*this)[index_of(id)]; }
};

/// The id's number in decimal, "none" for `none<Id>`.
template <StrongId Id>
[[nodiscard]] std::string to_string(Id id) {
  return is_valid(id) ? std::to_string(index_of(id)) : std::string("none");
}

}  // namespace cambium::inline v0_1
