#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "cambium/core/portable_math.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/oriented_box.hpp"

#include "../common/trajectories.hpp"
#include "traffic.hpp"

namespace soak {

/// What must not happen.
enum class Flaw : std::uint8_t {
  rear_end,    ///< one vehicle drives into the one ahead of it
  side,        ///< two vehicles of nearly the same direction touch: side by side, or at a merge
  crossing,    ///< their ways cross
  head_on,     ///< they drive towards each other
  pedestrian,  ///< a vehicle and a pedestrian
  stand,       ///< a vehicle stands for more than 120 s
  negative,    ///< a negative speed
  back,        ///< a vehicle moves against its heading
  jump,        ///< a way in a step that does not fit the speeds before and after
  off_route,   ///< it has left its route
  failed,      ///< no plan, or no valid next state
};
inline constexpr std::array flaw_names = {"rear-end collision",
                                          "side collision",
                                          "crossing collision",
                                          "head-on collision",
                                          "collision with a pedestrian",
                                          "stand of 120 s",
                                          "negative speed",
                                          "step back",
                                          "jump",
                                          "off its route",
                                          "failed step"};
inline constexpr auto flaw_count = flaw_names.size();

[[nodiscard]] constexpr char const* to_string(Flaw flaw) { return flaw_names[static_cast<std::size_t>(flaw)]; }
[[nodiscard]] constexpr bool is_collision(Flaw flaw) { return flaw <= Flaw::pedestrian; }

/// One of them, where and when.
struct Finding {
  Flaw flaw{};
  std::uint64_t step{};
  double time{};
  cb::AgentId first = cb::none<cb::AgentId>, second = first;
  std::string who{};
};

/// "agent 17, a truck driven by mobil at 12.3 m/s in road 3, section 0, lane -2".
[[nodiscard]] inline std::string describe(Sim const& world, cb::Slot slot) {
  auto const& agent = world.roster().agents[slot];
  auto const& record = world.frame().agents[slot];
  char speed[40];
  std::snprintf(speed, sizeof speed, "%.1f m/s", record.state.speed);
  auto const lane = agent.road->corridors[record.lane.corridor].lane_at(record.lane.s).lane;
  return "agent " + to_string(agent.id) + ", a " + examples::class_of(agent.shape) + ", " +
         std::visit([](auto const& behavior) { return behavior.name; }, agent.behavior) + ", at " + speed +
         (is_valid(lane) ? " in " + world.map().describe(lane) : " on its way");
}

/// Height of the road below an agent [m]: evaluators know none, and on some maps bridges cross roads.
[[nodiscard]] inline double height(Sim const& world, cb::Slot slot) {
  auto const& at = world.frame().agents[slot].lane;
  auto const place = world.roster().agents[slot].road->corridors[at.corridor].lane_at(at.s);
  if (!is_valid(place.lane)) return 0.0;
  auto const& lane = world.map().lane(place.lane);
  return world.map().road(lane.road).elevation.value(lane.station_at(std::min(place.s, lane.length())));
}

/// How two agents that touch have met.
[[nodiscard]] inline Flaw kind_of_collision(Sim const& world, cb::Slot a, cb::Slot b) {
  auto const walks = [&](cb::Slot slot) { return world.roster().agents[slot].shape == cb::geometry::pedestrian(); };
  if (walks(a) || walks(b)) return Flaw::pedestrian;
  auto const &p = world.frame().agents[a].state, &q = world.frame().agents[b].state;
  double const turn = std::abs(cb::geometry::angle_difference(p.heading, q.heading));
  if (turn > 0.75 * cb::geometry::pi) return Flaw::head_on;
  if (turn > cb::geometry::pi / 6.0) return Flaw::crossing;
  auto const box = cb::box_at(world, a), other = cb::box_at(world, b);
  double const aside = std::abs(-(other.x - box.x) * box.sin + (other.y - box.y) * box.cos);
  return aside < 0.6 * (box.half_width + other.half_width) ? Flaw::rear_end : Flaw::side;
}

/// Looks for flaws after each step, and remembers what it needs for that.
class Inspector {
 public:
  static constexpr double longest_stand = 120.0;  // [s]

  double kilometres = 0.0;  ///< that vehicles have driven

