#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/map/fwd.hpp"
#include "cambium/viewer/recording.hpp"
#include "cambium/world/step_result.hpp"

namespace examples {

namespace cb = cambium;

/// An agent as `debug_snapshot` prints it.
struct ThawedAgent {
  std::string id, model, status;
  double x, y, speed, acceleration;

  friend bool operator==(ThawedAgent const&, ThawedAgent const&) = default;
};

/// The world of a snapshot and what its cycle needs, whatever their types.
class Thawed {
 public:
  virtual ~Thawed() = default;
  [[nodiscard]] virtual std::vector<ThawedAgent> agents() const = 0;
  [[nodiscard]] virtual ThawedAgent ego() const = 0;
  /// The ego's behaviour and what it remembers, as JSON without the defaults.
  [[nodiscard]] virtual std::string behavior() const = 0;
  [[nodiscard]] virtual std::string memory() const = 0;
  [[nodiscard]] virtual double time() const = 0;
  [[nodiscard]] virtual double time_step() const = 0;  ///< of the next cycle
  [[nodiscard]] virtual bool ego_drives() const = 0;
  /// What the ego does that it should not: "collides with agent 3"; empty: nothing.
  [[nodiscard]] virtual std::string trouble() = 0;
  /// When the run that the snapshot is of would end [s]; nothing if that is not known.
  [[nodiscard]] virtual std::optional<double> time_limit() const = 0;
  [[nodiscard]] virtual std::uint64_t hash() const = 0;
  /// Reads JSON into the ego's behaviour, or into what it remembers.
  virtual void edit(std::string const& json, bool is_memory) = 0;
  /// One cycle of planning and driving.
  virtual cb::StepResult run() = 0;
  /// What happened from the first call of `film` on.
  virtual void film(std::string const& title) = 0;
  [[nodiscard]] virtual cb::Recording& recording() = 0;
};

/// Throws `ParameterError` at `where` unless the text is one value.
void require_json(std::string const& text, std::string const& where);

/// Restores a snapshot on its map.
using Thaw = std::function<std::unique_ptr<Thawed>(std::shared_ptr<cb::Map const> map, std::string_view bytes,
                                                   std::string const& where)>;

}  // namespace examples
