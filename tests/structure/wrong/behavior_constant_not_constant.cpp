// expect: what a behaviour says to worlds is `static constexpr bool looks_beside`, looks_around or heeds_conflicts
struct Mine : Idle {
  bool looks_beside = true;
};
cambium::BehaviorSet<Mine> set;