  /// Call it after each step of `dt` [s], before anybody leaves or enters. Takes those that collide out of the world,
  /// so that one collision counts once and traffic goes on.
  void inspect(Sim& world, double dt, std::vector<Finding>& findings) {
    for (cb::Slot slot{}; index_of(slot) < world.size(); ++slot) inspect(world, slot, dt, findings);
    find_collisions(world, findings);
  }

  /// The pairs that the last call found in contact.
  [[nodiscard]] std::vector<cb::AgentId> const& collided() const { return collided_; }

  void remove_collided(Sim& world) {
    std::sort(collided_.begin(), collided_.end());
    collided_.erase(std::unique(collided_.begin(), collided_.end()), collided_.end());
    for (auto const id : collided_) world.remove(id);
    collided_.clear();
  }

  void forget(cb::AgentId id) { seen_.erase(id); }

 private:
  struct Seen {
    double x{}, y{}, heading{}, speed{}, stands = 0.0;
    bool is_new = true;
  };

  static Finding found(Flaw flaw, Sim const& world, cb::Slot slot, std::string const& detail = {}) {
    return {flaw,
            world.frame().step,
            world.time(),
            world.roster().agents[slot].id,
            cb::none<cb::AgentId>,
            describe(world, slot) + detail};
  }

  void inspect(Sim const& world, cb::Slot slot, double dt, std::vector<Finding>& findings) {
    auto const& agent = world.roster().agents[slot];
    auto const& record = world.frame().agents[slot];
    auto const& state = record.state;
    auto& last = seen_[agent.id];
    auto const report = [&](Flaw flaw, std::string const& detail = {}) {
      findings.push_back(found(flaw, world, slot, detail));
    };
    if (record.status == cb::AgentStatus::off_route) report(Flaw::off_route);
    if (record.status == cb::AgentStatus::failed) return report(Flaw::failed);
    bool const walks = agent.shape == cb::geometry::pedestrian();
    double const dx = state.x - last.x, dy = state.y - last.y, way = std::hypot(dx, dy);
    if (!last.is_new) {
      if (!walks) kilometres += 1e-3 * way;
      if (state.speed < -1e-6) report(Flaw::negative);
      auto const along = cb::portable::sin_cos(last.heading);
      if (!walks && dx * along.cos + dy * along.sin < -0.01) report(Flaw::back);
      double const most = std::max(last.speed, state.speed) * dt, least = std::min(last.speed, state.speed) * dt;
      if (!walks && (way > 1.05 * most + 0.1 || way < 0.9 * least - 0.1)) {
        char text[80];
        std::snprintf(text, sizeof text, ": %.2f m in a step, from %.2f m/s", way, last.speed);
        report(Flaw::jump, text);
      }
      bool const had_stood = last.stands > longest_stand;
      last.stands = state.speed < cb::standing_speed ? last.stands + dt : 0.0;
      if (!walks && !had_stood && last.stands > longest_stand) report(Flaw::stand);
    }
    last = {state.x, state.y, state.heading, state.speed, last.stands, false};
  }

  void find_collisions(Sim const& world, std::vector<Finding>& findings) {
    if (!cb::AnyCollision{}(world)) return;
    for (cb::Slot b{}; index_of(b) < world.size(); ++b)
      for (cb::Slot a{}; a < b; ++a) {
        if (!cb::in_traffic(world, a) || !cb::in_traffic(world, b)) continue;
        if (!cb::geometry::intersects(cb::motion_at(world, a), cb::motion_at(world, b))) continue;
        if (std::abs(height(world, a) - height(world, b)) > 3.0) continue;
        auto const flaw = kind_of_collision(world, a, b);
        auto const walks = [&](cb::Slot slot) {
          return world.roster().agents[slot].shape == cb::geometry::pedestrian();
        };
        if (walks(a) && walks(b)) continue;  // they bump into each other
        auto finding = found(flaw, world, a, "; and " + describe(world, b));
        finding.second = world.roster().agents[b].id;
        findings.push_back(finding);
        collided_.push_back(finding.first);
        collided_.push_back(finding.second);
      }
  }

  std::unordered_map<cb::AgentId, Seen> seen_;
  std::vector<cb::AgentId> collided_;
};

}  // namespace soak
