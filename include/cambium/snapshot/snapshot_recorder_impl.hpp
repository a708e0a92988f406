#pragma once

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <tuple>
#include <utility>

#include "cambium/core/macros.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/snapshot/snapshot_recorder.hpp"

namespace cambium::inline v0_1 {

/// What the recorder and its thread share.
struct SnapshotRecorder::State {
  struct File {
    std::filesystem::path path;
    std::uint64_t number;
    std::uintmax_t bytes;
    std::filesystem::file_time_type written;
  };
  struct Waiting {
    detail::ArchivedParts parts;
    SnapshotOptions options;
  };

  SnapshotRecorderOptions options;
  std::optional<detail::ArchivedParts> before{};  ///< of the cycle under way
  bool is_lost = false;                           ///< the cycle under way could not be saved
  std::chrono::steady_clock::time_point begin{};  ///< of the cycle under way

  std::deque<File> files{};  ///< oldest first; these three are of the thread that writes
  std::uint64_t number = 0;  ///< of the last file
  std::uint64_t bytes = 0;

  mutable std::mutex mutex{};  ///< of the following
  std::string reasons{};
  Outcome outcome{};
  std::deque<Waiting> waiting{};
  bool is_writing = false, is_over = false;
  std::condition_variable changed{};
  std::thread thread{};

  explicit State(SnapshotRecorderOptions given) : options(std::move(given)) {
    if (std::isnan(options.longest_cycle) || std::isnan(options.longest_kept))
      throw SnapshotError("snapshot recorder", "longest_cycle or longest_kept is NaN",
                          "give seconds; infinity: no bound");
    std::error_code problem_there;
    std::filesystem::create_directories(options.folder, problem_there);
    if (!std::filesystem::is_directory(options.folder, problem_there))
      throw SnapshotError("'" + options.folder.string() + "'", "is no folder and cannot be made one",
                          "name a folder that you may write to");
    for (auto const& entry : std::filesystem::directory_iterator(options.folder, problem_there)) adopt(entry.path());
    std::sort(files.begin(), files.end(), [](File const& a, File const& b) {
      return std::tie(a.written, a.number) < std::tie(b.written, b.number);
    });
    for (auto const& file : files) number = std::max(number, file.number);
    if (options.in_background) thread = std::thread([this] { write_all(); });
  }
  ~State() {
    if (!thread.joinable()) return;
    {
      std::lock_guard const lock(mutex);
      is_over = true;
    }
    changed.notify_all();
    thread.join();
  }

  /// Takes over a file of an earlier recorder, or removes what one has not finished, a minute ago or longer.
  void adopt(std::filesystem::path const& path) {
    auto const name = path.filename().string();
    auto const digits = std::min(name.find_first_not_of("0123456789"), name.size());
    auto const rest = name.substr(digits);
    if (digits < 8 || digits > 18 || (rest != ".snapshot" && rest != ".snapshot.part")) return;
    std::error_code refused;
    auto const written_at = std::filesystem::last_write_time(path, refused);
    if (refused) return;
    if (rest != ".snapshot") {
      if (std::filesystem::file_time_type::clock::now() - written_at > std::chrono::minutes(1))
        std::filesystem::remove(path, refused);
      return;
    }
    auto const size = std::filesystem::file_size(path, refused);
    if (refused) return;
    files.push_back({path, std::strtoull(name.c_str(), nullptr, 10), size, written_at});
    bytes += size;
  }

  /// The reasons to keep a cycle that could not be saved are none for the next one.
  void forget_lost() {
    std::lock_guard const lock(mutex);
    if (is_lost) reasons.clear();
    is_lost = false;
  }

  void note_failure(std::string const& why) {
    std::lock_guard const lock(mutex);
    ++outcome.failed;
    outcome.problem = why;
  }

  void take(Waiting snapshot) {
    if (!options.in_background) return write(snapshot);
    {
      std::lock_guard const lock(mutex);
      if (waiting.size() >= options.most_waiting) {
        ++outcome.dropped;
        return;
      }
      waiting.push_back(std::move(snapshot));
    }
    changed.notify_all();
  }

  void write_all() {
    std::unique_lock lock(mutex);
    while (true) {
      changed.wait(lock, [this] { return is_over || !waiting.empty(); });
      if (waiting.empty()) return;
      auto const next = std::move(waiting.front());
      waiting.pop_front();
      is_writing = true;
      lock.unlock();
      write(next);
      lock.lock();
      is_writing = false;
      changed.notify_all();
    }
  }

  void write(Waiting const& snapshot) {
    std::string why;
    try {
      auto const text = detail::with_head(snapshot.parts, snapshot.options);
      auto refused = write_new(text);
      if (is_full(refused)) {
        bool has_room = false;
        while (!has_room && files.size() > 1) has_room = remove_front();
        if (has_room) refused = write_new(text);
      }
      if (refused) throw detail::cannot_write(path_of(number), refused);
      files.push_back({path_of(number), number, text.size(), std::filesystem::file_time_type::clock::now()});
      bytes += text.size();
      remove_oldest();
    } catch (std::exception const& error) {
      why = error.what();
    }
    if (!why.empty()) return note_failure(why);
    std::lock_guard const lock(mutex);
    ++outcome.written;
    outcome.last_file = files.back().path;
  }

