// expect: cambium::plan_by_candidates: the planner needs compare, drive, foresee and entry, see CandidatePlanner
struct Planner {
  using World = WorldOf<cambium::ConstantAcceleration>;
  using Memory = cambium::NoMemory;
  using Workspace = cambium::CandidateWorkspace<World, int>;
  using Report = cambium::CandidateReport<World, Memory, int>;
  double step = 0.2;
  cambium::IterationBudget budget{1};
  cambium::SearchProblem compare(auto const&, Memory&, Workspace&, auto&) const { return {}; }
  template <class View>
  cambium::Plan<View> drive(View const&, Memory&, double, Workspace&) const {
    return {};
  }
  cambium::PlannerCandidate entry(auto const&, Workspace const&, int) const { return {}; }
  template <class View>
  cambium::Plan<View> plan(View const& view, Memory& memory, double dt, Workspace& workspace) const {
    return cambium::plan_by_candidates(*this, view, memory, dt, workspace);
  }
};

cambium::Plan<cambium::ObservedWorld<Planner::World>> plan(Planner const& planner,
                                                           cambium::ObservedWorld<Planner::World> const& view,
                                                           cambium::NoMemory& memory, Planner::Workspace& workspace) {
  return planner.plan(view, memory, 0.2, workspace);
}
