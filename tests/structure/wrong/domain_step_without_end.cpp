// expect: cambium::TreeSearch<Domain>: Domain must be a game
struct Walk {
  using State = int;
  using Action = int;
  static constexpr std::size_t max_actions = 1;
  std::size_t agents() const { return 1; }
  bool is_terminal(State) const { return false; }
  std::size_t actions(State, std::size_t, std::span<Action> out) const { return out[0] = 1, 1; }
  void step(State& x, std::span<Action const> joint, cambium::RandomStream&, std::span<cambium::AgentOutcome>) const {
    x += joint[0];
  }
};

cambium::TreeSearch<Walk> search(Walk{});
