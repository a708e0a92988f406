// expect: cambium: the parameters() of an action or of a selection policy's Statistics leave out a field
#include <cambium/dynamics.hpp>
#include <cambium/execution.hpp>
#include <cambium/planner.hpp>
#include <cambium/snapshot.hpp>

struct Greedy {
  struct Statistics {
    double best = 0.0, last = 0.0;
    static constexpr char const* name = "greedy_statistics";
    static constexpr auto parameters() {
      return cambium::parameter_list(
          cambium::parameter("best", &Statistics::best, "-", cambium::any_finite, "score of an arm"));
    }
  };
  static constexpr char const* name = "greedy";
  static constexpr auto parameters() { return cambium::parameter_list(); }
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
