// expect: make one of an evaluator that returns a number by cambium::Exceeds
using namespace cambium;

void watch(Sim& world) {
  RuleMonitor monitor(TrafficRule<OneOf<Acceleration>>{.formula = "G acceleration", .labels = {Acceleration{}}});
  monitor(world, Slot{0});
}
