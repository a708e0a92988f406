#pragma once

#include <algorithm>

#include "cambium/core/macros.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/planner/detail/same_scene.hpp"
#include "cambium/world/static_object.hpp"

namespace cambium::inline v0_1::detail {

CAMBIUM_COLD bool is_same_besides_agents(RosterBase const& a, RosterBase const& b) {
  auto const is_same_object = [](StaticObject const& one, StaticObject const& other) {
    return one.id == other.id && one.outline == other.outline;
  };
  return a.lights == b.lights &&
         std::equal(a.goals.begin(), a.goals.end(), b.goals.begin(), b.goals.end(), is_same_choice<Goal>) &&
         std::equal(a.objects.begin(), a.objects.end(), b.objects.begin(), b.objects.end(), is_same_object);
}

}  // namespace cambium::inline v0_1::detail
