#include "on_threads.hpp"

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace examples {

std::string progress_text(std::uint64_t done, std::uint64_t total, double seconds) {
  double const rate = static_cast<double>(done) / std::max(seconds, 1e-9);
  auto const left = static_cast<unsigned long long>(static_cast<double>(total - done) / std::max(rate, 1e-9) + 0.5);
  char text[120], time[40];
  if (left < 120)
    std::snprintf(time, sizeof time, "%llu s", left);
  else if (left < 7200)
    std::snprintf(time, sizeof time, "%llu min", (left + 30) / 60);
  else
    std::snprintf(time, sizeof time, "%.1f h", static_cast<double>(left) / 3600.0);
  std::snprintf(text, sizeof text, "  %llu of %llu, %.3g/s, %s left", static_cast<unsigned long long>(done),
                static_cast<unsigned long long>(total), rate, time);
  return text;
}

Progress::Progress(std::uint64_t total, std::string what)
    : total_(total), what_(std::move(what)), shown_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (!drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

void Progress::advance() {
  auto const done = ++done_;
  if (!shown_ || done == total_) return;
  std::unique_lock const lock(mutex_, std::try_to_lock);
  auto const now = Clock::now();
  if (!lock || now - shown_at_ < std::chrono::milliseconds(200)) return;
  shown_at_ = now;
  drawn_ = true;
  auto const line = what_ + progress_text(done, total_, std::chrono::duration<double>(now - begin_).count());
  std::fprintf(stderr, "\r%s\033[K", line.c_str());
  std::fflush(stderr);
}

}  // namespace examples
