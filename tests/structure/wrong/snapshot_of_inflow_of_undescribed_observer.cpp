// expect: cambium: a snapshot of a TrafficInflow holds the next agents
std::string save(cambium::TrafficInflow<BlurredSim> const& inflow) { return cambium::to_snapshot({}, inflow); }
