// expect: cambium: a planner's own terms must be cambium::Terms<Evaluators...>
cambium::FrenetPlanner<Sim, cambium::IdmClassic, cambium::NoBudget, cambium::Progress> planner;
