// expect: cambium::Terms<Evaluators...>: describe each evaluator's parameters, as cambium::Collision does
struct Mood {
  template <class World>
  double operator()(World const&, cambium::Slot) const {
    return 1.0;
  }
};
cambium::Reward<Mood> reward;
