// expect: cambium: a snapshot holds only models and memories that describe their fields
// also: a field must be a number
#include <cambium/behavior/following/idm_classic.hpp>
#include <cambium/dynamics/single_track.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/snapshot.hpp>
#include <cambium/world.hpp>

struct Blurred {
  double error = 0.1;
  static constexpr bool perfect = false;
  template <class S>
  S observe(S const& truth, bool, cambium::RandomStream const&) const {
    S seen = truth;
    seen.x += error;
    return seen;
  }
};
using Sim = cambium::World<cambium::BehaviorSet<cambium::IdmClassic>, cambium::InterpolateExecution,
                           cambium::SingleTrack, Blurred>;

std::string save(Sim const& world) { return cambium::to_snapshot({}, world); }
