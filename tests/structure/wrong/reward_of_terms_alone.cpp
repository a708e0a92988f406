// expect: cambium::Mcts<PredictionWorld, Actions, Reward>: Terms alone know no collision and no goal
// also: cambium::TreeSearch<Domain>: Domain must be a game
cambium::Mcts<Predicted, cambium::MacroActions, cambium::Terms<cambium::Progress>>::Workspace workspace;