  /// The disk has no room, or its owner has used up his share.
  [[nodiscard]] static bool is_full(std::error_code const& refused) {
#ifdef EDQUOT
    if (refused == std::error_code(EDQUOT, std::generic_category())) return true;
#endif
    return refused == std::errc::no_space_on_device;
  }

  [[nodiscard]] std::filesystem::path path_of(std::uint64_t file) const {
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "%08llu.snapshot", static_cast<unsigned long long>(file));
    return options.folder / name.data();
  }

  /// Writes to the next number that no recorder has taken. A part that was not there before is a claim: while one holds
  /// it, nobody else makes the file.
  [[nodiscard]] std::error_code write_new(std::string const& text) {
    while (true) {
      auto const path = path_of(++number);
      std::error_code none;
      if (std::filesystem::exists(path, none)) continue;
      auto part = path;
      part += ".part";
      auto refused = detail::write_text(part, "wbx", text);
      if (refused == std::errc::file_exists) continue;
      bool const is_taken = !refused && std::filesystem::exists(path, none);
      if (!refused && !is_taken) std::filesystem::rename(part, path, refused);
      if (refused || is_taken) std::filesystem::remove(part, none);
      if (!is_taken) return refused;
    }
  }

  void remove_oldest() {
    auto const now = std::filesystem::file_time_type::clock::now();
    while (files.size() > 1 &&
           (files.size() > options.most_files || bytes > options.most_bytes ||
            std::chrono::duration<double>(now - files.front().written).count() > options.longest_kept))
      remove_front();
  }
  /// Whether it was still there.
  bool remove_front() {
    std::error_code ignored;
    bool const was_there = std::filesystem::remove(files.front().path, ignored);
    bytes -= files.front().bytes;
    files.pop_front();
    return was_there;
  }
};

CAMBIUM_COLD SnapshotRecorder::SnapshotRecorder(SnapshotRecorderOptions options)
    : state_(std::make_unique<State>(std::move(options))) {}
CAMBIUM_COLD SnapshotRecorder::SnapshotRecorder(SnapshotRecorder&&) noexcept = default;
CAMBIUM_COLD SnapshotRecorder& SnapshotRecorder::operator=(SnapshotRecorder&&) noexcept = default;
CAMBIUM_COLD SnapshotRecorder::~SnapshotRecorder() = default;

CAMBIUM_COLD void SnapshotRecorder::begin_parts(detail::SceneOfParts const& scene,
                                                std::span<detail::SavedPart const> parts) {
  state_->before.reset();
  state_->is_lost = true;
  try {
    state_->before = detail::archive_parts(state_->options.snapshot.format, scene, parts);
    state_->is_lost = false;
  } catch (std::exception const& error) {
    state_->note_failure(error.what());
  } catch (...) {
    state_->note_failure("a part threw what is no std::exception when it was saved");
  }
  state_->begin = std::chrono::steady_clock::now();
}

CAMBIUM_COLD std::optional<std::uint64_t> SnapshotRecorder::hash_of_results(std::span<detail::SavedPart const> parts) {
  try {
    return detail::hash_of_parts(parts);
  } catch (...) {  // what was before is kept all the same
    return std::nullopt;
  }
}

CAMBIUM_COLD void SnapshotRecorder::trigger(std::string const& reason) {
  constexpr std::size_t longest = 1000;  // of a note: a log may call in each line
  std::lock_guard const lock(state_->mutex);
  auto& reasons = state_->reasons;
  if (reasons.size() < longest) reasons += (reasons.empty() ? "" : "; ") + reason.substr(0, longest);
}

CAMBIUM_COLD bool SnapshotRecorder::is_kept() {
  auto const took = std::chrono::duration<double>(std::chrono::steady_clock::now() - state_->begin).count();
  if (state_->before && took > state_->options.longest_cycle) trigger("it took " + detail::rounded_text(took) + " s");
  for (auto const& watch : state_->options.watches) {
    try {
      if (auto const reason = watch(); !reason.empty()) trigger(reason);
    } catch (std::exception const& error) {
      trigger(std::string("a watch failed: ") + error.what());
    } catch (...) {
      trigger("a watch failed");
    }
  }
  if (!state_->before) {  // there was no `begin`, or it failed
    state_->forget_lost();
    return false;
  }
  std::lock_guard const lock(state_->mutex);
  return state_->options.each_cycle || !state_->reasons.empty();
}

CAMBIUM_COLD void SnapshotRecorder::keep(std::optional<std::uint64_t> result) try {
  if (!state_->before) return state_->forget_lost();
  auto options = state_->options.snapshot;
  {
    std::lock_guard const lock(state_->mutex);
    if (!state_->reasons.empty()) options.note += (options.note.empty() ? "" : ": ") + state_->reasons;
    state_->reasons.clear();
  }
  options.result = result;
  state_->take({std::move(*state_->before), std::move(options)});
  state_->before.reset();
} catch (std::exception const& error) {  // of memory; the cycle's own exception passes
  state_->before.reset();
  state_->note_failure(error.what());
}

CAMBIUM_COLD void SnapshotRecorder::discard() { state_->before.reset(); }

CAMBIUM_COLD void SnapshotRecorder::flush() {
  std::unique_lock lock(state_->mutex);
  state_->changed.wait(lock, [this] { return state_->waiting.empty() && !state_->is_writing; });
}

CAMBIUM_COLD SnapshotRecorder::Outcome SnapshotRecorder::outcome() const {
  std::lock_guard const lock(state_->mutex);
  return state_->outcome;
}

}  // namespace cambium::inline v0_1
