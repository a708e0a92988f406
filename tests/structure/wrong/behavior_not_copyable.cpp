// expect: a behaviour must be a copyable struct
struct Unique : Idle {
  std::unique_ptr<double> speed;
};
cambium::BehaviorSet<Unique> set;
