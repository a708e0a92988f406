// What a planner's translation unit holds, for bench/run compile: a world of several behaviours, stepped, copied,
// predicted and judged.

#include <cambium/behavior.hpp>
#include <cambium/dynamics.hpp>
#include <cambium/evaluation.hpp>
#include <cambium/execution.hpp>
#include <cambium/world.hpp>

namespace cb = cambium;

using Behaviors = cb::BehaviorSet<cb::IdmClassic, cb::ConstantAcceleration, cb::ExternalInput>;
using World = cb::World<Behaviors, cb::InterpolateExecution, cb::SingleTrack>;

bool is_safe(World& world, cb::AgentId ego, double acceleration) {
  auto future = world.observe(ego).predict(cb::predict_as<Behaviors>(cb::ExternalInput{}, cb::IdmClassic{}));
  auto node = future;
  node.memory<cb::ExternalInput>(ego) = {acceleration, 0.0};
  cb::Evaluators const judge(cb::CollisionEgo{ego}, cb::GoalReached{ego}, cb::DrivableArea{ego}, cb::StepCount{50});
  while (true) {
    if (!node.step(0.2)) return false;
    auto const verdict = judge.evaluate(node);
    if (verdict.ego_collision || verdict.off_road) return false;
    if (verdict.goal_reached || verdict.timed_out) return true;
  }
}
