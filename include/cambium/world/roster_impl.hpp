#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/world/roster.hpp"

namespace cambium {

CAMBIUM_COLD RosterBase::RosterBase() = default;
CAMBIUM_COLD RosterBase::RosterBase(RosterBase const&) = default;
CAMBIUM_COLD RosterBase::RosterBase(RosterBase&&) noexcept = default;
CAMBIUM_COLD RosterBase& RosterBase::operator=(RosterBase const&) = default;
CAMBIUM_COLD RosterBase& RosterBase::operator=(RosterBase&&) noexcept = default;
CAMBIUM_COLD RosterBase::~RosterBase() = default;

CAMBIUM_COLD ObjectId RosterBase::insert(StaticObject object, std::vector<TrafficEntry> const& entries) {
  object_entries.reserve(object_entries.size() + entries.size());
  objects.push_back(std::move(object));
  for (auto const& entry : entries)
    object_entries.insert(std::upper_bound(object_entries.begin(), object_entries.end(), entry), entry);
  return static_cast<ObjectId>(next_object_id++);
}

CAMBIUM_COLD void RosterBase::erase_object(std::size_t place) {
  objects.erase(objects.begin() + static_cast<std::ptrdiff_t>(place));
  auto const slot = static_cast<std::uint32_t>(place);
  std::erase_if(object_entries, [slot](TrafficEntry const& entry) { return entry.slot == slot; });
  for (auto& entry : object_entries) entry.slot -= entry.slot > slot;
}

CAMBIUM_COLD void RosterBase::insert_goal(std::size_t slot, Goal goal) {
  has_sequences = has_sequences || std::holds_alternative<GoalSequence>(goal);
  goals.insert(goals.begin() + static_cast<std::ptrdiff_t>(slot), std::move(goal));
}

CAMBIUM_COLD void RosterBase::erase_goal(std::size_t slot) {
  goals.erase(goals.begin() + static_cast<std::ptrdiff_t>(slot));
}

CAMBIUM_COLD void RosterBase::keep_goals(std::vector<std::size_t> const& slots) {
  for (std::size_t to = 0; to < slots.size(); ++to)
    if (to != slots[to]) goals[to] = std::move(goals[slots[to]]);
  goals.erase(goals.begin() + static_cast<std::ptrdiff_t>(slots.size()), goals.end());
}

CAMBIUM_COLD void RosterBase::assume_goal(RosterBase const* other, std::size_t slot) {
  goals.push_back(other != nullptr ? other->goals[slot] : Goal{});
}

CAMBIUM_COLD void RosterBase::assume_objects(RosterBase const& other, std::vector<std::uint8_t> const& seen) {
  constexpr auto unseen = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> places(other.objects.size(), unseen);
  for (std::size_t i = 0; i < other.objects.size(); ++i) {
    if (seen[i] == 0) continue;
    places[i] = static_cast<std::uint32_t>(objects.size());
    objects.push_back(other.objects[i]);
  }
  for (auto entry : other.object_entries) {
    entry.slot = places[entry.slot];
    if (entry.slot != unseen) object_entries.push_back(entry);  // still sorted: the order is kept
  }
}

}  // namespace cambium
