// expect: cambium::BehaviorSet<...>: a behaviour's plan must take (View const& view, Memory& memory, double dt)
struct Final final {};
cambium::BehaviorSet<Final> set;
