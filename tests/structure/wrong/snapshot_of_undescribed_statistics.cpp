// expect: cambium: a snapshot of a kept tree holds the Statistics of its selection policy; describe their fields
// also: a field must be a number
struct Statistics {
  double best = 0.0;
};
std::string save(GreedyPlanner<Statistics>::Workspace const& workspace) { return cambium::to_snapshot({}, workspace); }
