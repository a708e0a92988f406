#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/world/roster.hpp"

namespace cambium::inline v0_1 {

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

CAMBIUM_COLD void RosterBase::erase_object(Slot slot) {
  objects.erase(objects.begin() + static_cast<std::ptrdiff_t>(slot));
  std::erase_if(object_entries, [slot](TrafficEntry const& entry) { return entry.slot == slot; });
  for (auto& entry : object_entries)
    if (entry.slot > slot) entry.slot = static_cast<Slot>(index_of(entry.slot) - 1);
}

CAMBIUM_COLD void RosterBase::insert_goal(Slot slot, Goal goal) {
  has_sequences = has_sequences || std::holds_alternative<GoalSequence>(goal);
  goals.insert(goals.begin() + static_cast<std::ptrdiff_t>(slot), std::move(goal));
}

CAMBIUM_COLD void RosterBase::erase_goal(Slot slot) { goals.erase(goals.begin() + static_cast<std::ptrdiff_t>(slot)); }

CAMBIUM_COLD void RosterBase::keep_goals(std::vector<Slot> const& slots) { detail::keep_at(slots, goals); }

CAMBIUM_COLD void RosterBase::assume_goal(RosterBase const* other, Slot slot) {
  goals.push_back(other != nullptr ? other->goals[slot] : Goal{});
}

CAMBIUM_COLD void RosterBase::assume_objects(RosterBase const& other, IdVector<std::uint8_t, Slot> const& seen) {
  IdVector<Slot, Slot> places(other.objects.size(), none<Slot>);
  for (Slot i{}; index_of(i) < other.objects.size(); ++i) {
    if (seen[i] == 0) continue;
    places[i] = static_cast<Slot>(objects.size());
    objects.push_back(other.objects[i]);
  }
  for (auto entry : other.object_entries) {
    entry.slot = places[entry.slot];
    if (is_valid(entry.slot)) object_entries.push_back(entry);  // still sorted: the order is kept
  }
}

}  // namespace cambium::inline v0_1
