#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/core/type_info.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/off_road.hpp"
#include "cambium/snapshot/snapshot.hpp"
#include "cambium/viewer/record_world.hpp"
#include "cambium/world/world.hpp"

#include "thawed.hpp"

namespace examples {

/// Reads JSON into a described struct. Throws `ParameterError` at "the ego".
void read_edit(cb::TypeInfo const& type, void* object, std::string const& json);

/// A described struct as JSON without its defaults. Throws `Error` for NaN.
[[nodiscard]] std::string difference(cb::TypeInfo const& type, void const* object);

/// `Cycle` is the second part of the snapshot, with `ego`, `time_step`, and perhaps `late`, by how much this cycle
/// takes longer.
template <class World, class Cycle>
class ThawedWorld final : public Thawed {
 public:
  ThawedWorld(std::shared_ptr<cb::Map const> map, std::string_view bytes, std::string const& where)
      : world_(std::move(map)) {
    cb::from_snapshot(bytes, where, world_, cycle_);
    if (!world_.roster().slot_of(cycle_.ego))
      throw cb::SnapshotError(where, "has no agent " + to_string(cycle_.ego), "give one whose ego is in its world");
  }

  [[nodiscard]] std::vector<ThawedAgent> agents() const override {
    std::vector<ThawedAgent> all;
    for (cb::Slot slot{}; cb::index_of(slot) < world_.size(); ++slot) all.push_back(agent(slot));
    return all;
  }
  [[nodiscard]] ThawedAgent ego() const override { return agent(slot()); }
  [[nodiscard]] std::string behavior() const override {
    return record().behavior.visit([](auto const& model) { return json_of(model); });
  }
  [[nodiscard]] std::string memory() const override {
    return std::visit([](auto const& memory) { return json_of(memory); }, world_.record(cycle_.ego).memory);
  }
  [[nodiscard]] double time() const override { return world_.time(); }
  [[nodiscard]] double time_step() const override {
    if constexpr (requires { cycle_.late; })
      return cycle_.time_step + cycle_.late;
    else
      return cycle_.time_step;
  }
  [[nodiscard]] bool ego_drives() const override {
    auto const status = world_.status(cycle_.ego);
    return status == cb::AgentStatus::driving || status == cb::AgentStatus::not_started;
  }
  [[nodiscard]] std::string trouble() override {
    if (auto const contact = cb::Collision{}.contact(world_, slot()))
      return "collides with " + (cb::is_valid(contact->agent) ? "agent " + to_string(contact->agent)
                                                              : "object " + to_string(contact->object));
    return cb::OffRoad{}(world_, slot()) ? "is not on the road" : "";
  }
  [[nodiscard]] std::optional<double> time_limit() const override {
    if constexpr (requires { cycle_.time_limit; })
      return cycle_.time_limit;
    else
      return std::nullopt;
  }
  [[nodiscard]] std::uint64_t hash() const override { return cb::snapshot_hash(world_); }

  void edit(std::string const& json, bool is_memory) override {
    auto memory = world_.record(cycle_.ego).memory;
    auto behavior = record().behavior;
    auto const read = [&]<class Model>(Model& model) {
      Model edited = model;
      read_edit(cb::type_info<Model>(), &edited, json);
      if (is_in_range(model)) cb::check_parameters(edited, "the ego");
      model = std::move(edited);
    };
    if (is_memory) {
      std::visit(read, memory);
    } else {
      std::visit(read, static_cast<typename World::Behavior::variant&>(behavior));
      world_.set_behavior(cycle_.ego, behavior);
    }
    auto frame = world_.frame();
    frame.agents[slot()].memory = memory;  // what it remembers stays
    world_.restore(frame);
    try {
      cb::from_snapshot(cb::to_snapshot({}, world_), "the edited world", world_);  // checks what the agent remembers
    } catch (cb::SnapshotError const& problem) {
      std::string const what = problem.what();
      throw cb::ParameterError("", what.substr(0, what.find(';')), "give a value that fits its road");
    }
  }

  cb::StepResult run() override {
    auto const result = world_.step(time_step());
    if constexpr (requires { cycle_.late; }) cycle_.late = 0.0;  // the next ones come in time
    if (film_) film_->record(world_);
    return result;
  }

  void film(std::string const& title) override {
    film_.emplace(world_, title);
    film_->show_as(cycle_.ego, cb::RecordedAgentKind::ego);
  }
  [[nodiscard]] cb::Recording& recording() override { return film_.value().recording(); }

 private:
  template <class Model>
  [[nodiscard]] static std::string json_of(Model const& model) {
    try {
      return difference(cb::type_info<Model>(), &model);
    } catch (cb::Error const&) {  // JSON has no NaN
      return cb::to_string(model) + "\n";
    }
  }
  /// Whether an edit may be held to the ranges: a planner that went wrong may remember NaN.
  template <class Model>
  [[nodiscard]] static bool is_in_range(Model const& model) {
    try {
      cb::check_parameters(model);
    } catch (cb::Error const&) {
      return false;
    }
    return true;
  }
  [[nodiscard]] cb::Slot slot() const { return world_.slot_of(cycle_.ego); }
  [[nodiscard]] auto const& record() const { return world_.roster().agents[slot()]; }
  [[nodiscard]] ThawedAgent agent(cb::Slot slot) const {
    auto const& agent = world_.roster().agents[slot];
    auto const& record = world_.frame().agents[slot];
    return {to_string(agent.id),
            agent.behavior.visit([]<class B>(B const&) { return std::string(B::name); }),
            to_string(record.status),
            record.state.x,
            record.state.y,
            record.state.speed,
            double{record.acceleration}};
  }

  World world_;
  Cycle cycle_{};
  std::optional<cb::WorldRecorder> film_{};
};

template <class World, class Cycle>
[[nodiscard]] std::unique_ptr<Thawed> thaw(std::shared_ptr<cb::Map const> map, std::string_view bytes,
                                           std::string const& where) {
  return std::make_unique<ThawedWorld<World, Cycle>>(std::move(map), bytes, where);
}

}  // namespace examples
