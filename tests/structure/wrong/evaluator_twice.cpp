// expect: cambium::Evaluators<...>: each evaluator may appear once, for its results go by name
#include <cambium/evaluation/collision.hpp>
#include <cambium/evaluation/evaluators.hpp>

cambium::Evaluators const judge(cambium::CollisionEgo{cambium::AgentId{1}}, cambium::CollisionEgo{cambium::AgentId{2}});
using Result = decltype(judge)::Result;
Result const result{};
