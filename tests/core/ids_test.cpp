#include "cambium/core/ids.hpp"

#include <cstdint>
#include <type_traits>

#include <doctest/doctest.h>

using namespace cambium;

namespace {
enum class DepotId : std::uint16_t {};
enum class Mode : std::uint32_t { city, motorway };
}  // namespace
template <>
inline constexpr bool cambium::is_id<DepotId> = true;

static_assert(StrongId<DepotId> && !StrongId<Mode>);
static_assert(StrongId<AgentId> && StrongId<LaneId> && !StrongId<int>);
static_assert(!std::is_convertible_v<AgentId, LaneId> && !std::is_convertible_v<AgentId, int>);
static_assert(sizeof(AgentId) == 4);

TEST_CASE("an id gives its number back, as an index and as text; none is no valid id and says so") {
  CHECK(index_of(LaneId{7}) == 7);
  CHECK(to_string(LaneId{7}) == "7");
  CHECK(AgentId{1} < AgentId{2});
  CHECK(is_valid(RoadId{0}));
  CHECK(!is_valid(none<RoadId>));
  CHECK(to_string(none<AgentId>) == "none");
}
