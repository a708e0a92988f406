// expect: AgentId
// An id is no number and no other kind of id.
cambium::AgentId agent = cambium::none<cambium::LaneId>;
