#pragma once

#include <fcntl.h>
#include <poll.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "cambium/benchmark/detail/outcome_bytes.hpp"
#include "cambium/benchmark/executor.hpp"
#include "cambium/core/error.hpp"

namespace cambium::inline v0_1::detail {

/// A forked copy of this process that runs jobs, so that a job that crashes or never ends costs nothing else. It ends
/// with this process; on systems other than Linux, once its job has ended.
class JobProcess {
 public:
  /// `limit`: a job that takes longer is ended [s].
  JobProcess(Executor::Run run, double limit) : run_(std::move(run)), limit_(limit) {}
  JobProcess(JobProcess const&) = delete;
  JobProcess& operator=(JobProcess const&) = delete;
  ~JobProcess() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    static_cast<void>(end());
  }

  [[nodiscard]] bool is_busy() const { return is_busy_; }
  [[nodiscard]] std::size_t job() const { return job_; }
  /// For `poll`: ready to be read when `wait` has something to do.
  [[nodiscard]] int socket() const { return socket_; }

  /// Precondition: not busy. Throws `Error` if the system gives no process.
  void start(std::size_t job) {
    job_ = job;
    is_busy_ = true;
    deaths_ = 0;
    send_job();
  }

  /// Waits up to `milliseconds` for the outcome of the job; returns its bytes once it is complete. A job whose process
  /// dies is run once more, because something else may have killed it; a second death is the job's error.
  [[nodiscard]] std::optional<std::string> wait(int milliseconds) {
    pollfd ready{socket_, POLLIN, 0};
    if (poll(&ready, is_busy_ ? 1 : 0, milliseconds) <= 0) {
      if (!is_busy_ || std::chrono::duration<double>(Clock::now() - begin_).count() <= limit_) return std::nullopt;
      kill(pid_, SIGKILL);
      static_cast<void>(end());
      return failed(": it was ended after " + rounded_text(limit_) + " s, in which it gave no result");
    }
    char buffer[1 << 16];
    auto const count = read(socket_, buffer, sizeof buffer);
    if (count > 0) {
      bytes_.append(buffer, static_cast<std::size_t>(count));
      std::uint64_t length = 0;
      if (bytes_.size() < sizeof length) return std::nullopt;
      std::memcpy(&length, bytes_.data(), sizeof length);
      if (bytes_.size() < sizeof length + length) return std::nullopt;
      is_busy_ = false;
      return std::exchange(bytes_, {}).substr(sizeof length);
    }
    if (count < 0 && errno == EINTR) return std::nullopt;
    auto const death = end();
    if (++deaths_ < 2) {
      send_job();
      return std::nullopt;
    }
    return failed(", twice: " + death);
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// A number as 8 bytes of this machine.
  [[nodiscard]] static std::string_view bytes_of(std::uint64_t const& number) {
    return {reinterpret_cast<char const*>(&number), sizeof number};
  }

  [[nodiscard]] std::string failed(std::string const& how) {
    is_busy_ = false;
    JobOutcome outcome;
    outcome.result.error = "the process that ran it died" + how;
    outcome.result.error_kind = RunErrorKind::process_died;
    return outcome_bytes(outcome);
  }

  void send_job() {
    begin_ = Clock::now();
    if (pid_ <= 0) fork_child();
    static_cast<void>(send_all(socket_, bytes_of(job_)));  // if it has died, `wait` finds that out
  }

  void fork_child() {
    bytes_.clear();
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) fail();
    auto const parent = getpid();
    for (int const end : ends) fcntl(end, F_SETFD, FD_CLOEXEC);  // else a program that a planner starts keeps it open
#ifdef SO_NOSIGPIPE
    int const yes = 1;
    for (int const end : ends) setsockopt(end, SOL_SOCKET, SO_NOSIGPIPE, &yes, sizeof yes);
#endif
    std::fflush(nullptr);  // else the child writes it, too
    pid_ = fork();
    if (pid_ < 0) {
      for (int const end : ends) close(end);
      fail();
    }
    close(ends[pid_ == 0 ? 0 : 1]);
    if (pid_ == 0) {
#ifdef __linux__
      prctl(PR_SET_PDEATHSIG, SIGKILL);  // also in the middle of a job
      if (getppid() != parent) _exit(0);
#endif
      work(ends[1]);
    }
    socket_ = ends[0];
  }

  [[noreturn]] static void fail() {
    throw Error("process for jobs", std::string("cannot be made (") + std::strerror(errno) + ")",
                "run fewer processes on this machine");
  }

  [[noreturn]] void work(int socket) const {
    for (int const end : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGINT}) std::signal(end, SIG_DFL);
    for (;;) {
      std::uint64_t job = 0;
      if (recv(socket, &job, sizeof job, MSG_WAITALL) != sizeof job) _exit(0);
      std::string bytes;
      try {
        auto const outcome = outcome_bytes(run_(static_cast<std::size_t>(job)));
        bytes = std::string(bytes_of(outcome.size())) + outcome;
      } catch (...) {
        std::fflush(nullptr);
        _exit(70);
      }
      std::fflush(nullptr);
      if (!send_all(socket, bytes)) _exit(0);
    }
  }

  [[nodiscard]] static bool send_all(int socket, std::string_view bytes) {
    while (!bytes.empty()) {
#ifdef MSG_NOSIGNAL
      auto const sent = send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
#else
      auto const sent = send(socket, bytes.data(), bytes.size(), 0);
#endif
      if (sent < 0 && errno == EINTR) continue;
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }

  /// Ends the child; returns the cause of death.
  [[nodiscard]] std::string end() {
    int status = 0;
    close(socket_);
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = 0;
    socket_ = -1;
    if (!WIFSIGNALED(status)) return "exit code " + std::to_string(WEXITSTATUS(status));
    return "signal " + std::to_string(WTERMSIG(status)) + " (" + strsignal(WTERMSIG(status)) + ")";
  }

  Executor::Run run_;
  double limit_;
  Clock::time_point begin_{};
  pid_t pid_ = 0;
  int socket_ = -1;
  bool is_busy_ = false;
  std::size_t job_ = 0;
  int deaths_ = 0;
  std::string bytes_;  ///< of the answer, so far
};

}  // namespace cambium::inline v0_1::detail
