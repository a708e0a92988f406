// expect: leave out a field, or name those of a Memory in another order
#include <cambium/snapshot.hpp>
#include <cambium/world.hpp>
#include <cambium/dynamics.hpp>
#include <cambium/execution.hpp>

struct Counts {
  double speed = 1.0;
  double forgotten = 2.0;
  static constexpr char const* name = "counts";
  static constexpr auto parameters() {
    return cambium::parameter_list(
        cambium::parameter("speed", &Counts::speed, "m/s", cambium::positive, "of those who count"));
  }
  template <class View>
  cambium::Plan<View> plan(View const& view, cambium::NoMemory&, double) const {
    cambium::Plan<View> plan;
    plan.trajectory.push_back(view.state());
    return plan;
  }
};
using Sim = cambium::World<cambium::BehaviorSet<Counts>, cambium::InterpolateExecution, cambium::SingleTrack>;

std::string save(Sim const& world) { return cambium::to_snapshot({}, world); }
