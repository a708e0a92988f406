// Lists all models with their laws, sources and parameters as Markdown, generated from the descriptions in the code.
// The tables in the READMEs below include/cambium are this program's output.

#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "cambium/cambium.hpp"

#include "../common/command_line.hpp"
#include "tables.hpp"

namespace models {
namespace {

struct Model {
  std::string type, name, row, page;
};

template <class M>
Model model(std::string const& type) {
  return {type, M::name, row_of<M>(type), page_of<M>(type)};
}

struct Room {
  std::string title;
  std::vector<Model> models;
};

std::vector<Model> behaviors() {
  return {model<cb::IdmClassic>("IdmClassic"),
          model<cb::IdmLaneTracking>("IdmLaneTracking"),
          model<cb::AdaptiveCruiseControl>("AdaptiveCruiseControl"),
          model<cb::IdmStochastic>("IdmStochastic"),
          model<cb::Mobil>("Mobil"),
          model<cb::LaneChangeRuleBased>("LaneChangeRuleBased"),
          model<cb::ZipMerge>("ZipMerge"),
          model<cb::Intersection>("Intersection"),
          model<cb::UrbanDriver>("UrbanDriver"),
          model<cb::RssConformant<cb::IdmClassic>>("RssConformant<Nominal>"),
          model<cb::HumanDriver<cb::IdmClassic>>("HumanDriver<Nominal>"),
          model<cb::Pedestrian>("Pedestrian"),
          model<cb::Safety>("Safety"),
          model<cb::ConstantAcceleration>("ConstantAcceleration"),
          model<cb::ConstantTurn>("ConstantTurn"),
          model<cb::StaticTrajectory>("StaticTrajectory"),
          model<cb::ExternalInput>("ExternalInput"),
          model<cb::MotionPrimitives>("MotionPrimitives"),
          model<cb::MacroActions>("MacroActions"),
          model<cb::RandomMacroActions>("RandomMacroActions"),
          model<cb::DriverActions<cb::Intersection>>("DriverActions<Driver>"),
          model<cb::HeadwayHypotheses<cb::IdmClassic>>("HeadwayHypotheses<IdmClassic>"),
          model<cb::IdmProposal>("IdmProposal")};
}

/// Planners are behaviours, too; they search in a predicted world.
std::vector<Model> planners() {
  using Set = cb::BehaviorSet<cb::MacroActions, cb::IdmClassic, cb::HeadwayHypotheses<cb::IdmClassic>, cb::IdmProposal,
                              cb::ConstantAcceleration>;
  using World = cb::World<Set, cb::InterpolateExecution, cb::SingleTrack>;
  return {model<cb::Mcts<World>>("Mcts<PredictionWorld>"),
          model<cb::ProposalPlanner<World>>("ProposalPlanner<PredictionWorld>"),
          model<cb::PolicyTreePlanner<World>>("PolicyTreePlanner<PredictionWorld>"),
          model<cb::FrenetPlanner<World>>("FrenetPlanner<PredictionWorld>")};
}

std::vector<Model> parts() {
  return {model<cb::Idm>("Idm"),
          model<cb::ImprovedIdm>("ImprovedIdm"),
          model<cb::Acc>("Acc"),
          model<cb::KeepLane>("KeepLane"),
          model<cb::TrackLine>("TrackLine"),
          model<cb::ChangeLanes<cb::MobilRule<>>>("ChangeLanes<Rule>"),
          model<cb::MobilRule<>>("MobilRule<Filters...>"),
          model<cb::FreeSpaceRule>("FreeSpaceRule"),
          model<cb::LaneChangeCourse>("LaneChangeCourse"),
          model<cb::LaneEnd>("LaneEnd"),
          model<cb::SpeedLimit>("SpeedLimit"),
          model<cb::Bends>("Bends"),
          model<cb::Signals>("Signals"),
          model<cb::Pedestrians>("Pedestrians"),
          model<cb::Conflicts>("Conflicts"),
          model<cb::Zip>("Zip"),
          model<cb::Yielding<>>("Yielding<Distribution>"),
          model<cb::RssParameters>("RssParameters"),
          model<cb::MotionPrimitive>("MotionPrimitive"),
          model<cb::MacroAction>("MacroAction"),
          model<cb::SocialForceParameters>("SocialForceParameters"),
          model<cb::CrossingParameters>("CrossingParameters"),
          model<cb::MctsOptions<>>("MctsOptions<>"),
          model<cb::TreeSearchParameters>("TreeSearchParameters"),
          model<cb::IterationBudget>("IterationBudget"),
          model<cb::NoBudget>("NoBudget"),
          model<cb::TimeBudget>("TimeBudget"),
          model<cb::Widening>("Widening"),
          model<cb::CostConstraint>("CostConstraint"),
          model<cb::Ucb1>("Ucb1"),
          model<cb::Ucb1Tuned>("Ucb1Tuned"),
          model<cb::Puct>("Puct"),
          model<cb::RegretMatching>("RegretMatching"),
          model<cb::Exp3>("Exp3"),
          model<cb::RandomRollout>("RandomRollout"),
          model<cb::PolicyRollout>("PolicyRollout"),
          model<cb::TruncatedRollout<cb::RandomRollout>>("TruncatedRollout<Base>"),
          model<cb::NoRollout>("NoRollout"),
          model<cb::TrafficReward>("TrafficReward"),
          model<cb::Terms<>>("Terms<>"),
          model<cb::Weighted<cb::Gap>>("Weighted<Gap>"),
          model<cb::BeliefParameters>("BeliefParameters"),
          model<cb::ProposalScoring>("ProposalScoring"),
          model<cb::IntentionPrior>("IntentionPrior"),
          model<cb::PolicyWeights>("PolicyWeights"),
          model<cb::FrenetCosts>("FrenetCosts"),
          model<cb::FrenetLimits>("FrenetLimits"),
          model<cb::Actuation>("Actuation"),
          model<cb::ObservationNoise>("ObservationNoise"),
          model<cb::Uniform>("Uniform"),
          model<cb::Normal>("Normal")};
}

std::vector<Room> rooms() {
  return {{"Behaviours", behaviors()},
          {"Planners: behaviours that predict", planners()},
          {"Conditions of a lane change, for `BasicMobil<Filters...>`",
           {model<cb::FreeSpace>("FreeSpace"), model<cb::RemainingLength>("RemainingLength"),
            model<cb::SpeedLimitAtLeast>("SpeedLimitAtLeast")}},
          {"Vehicle models",
           {model<cb::SingleTrack>("SingleTrack"), model<cb::SingleTrackSteering>("SingleTrackSteering"),
            model<cb::TripleIntegrator>("TripleIntegrator"), model<cb::KinematicPoint>("KinematicPoint")}},
          {"Execution of plans",
           {model<cb::InterpolateExecution>("InterpolateExecution"), model<cb::StanleyExecution>("StanleyExecution"),
            model<cb::LqrExecution>("LqrExecution")}},
          {"Observers",
           {model<cb::PerfectObserver>("PerfectObserver"), model<cb::ParametricObserver>("ParametricObserver"),
            model<cb::OccludedObserver>("OccludedObserver"), model<cb::DelayedObserver<1>>("DelayedObserver<Longest>"),
            model<cb::ObserverChain<>>("ObserverChain<Observers...>")}},
          {"Goals",
           {model<cb::NoGoal>("NoGoal"), model<cb::ReachPolygon>("ReachPolygon"), model<cb::ReachLane>("ReachLane"),
            model<cb::StateLimits>("StateLimits"), model<cb::LaneLimits>("LaneLimits"),
            model<cb::ReachLaneEnd>("ReachLaneEnd"), model<cb::ReachLaneBeside>("ReachLaneBeside"),
            model<cb::AllGoals>("AllGoals"), model<cb::AnyGoal>("AnyGoal"), model<cb::GoalSequence>("GoalSequence")}},
          {"Parts of these", parts()}};
}

void print_presets() {
  std::cout << "| driver, in `presets` | source | IDM |\n|---|---|---|\n";
  for (auto const& preset : cb::presets::all)
    std::cout << "| `" << preset.name << "` | " << preset.source << " | " << values_of(preset.parameters) << " |\n";
}

void print_shapes() {
  using namespace cb::geometry;
  struct Named {
    char const* name;
    Shape shape;
  };
  std::cout << "| shape, in `geometry` | length, width [m] | reach to the front [m] |\n|---|---|---|\n";
  for (auto const& [name, shape] :
       {Named{"car", car()}, Named{"van", van()}, Named{"truck", truck()},
        Named{"articulated_truck", articulated_truck()}, Named{"bus", bus()}, Named{"motorcycle", motorcycle()},
        Named{"bicycle", bicycle()}, Named{"pedestrian", pedestrian()}}) {
    char numbers[80];
    std::snprintf(numbers, sizeof numbers, "%.3g, %.3g | %.3g", shape.length(), shape.width(), shape.front);
    std::cout << "| `" << name << "` | " << numbers << " |\n";
  }
}

void print_all() {
  for (auto const& room : rooms()) {
    std::cout << "| " << room.title << " | law | source | parameters and defaults |\n|---|---|---|---|\n";
    for (auto const& model : room.models) std::cout << model.row;
    std::cout << "\n";
  }
  print_presets();
  std::cout << "\n";
  print_shapes();
}

void print_one(std::string const& name) {
  std::string known;
  for (auto const& room : rooms())
    for (auto const& model : room.models) {
      if (model.name == name || model.type.substr(0, model.type.find('<')) == name) {
        std::cout << model.page;
        return;
      }
      known += " " + model.name;
    }
  throw cb::Error(name, "there is no such model", "choose one of" + known);
}

}  // namespace
}  // namespace models

int main(int argc, char** argv) {
  std::string name;
  CLI::App program("Lists all models with law, source and parameters, as Markdown.", "models");
  program.add_option("NAME", name, "show all parameters of this model, with ranges and meanings; default: all models");
  return examples::run_program(program, argc, argv,
                               [&] { name.empty() ? models::print_all() : models::print_one(name); });
}
