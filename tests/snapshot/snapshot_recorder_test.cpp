// When a recorder keeps a cycle, and what is left of its files.
#include "cambium/snapshot.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#ifdef __unix__
#include <csignal>
#include <sys/wait.h>
#include <unistd.h>
#endif
#ifdef __linux__
#include <sched.h>
#include <sys/mount.h>
#endif

#include "cambium/cambium.hpp"
#include "support/maps.hpp"

using namespace cambium;
namespace fs = std::filesystem;

namespace {

using Sim = World<BehaviorSet<IdmClassic>, InterpolateExecution, SingleTrack>;

/// An empty folder of that name.
fs::path folder(std::string const& name) {
  auto const path = fs::path(CAMBIUM_BUILD_DIR) / "snapshot_recorder" / name;
  fs::remove_all(path);
  return path;
}

std::vector<fs::path> files_in(fs::path const& folder) {
  std::vector<fs::path> files;
  for (auto const& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

Sim one_car() {
  Sim world(support::straight_road(1, 3000.0), {.seed = 1});
  world.add({.position = {20, -1.75}, .speed = 5, .behavior = IdmClassic{}});
  return world;
}

SnapshotInfo info_of(fs::path const& file) { return snapshot_info(read_snapshot_file(file.string()), file.string()); }

}  // namespace

TEST_CASE("without a reason nothing is kept; a trigger keeps the state before the cycle, and its result") {
  auto const where = folder("trigger");
  SnapshotRecorder recorder({.folder = where, .snapshot = {.note = "test drive"}});
  auto world = one_car();
  for (int i = 0; i < 5; ++i) REQUIRE(recorder.run([&] { return world.step(0.2); }, world));
  CHECK(files_in(where).empty());
  auto const before = world;
  CHECK(recorder.run(
      [&] {
        recorder.trigger("the driver asked");
        recorder.trigger("twice");
        return world.step(0.2);
      },
      world));
  REQUIRE(files_in(where) == std::vector{where / "00000001.snapshot"});
  CHECK(recorder.last_file() == where / "00000001.snapshot");
  CHECK(recorder.written() == 1);
  auto const info = info_of(recorder.last_file());
  CHECK(info.note == "test drive: the driver asked; twice");
  CHECK(info.time == before.time());
  CHECK(info.result == snapshot_hash(world));
  auto thawed = Sim(world.shared_map());
  load_snapshot(recorder.last_file().string(), thawed);
  CHECK(thawed.frame() == before.frame());
  REQUIRE(thawed.step(0.2));
  CHECK(snapshot_hash(thawed) == info.result);
  REQUIRE(recorder.run([&] { return world.step(0.2); }, world));
  CHECK(files_in(where).size() == 1);
}

TEST_CASE("exceptions, invalid steps, slow cycles and watches are reasons") {
  auto const where = folder("reasons");
  bool collides = false;
  SnapshotRecorder recorder({.folder = where,
                             .longest_cycle = 10.0,
                             .watches = {[&] { return collides ? std::string("a collision") : std::string(); }}});
  auto world = one_car();
  CHECK_THROWS_AS(recorder.run([&] { throw std::runtime_error("no path"); }, world), std::runtime_error);
  CHECK(info_of(where / "00000001.snapshot").note == "exception: no path");
  CHECK_FALSE(info_of(where / "00000001.snapshot").result);
  CHECK_FALSE(recorder.run([&] { return world.step(-1.0); }, world));
  CHECK(info_of(where / "00000002.snapshot").note == to_string(StepProblem::bad_duration));
  collides = true;
  CHECK(recorder.run([] { return 7; }, world) == 7);
  CHECK(info_of(where / "00000003.snapshot").note == "a collision");
  collides = false;
  SnapshotRecorder hasty({.folder = where, .longest_cycle = 0.0});
  hasty.run([&] { static_cast<void>(world.step(0.2)); }, world);
  CHECK(info_of(where / "00000004.snapshot").note.find("it took ") == 0);  // numbers go on
  recorder.begin(world);
  recorder.trigger("in parts");
  for (int i = 0; i < 100; ++i) recorder.trigger(std::string(700, 'x'));
  recorder.end();
  CHECK(files_in(where).size() == 5);  // the file of another recorder there stays
  CHECK(info_of(where / "00000005.snapshot").note.find("in parts; xxx") == 0);
  CHECK(info_of(where / "00000005.snapshot").note.size() < 2100);
}

TEST_CASE("a watch that throws is a reason; after an exception of the cycle none is asked") {
  auto const where = folder("watches");
  int asked = 0;
  SnapshotRecorder recorder({.folder = where, .watches = {[&]() -> std::string {
                                                ++asked;
                                                throw std::runtime_error("no ego");
                                              }}});
  auto world = one_car();
  REQUIRE(recorder.run([&] { return world.step(0.2); }, world));
  CHECK(info_of(where / "00000001.snapshot").note == "a watch failed: no ego");
  CHECK_THROWS_WITH(recorder.run([&] { throw std::runtime_error("no path"); }, world), "no path");
  CHECK(info_of(where / "00000002.snapshot").note == "exception: no path");
  CHECK(asked == 1);
  recorder.trigger("twice");
  recorder.end();  // without `begin`
  CHECK(recorder.written() == 2);
}

TEST_CASE("a cycle in two halves that takes too long is kept") {
  auto const where = folder("overrun");
  SnapshotRecorder recorder({.folder = where, .longest_cycle = 0.01});
  auto const world = one_car();
  recorder.begin(world);
  std::this_thread::sleep_for(std::chrono::milliseconds(15));
  recorder.end(world);
  REQUIRE(recorder.written() == 1);
  CHECK(info_of(recorder.last_file()).note.starts_with("it took "));
  SnapshotRecorder patient({.folder = where, .longest_cycle = 1000.0});
  patient.begin(world);
  patient.end(world);
  CHECK(patient.last_file().empty());
  double const nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(SnapshotRecorder({.folder = where, .longest_cycle = nan}), SnapshotError);
  CHECK_THROWS_AS(SnapshotRecorder({.folder = where, .longest_kept = nan}), SnapshotError);
}

TEST_CASE("recorders that share a folder lose nothing") {
  auto const where = folder("together");
  constexpr std::size_t each = 200, recorders = 3;
  std::vector<std::thread> threads;
  std::array<std::size_t, recorders> written{};
  for (std::size_t k = 0; k < recorders; ++k)
    threads.emplace_back([&, k] {
      auto world = one_car();
      SnapshotRecorder recorder({.folder = where, .each_cycle = true, .in_background = k == 0});
      for (std::size_t i = 0; i < each; ++i) {
        static_cast<void>(recorder.run([&] { return world.step(0.001); }, world));
        if (i % 100 == 0) recorder.flush();
      }
      recorder.flush();
      written[k] = recorder.written();
    });
  for (auto& thread : threads) thread.join();
  CHECK(written == std::array{each, each, each});
  CHECK(files_in(where).size() == recorders * each);
  for (auto const& file : files_in(where)) CHECK_NOTHROW(static_cast<void>(info_of(file)));
}

TEST_CASE("flush waits for the file that is being written") {
  auto const where = folder("flush");
  auto world = one_car();
  SnapshotRecorder recorder({.folder = where,
                             .snapshot = {.map_text = std::string(std::size_t{1} << 25, 'x')},
                             .each_cycle = true,
                             .in_background = true});
  for (std::size_t i = 1; i <= 3; ++i) {
    REQUIRE(recorder.run([&] { return world.step(0.2); }, world));
    while (files_in(where).size() < i) std::this_thread::yield();  // it has begun
    recorder.flush();
    CHECK(recorder.written() == i);
  }
  CHECK(files_in(where).back() == where / "00000003.snapshot");
}

TEST_CASE("files of others in its folder stay as they are; what an earlier recorder left unfinished goes") {
  auto const where = folder("shared");
  fs::create_directories(where);
  for (char const* name : {"merge_bug.snapshot", "7.snapshot", "00000012.snapshot", "00000013.snapshot.part"})
    std::ofstream(where / name) << "mine";
  std::ofstream(where / "00000014.snapshot.part") << "of a recorder that is at it";
  fs::last_write_time(where / "00000013.snapshot.part", fs::file_time_type::clock::now() - std::chrono::minutes(2));
  SnapshotRecorder recorder({.folder = where, .each_cycle = true, .most_files = 1});
  auto world = one_car();
  REQUIRE(recorder.run([&] { return world.step(0.2); }, world));
  REQUIRE(recorder.run([&] { return world.step(0.2); }, world));
  CHECK(files_in(where) == std::vector{where / "00000014.snapshot.part", where / "00000015.snapshot",
                                       where / "7.snapshot", where / "merge_bug.snapshot"});
}

TEST_CASE("each cycle is kept in a ring that number, bytes and age bound") {
  auto const where = folder("ring");
  auto world = one_car();
  {
    SnapshotRecorder recorder({.folder = where, .each_cycle = true, .most_files = 5, .in_background = true});
    for (int i = 0; i < 40; ++i) {
      REQUIRE(recorder.run([&] { return world.step(0.2); }, world));
      recorder.flush();
    }
    CHECK(recorder.written() == 40);
  }
  CHECK(files_in(where).size() == 5);
  CHECK(files_in(where).front() == where / "00000036.snapshot");
  auto const size = fs::file_size(where / "00000036.snapshot");
  {
    SnapshotRecorder recorder({.folder = where, .each_cycle = true, .most_bytes = 3 * size + 100});
    REQUIRE(recorder.run([&] { return world.step(0.2); }, world));
    CHECK(files_in(where).back() == where / "00000041.snapshot");
    CHECK(files_in(where).size() == 3);
  }
  fs::last_write_time(where / "00000041.snapshot", fs::file_time_type::clock::now() - std::chrono::minutes(2));
  {
    SnapshotRecorder recorder({.folder = where, .each_cycle = true, .most_files = 3});
    REQUIRE(recorder.run([&] { return world.step(0.2); }, world));
    CHECK_FALSE(fs::exists(where / "00000041.snapshot"));  // the oldest, whatever its number
    CHECK(fs::exists(where / "00000040.snapshot"));
  }
  SnapshotRecorder recorder({.folder = where, .each_cycle = true, .longest_kept = 0.0});
  REQUIRE(recorder.run([&] { return world.step(0.2); }, world));
  CHECK(files_in(where) == std::vector{where / "00000043.snapshot"});
}

TEST_CASE("a queue that is full is counted, and the cycles go on") {
  auto world = one_car();
  SnapshotRecorder none({.folder = folder("none"), .each_cycle = true, .in_background = true, .most_waiting = 0});
  REQUIRE(none.run([&] { return world.step(0.2); }, world));
  CHECK(none.dropped() == 1);
  CHECK_THROWS_AS(SnapshotRecorder({.folder = "/proc/none"}), SnapshotError);
}

namespace {

/// A component that cannot always be saved.
struct Moody {
  bool throws = false;
  int value = 0;
  template <class Archive>
  void serialize(Archive& archive, unsigned) {
    if (throws) throw std::runtime_error("not now");
    archive& value;
  }
};

}  // namespace

TEST_CASE("a part that cannot be saved is counted, and the cycle runs") {
  auto const where = folder("moody");
  SnapshotRecorder recorder({.folder = where, .each_cycle = true, .watches = {[]() -> std::string { throw 7; }}});
  Moody moody{.throws = true};
  recorder.run([&] { ++moody.value; }, moody);
  CHECK(moody.value == 1);
  CHECK(recorder.failed() == 1);
  CHECK(recorder.problem() == "not now");
  CHECK(files_in(where).empty());
  moody.throws = false;
  recorder.run([&] { moody.throws = true; }, moody);
  CHECK(recorder.written() == 1);
  auto const info = info_of(recorder.last_file());
  CHECK_FALSE(info.result);  // what came out could not be saved
  CHECK(info.note.find("a watch failed") != std::string::npos);
}

TEST_CASE("reasons to keep a cycle that could not be saved are none for the next one") {
  auto const where = folder("lost");
  SnapshotRecorder recorder({.folder = where});
  Moody moody{.throws = true};
  recorder.run(
      [&] {
        recorder.trigger("of the first");
        moody.throws = false;
      },
      moody);
  recorder.run([] {}, moody);
  CHECK(recorder.failed() == 1);
  CHECK(recorder.written() == 0);
  moody.throws = true;
  CHECK_THROWS(recorder.run([] { throw std::runtime_error("boom"); }, moody));
  moody.throws = false;
  recorder.run([] {}, moody);
  CHECK(recorder.written() == 0);
  // A reason between two cycles is kept with the next one, even if an end comes without its begin.
  moody.throws = true;
  recorder.begin(moody);
  recorder.end(moody);
  recorder.trigger("between");
  recorder.end(moody);
  moody.throws = false;
  recorder.begin(moody);
  recorder.end(moody);
  REQUIRE(recorder.written() == 1);
  CHECK(info_of(recorder.last_file()).note == "between");
}

TEST_CASE("a log of another thread may trigger") {
  auto const where = folder("threads");
  SnapshotRecorder recorder({.folder = where, .in_background = true});
  auto world = one_car();
  std::atomic<bool> is_over = false;
  std::thread log([&] {
    while (!is_over) recorder.trigger("error");
  });
  int cycles = 0;
  for (; recorder.written() < 20; ++cycles) REQUIRE(recorder.run([&] { return world.step(0.001); }, world));
  is_over = true;
  log.join();
  recorder.flush();
  CHECK(recorder.written() + recorder.dropped() <= static_cast<std::size_t>(cycles));
  for (auto const& file : files_in(where)) CHECK(info_of(file).note.starts_with("error"));
}

#ifdef __linux__
TEST_CASE("on a full disk the oldest file makes room; what finds none is counted, and the cycles go on") {
  auto const where = folder("full");
  fs::create_directories(where);
  enum Exit { passed, failed, no_disk };
  auto const child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {  // a disk of four pages, for this process alone
    if (unshare(CLONE_NEWNS | (geteuid() != 0 ? CLONE_NEWUSER : 0)) != 0 ||
        mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        mount("tmpfs", where.c_str(), "tmpfs", 0, "size=16k") != 0)
      _exit(no_disk);
    auto world = one_car();
    SnapshotRecorder recorder({.folder = where, .each_cycle = true});
    for (int i = 0; i < 20; ++i) static_cast<void>(recorder.run([&] { return world.step(0.2); }, world));
    bool const has_newest = recorder.written() == 20 && recorder.failed() == 0 && files_in(where).size() == 4 &&
                            info_of(recorder.last_file()).result == snapshot_hash(world);
    auto const old = files_in(where);
    fs::remove(old[0]);  // so the next one has to go instead
    std::ofstream(where / "in its place") << std::string(4096, 'x');
    static_cast<void>(recorder.run([&] { return world.step(0.2); }, world));
    bool const has_next = recorder.written() == 21 && !fs::exists(old[1]) && fs::exists(old[2]);
    for (auto const& file : files_in(where)) fs::remove(file);
    std::ofstream(where / "of somebody else") << std::string(16'384, 'x');
    SnapshotRecorder crowded({.folder = where, .each_cycle = true});
    bool const drives = static_cast<bool>(crowded.run([&] { return world.step(0.2); }, world));
    bool const is_counted =
        crowded.failed() == 1 && crowded.written() == 0 &&
        crowded.problem().find("00000001.snapshot: cannot be written (No space left") != std::string::npos;
    _exit(has_newest && has_next && drives && is_counted ? passed : failed);
  }
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFEXITED(status));
  if (WEXITSTATUS(status) == no_disk)
    MESSAGE("skipped: this user may not mount a disk");
  else
    CHECK(WEXITSTATUS(status) == passed);
}
#endif

#ifdef __unix__
TEST_CASE("after a kill, all files but perhaps the last are whole") {
  auto const where = folder("killed");
  auto const child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    auto world = one_car();
    SnapshotRecorder recorder({.folder = where, .each_cycle = true, .most_files = 50});
    while (true) static_cast<void>(recorder.run([&] { return world.step(0.001); }, world));
  }
  for (int i = 0; i < 1000 && (!fs::exists(where) || files_in(where).size() < 50); ++i) usleep(10'000);
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  std::size_t whole = 0;
  for (auto const& file : files_in(where))
    if (file.extension() == ".snapshot") {
      CHECK_NOTHROW(static_cast<void>(info_of(file)));
      ++whole;
    }
  CHECK(whole >= 49);
}
#endif
