// expect: leave out a field, or name those of a Memory in another order
#include <cambium/snapshot.hpp>
#include <cambium/world.hpp>
#include <cambium/dynamics.hpp>
#include <cambium/execution.hpp>

struct Counts {
  struct Memory {
    int steps = 0;
    short counted = 0;
    bool is_new = true;
    static constexpr char const* name = "counts_memory";
    static constexpr auto parameters() {
      return cambium::parameter_list(
          cambium::parameter("steps", &Memory::steps, "-", cambium::Range{0, 1e9}, "so far"),
          cambium::parameter("counted", &Memory::counted, "-", cambium::Range{0, 1e4}, "turns"));
    }
    friend bool operator==(Memory const&, Memory const&) = default;
  };
  static constexpr char const* name = "counts";
  static constexpr auto parameters() { return cambium::parameter_list(); }
  template <class View>
  cambium::Plan<View> plan(View const& view, Memory& memory, double) const {
    ++memory.steps;
    cambium::Plan<View> plan;
    plan.trajectory.push_back(view.state());
    return plan;
  }
};
using Sim = cambium::World<cambium::BehaviorSet<Counts>, cambium::InterpolateExecution, cambium::SingleTrack>;

std::string save(Sim const& world) { return cambium::to_snapshot({}, world); }
