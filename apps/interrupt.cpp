// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <string_view>

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

}  // namespace tofsmith::apps
