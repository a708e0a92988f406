// expect: the behaviour set of a planner's PredictionWorld must contain its Others
// It predicts others of constant acceleration.
cambium::FrenetPlanner<WorldOf<cambium::ExternalInput>> planner;
