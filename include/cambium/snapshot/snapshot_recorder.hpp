#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "cambium/snapshot/snapshot.hpp"
#include "cambium/world/step_result.hpp"

namespace cambium::inline v0_1 {

/// When and where a `SnapshotRecorder` writes.
struct SnapshotRecorderOptions {
  std::filesystem::path folder{};  ///< of the files 00000001.snapshot, ...; is made if it is not there
  SnapshotOptions snapshot{};      ///< of each file; the recorder adds to the note why it was taken, and the result
  bool each_cycle = false;         ///< keeps every cycle, not only those with a reason
  /// A cycle that takes longer is a reason [s].
  double longest_cycle = std::numeric_limits<double>::infinity();
  /// Asked after each cycle: a text is a reason, such as a collision or a traffic rule that was broken; and so is an
  /// exception.
  std::vector<std::function<std::string()>> watches{};
  std::size_t most_files = 10'000;                    ///< beyond, the oldest files go; on a full disk, too
  std::uint64_t most_bytes = std::uint64_t{1} << 30;  ///< likewise
  /// Files written longer ago go [s].
  double longest_kept = std::numeric_limits<double>::infinity();
  bool in_background = false;      ///< writes on a thread of its own: a cycle never waits for the disk
  std::size_t most_waiting = 256;  ///< snapshots that wait for that thread; beyond, new ones are dropped and counted
};

/// Keeps the state from just before a cycle of planning or simulation, if there turns out to be a reason: an exception,
/// an invalid step, a cycle that takes too long, a watch, or whatever calls `trigger`, such as a log for errors. The
/// files survive the end of the process; a failure to save or to write is counted, never thrown. Its functions but
/// `trigger` are for one thread.
class SnapshotRecorder {
 public:
  /// Throws `SnapshotError` if the folder cannot be made, or a bound is NaN. Numbers go on behind the files that are
  /// there, which count as its own: the bounds hold for all. Several recorders may write to one folder.
  explicit SnapshotRecorder(SnapshotRecorderOptions options);
  SnapshotRecorder(SnapshotRecorder&&) noexcept;
  SnapshotRecorder& operator=(SnapshotRecorder&&) noexcept;
  /// Writes what waits.
  ~SnapshotRecorder();

  /// Runs `cycle` and keeps the state of `parts` before it if there is a reason; a `StepResult` that it returns is one
  /// if the step was invalid. Returns what `cycle` returns; lets its exceptions pass. The state of `parts` after it is
  /// the result that a repetition is compared with. O(bytes of the parts), twice if it is kept.
  template <class Cycle, class... Parts>
  auto run(Cycle&& cycle, Parts const&... parts) {
    begin(parts...);
    if constexpr (std::is_void_v<std::invoke_result_t<Cycle&>>) {
      guarded(cycle);
      end(parts...);
    } else {
      auto returned = guarded(cycle);
      if constexpr (std::is_same_v<decltype(returned), StepResult>)
        if (!returned) trigger(to_string(returned.problem));
      end(parts...);
      return returned;
    }
  }

  /// The same in parts, for cycles that are no function: `begin`, the cycle, `end`.
  template <class... Parts>
  void begin(Parts const&... parts) {
    std::array const saved{detail::saved_part(parts)...};
    begin_parts(detail::scene_of(parts...), saved);
  }
  /// `results`: parts as they are after the cycle, to compare a repetition with; none: there is nothing to compare.
  template <class... Results>
  void end(Results const&... results) {
    if (!is_kept()) return discard();
    std::optional<std::uint64_t> result;
    if constexpr (sizeof...(Results) > 0) {
      std::array const saved{detail::saved_part(results)...};
      result = hash_of_results(saved);
    }
    keep(result);
  }

  /// A reason to keep the cycle under way, or if there is none, the next one. From any thread.
  void trigger(std::string const& reason);

  /// Waits until everything is written.
  void flush();

  /// Numbers of snapshots written; dropped because too many waited; and failed: a part threw when it was saved, whether
  /// or not the cycle had a reason, or the disk took no more.
  [[nodiscard]] std::size_t written() const { return outcome().written; }
  [[nodiscard]] std::size_t dropped() const { return outcome().dropped; }
  [[nodiscard]] std::size_t failed() const { return outcome().failed; }
  /// Why the last one was not written; empty if there is none.
  [[nodiscard]] std::string problem() const { return outcome().problem; }
  /// The file that was written last; empty if there is none.
  [[nodiscard]] std::filesystem::path last_file() const { return outcome().last_file; }

 private:
  struct State;
  struct Outcome {
    std::size_t written = 0, dropped = 0, failed = 0;
    std::string problem{};
    std::filesystem::path last_file{};
  };
  [[nodiscard]] Outcome outcome() const;

  /// Runs the cycle; after an exception the state before it is kept, and nobody is asked any more.
  template <class Cycle>
  auto guarded(Cycle& cycle) {
    try {
      return cycle();
    } catch (std::exception const& error) {
      trigger(std::string("exception: ") + error.what());
      keep({});
      throw;
    } catch (...) {
      trigger("exception");
      keep({});
      throw;
    }
  }
  void begin_parts(detail::SceneOfParts const& scene, std::span<detail::SavedPart const> parts);
  [[nodiscard]] bool is_kept();
  [[nodiscard]] std::optional<std::uint64_t> hash_of_results(std::span<detail::SavedPart const> parts);
  void keep(std::optional<std::uint64_t> result);
  void discard();

  std::unique_ptr<State> state_;
};

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/snapshot/snapshot_recorder_impl.hpp"
#endif
