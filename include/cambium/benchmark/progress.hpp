#pragma once

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>

namespace cambium::inline v0_1 {

/// Progress after `seconds` of work: "120 of 600, 14.2/s, 34 s left".
[[nodiscard]] inline std::string progress_text(std::size_t done, std::size_t total, double seconds) {
  double const rate = static_cast<double>(done) / std::max(seconds, 1e-9);
  double const left = static_cast<double>(total - done) / std::max(rate, 1e-9);
  char text[120], time[40];
  if (left < 120)
    std::snprintf(time, sizeof time, "%.0f s", left);
  else if (left < 7200)
    std::snprintf(time, sizeof time, "%.0f min", left / 60);
  else
    std::snprintf(time, sizeof time, "%.1f h", left / 3600);
  std::snprintf(text, sizeof text, "%zu of %zu, %.3g/s, %s left", done, total, rate, time);
  return text;
}

/// A line on the error stream that shows how far the work is: on a terminal one that changes, elsewhere a new one each
/// minute. One thread at a time calls it.
class ProgressBar {
 public:
  /// `what` stands at the head of the line.
  explicit ProgressBar(std::string what = {}) : what_(std::move(what)) {
#if defined(__unix__) || defined(__APPLE__)
    is_terminal_ = isatty(STDERR_FILENO) == 1;
#endif
  }
  ProgressBar(ProgressBar const&) = delete;
  ProgressBar& operator=(ProgressBar const&) = delete;
  ~ProgressBar() {
    if (is_drawn_) std::fputs("\r\033[K", stderr);
  }

  /// Begins another piece of work.
  void begin(std::string what) {
    what_ = std::move(what);
    begin_ = Clock::now();
  }

  void operator()(std::size_t done, std::size_t total) {
    if (total == 0) return;
    auto const now = Clock::now();
    auto const text = [&] { return progress_text(done, total, std::chrono::duration<double>(now - begin_).count()); };
    if (!is_terminal_) {
      if (now - drawn_at_ < std::chrono::minutes(1)) return;
      drawn_at_ = now;
      std::fprintf(stderr, "  %s: %s\n", what_.c_str(), text().c_str());
      return;
    }
    if (done < total && now - drawn_at_ < std::chrono::milliseconds(200)) return;
    drawn_at_ = now;
    is_drawn_ = true;
    constexpr std::size_t width = 24;
    auto const filled = width * done / total;
    auto const bar = std::string(filled, '#') + std::string(width - filled, '.');
    std::fprintf(stderr, "\r  %s [%s] %s\033[K", what_.c_str(), bar.c_str(), text().c_str());
    std::fflush(stderr);
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::string what_;
  Clock::time_point begin_ = Clock::now(), drawn_at_ = begin_;
  bool is_terminal_ = false, is_drawn_ = false;
};

}  // namespace cambium::inline v0_1
