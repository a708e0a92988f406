// expect: cambium::ProposalPlanner<PredictionWorld>: the behaviour set of PredictionWorld must contain cambium::IdmProposal
cambium::ProposalPlanner<WorldOf<cambium::ConstantAcceleration>> planner;
