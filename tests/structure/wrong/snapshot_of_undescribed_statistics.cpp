// expect: cambium: a snapshot of a kept tree holds the Statistics of its selection policy; describe their fields
// also: a field must be a number
#include <cambium/dynamics.hpp>
#include <cambium/execution.hpp>
#include <cambium/planner.hpp>
#include <cambium/snapshot.hpp>

struct Greedy {
  struct Statistics {
    double best = 0.0;
  };
  template <class Arms, class Random>
  std::size_t select(Arms const& arms, std::uint32_t, cambium::ReturnScale const&, Random&) const {
    return cambium::detail::best_arm(arms, [](auto const& arm) { return arm.statistics.best; });
  }
  template <class Arms>
  void update(Arms const& arms, std::size_t chosen, double score, cambium::ReturnScale const&) const {
    arms[chosen].statistics.best = score;
  }
};
using Prediction = cambium::World<cambium::BehaviorSet<cambium::MacroActions, cambium::IdmClassic>,
                                  cambium::InterpolateExecution, cambium::SingleTrack>;
using Planner = cambium::Mcts<Prediction, cambium::MacroActions, cambium::TrafficReward, cambium::IdmClassic,
                              cambium::MctsOptions<Greedy>>;

std::string save(Planner::Workspace const& workspace) { return cambium::to_snapshot({}, workspace); }
