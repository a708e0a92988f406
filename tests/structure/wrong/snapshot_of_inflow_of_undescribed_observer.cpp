// expect: cambium: a snapshot of a TrafficInflow holds the next agents
#include <cambium/behavior/following/idm_classic.hpp>
#include <cambium/dynamics/single_track.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/scenario/traffic_inflow.hpp>
#include <cambium/snapshot.hpp>
#include <cambium/world.hpp>

struct Blurred {
  static constexpr bool perfect = false;
  template <class S>
  S observe(S const& truth, bool, cambium::RandomStream const&) const {
    return truth;
  }
};
using Sim = cambium::World<cambium::BehaviorSet<cambium::IdmClassic>, cambium::InterpolateExecution,
                           cambium::SingleTrack, Blurred>;

std::string save(cambium::TrafficInflow<Sim> const& inflow) { return cambium::to_snapshot({}, inflow); }
