// expect: cambium::MctsWorkspace<Domain, Options>: Options must be cambium::MctsOptions<Selection, Rollout, Budget>
// A selection where the options belong.
cambium::Mcts<Predicted, cambium::MacroActions, cambium::TrafficReward, cambium::IdmClassic, cambium::Ucb1>::Workspace
    workspace;
