// expect: cambium: the parameters() of an action or of a selection policy's Statistics leave out a field
struct Statistics {
  double best = 0.0, last = 0.0;
  static constexpr char const* name = "greedy_statistics";
  static constexpr auto parameters() {
    return cambium::parameter_list(
        cambium::parameter("best", &Statistics::best, "-", cambium::any_finite, "score of an arm"));
  }
};
std::string save(GreedyPlanner<Statistics>::Workspace const& workspace) { return cambium::to_snapshot({}, workspace); }
