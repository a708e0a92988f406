// expect: a behaviour's Memory must be copyable and default constructible
struct Hoard {
  std::unique_ptr<double> since;
};
cambium::BehaviorSet<Remembers<Hoard>> set;
