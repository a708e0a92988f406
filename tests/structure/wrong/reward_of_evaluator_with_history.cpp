// expect: this evaluator needs a history, and predictions keep none
cambium::Reward<cambium::Jerk> reward;
