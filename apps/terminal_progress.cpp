// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "terminal_progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "tofsmith/core/progress.hpp"

namespace tofsmith::apps {

namespace {
volatile std::sig_atomic_t flag = 0;
volatile std::sig_atomic_t someone_looks = 0;  // 1 after the first call of interrupted()

extern "C" void stop_or_set_flag(int signal) {
  if (someone_looks == 0) {
    constexpr std::string_view message = "tofsmith: interrupted; nothing was written\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message.data(), message.size());
    ::_exit(exit_interrupted);
  }
  flag = 1;
  std::signal(signal, SIG_DFL);
}

using Clock = std::chrono::steady_clock;

std::string duration_text(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

/// Returns the width of the terminal minus one column, at most 100.
std::size_t line_width() {
  constexpr std::size_t widest = 100, usual_columns = 80;
  struct winsize size {};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return std::min(widest, (known ? size.ws_col : usual_columns) - 1);
}

/// Start time and text that both kinds of output share.
class ProgressText {
 public:
  explicit ProgressText(std::string_view title) : title_(title) {}

  double passed_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  std::string text(double fraction, std::string_view step) {
    remaining_.add(passed_s(), fraction);
    std::string text = fmt::format("{} {:.0f} %  {}", title_, 100 * fraction, step);
    if (const auto left_s = remaining_.seconds())
      text += fmt::format(", {} left", duration_text(*left_s));
    return text;
  }

 private:
  std::string title_;
  Clock::time_point start_ = Clock::now();
  RemainingTime remaining_;
};

/// Progress in one line of a terminal that is overwritten.
class Line {
 public:
  explicit Line(std::string_view title) : text_(title) {}
  ~Line() { clear(); }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  void tell(double fraction, std::string_view step) {
    if (fraction >= 1.0) return clear();  // make space for the following output
    constexpr double pause_s = 0.1;
    if (text_.passed_s() < next_s_) return;
    next_s_ = text_.passed_s() + pause_s;
    std::string text = text_.text(fraction, step);
    text.resize(line_width(), ' ');  // a wrapped line could not be overwritten
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

  ProgressText text_;
  double next_s_ = 0.0;
  bool visible_ = false;
};

/// Progress as plain lines in a log or a pipe.
class Log {
 public:
  explicit Log(std::string_view title) : text_(title) {}

  void tell(double fraction, std::string_view step) {
    constexpr double pause_s = 30.0;
    if (fraction >= 1.0) return;  // the following output reports the end
    const std::string text = text_.text(fraction, step);
    if (text_.passed_s() < next_s_) return;
    next_s_ = text_.passed_s() + pause_s;
    fmt::print(stderr, "tofsmith: {}\n", text);
    std::fflush(stderr);
  }

 private:
  static constexpr double short_s = 5.0;  // no progress is shown for shorter work

  ProgressText text_;
  double next_s_ = short_s;
};

template <typename Teller>
Progress progress_of(std::string_view title) {
  return [teller = std::make_shared<Teller>(title)](double fraction, std::string_view step) {
    teller->tell(fraction, step);
    return !interrupted();
  };
}

bool is_silent = false;

}  // namespace

void catch_interrupts() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (std::signal(signal, stop_or_set_flag) == SIG_IGN) std::signal(signal, SIG_IGN);  // nohup
  std::signal(SIGXFSZ, SIG_IGN);  // report files beyond the size limit as write errors
}

bool interrupted() {
  someone_looks = 1;
  return flag != 0;
}

Progress terminal_progress(std::string_view title) {
  if (is_silent) return [](double, std::string_view) { return !interrupted(); };
  return isatty(STDERR_FILENO) ? progress_of<Line>(title) : progress_of<Log>(title);
}

void silence_progress() { is_silent = true; }

bool is_progress_silent() { return is_silent; }

}  // namespace tofsmith::apps
