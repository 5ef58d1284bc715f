// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "terminal_progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

#include "interrupt.hpp"

namespace tofsmith::apps {

namespace {

using Clock = std::chrono::steady_clock;

std::string duration_text(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

/// One column less than the terminal has, at most 100.
std::size_t line_width() {
  constexpr std::size_t widest = 100, usual_columns = 80;
  struct winsize size {};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return std::min(widest, (known ? size.ws_col : usual_columns) - 1);
}

class Line {
 public:
  explicit Line(std::string_view title) : title_(title) {}
  ~Line() { clear(); }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  void draw(double fraction, std::string_view step) {
    if (fraction >= 1.0) return clear();  // what comes next may write where the line is
    const auto now = Clock::now();
    if (now - drawn_at_ < std::chrono::milliseconds(100)) return;
    drawn_at_ = now;
    const double passed_s = std::chrono::duration<double>(now - start_).count();
    std::string text = fmt::format("{} {:3.0f} %  {}", title_, 100 * fraction, step);
    if (fraction > 0.02 && passed_s > 1)
      text += fmt::format(", {} left", duration_text(passed_s * (1 - fraction) / fraction));
    text.resize(line_width(), ' ');  // a line that wraps could not be drawn over
    fmt::print(stderr, "\r{}", text);
    std::fflush(stderr);
    visible_ = true;
  }

 private:
  void clear() {
    if (!visible_) return;
    fmt::print(stderr, "\r{:{}}\r", "", line_width());
    std::fflush(stderr);
    visible_ = false;
  }

  std::string title_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_at_{};
  bool visible_ = false;
};

}  // namespace

Progress terminal_progress(std::string_view title) {
  if (!isatty(STDERR_FILENO)) return [](double, std::string_view) { return !interrupted(); };
  return [line = std::make_shared<Line>(title)](double fraction, std::string_view step) {
    line->draw(fraction, step);
    return !interrupted();
  };
}

}  // namespace tofsmith::apps
