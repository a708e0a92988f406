// expect: your goal's `lanes` would be ignored; write `std::vector<cambium::LaneId> lanes(cambium::Map const&) const`
#include <cambium/goal/goal.hpp>

struct Anywhere {
  bool at_goal(cambium::GoalSituation const&) const { return true; }
  std::vector<cambium::LaneId> lanes(cambium::Map const&) { return {}; }
};
cambium::Goal const goal = Anywhere{};
