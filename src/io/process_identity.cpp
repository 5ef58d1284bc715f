// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/process_identity.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace tofsmith {

namespace {

/// Files of /proc have no size. Returns "" if the file is missing.
std::string content_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string target_of(const char* link) {
  std::error_code error;
  const auto target = std::filesystem::read_symlink(link, error);
  return error ? "" : target.string();
}

/// In ticks since boot (22nd field); "" if there is no such process.
std::string start_of(std::int64_t process) {
  const std::string stat = content_of(fmt::format("/proc/{}/stat", process));
  const std::size_t after_name = stat.rfind(')');  // the name may contain any character
  if (after_name == std::string::npos) return "";
  std::istringstream fields(stat.substr(after_name + 1));
  std::string field;
  for (int i = 3; i <= 22; ++i)
    if (!(fields >> field)) return "";
  return field;
}

std::string own_machine() {
  // /proc may belong to another namespace, with other process numbers.
  if (target_of("/proc/self") != fmt::format("{}", ::getpid())) return "";
  const std::string numbers = target_of("/proc/self/ns/pid");
  std::string boot = content_of("/proc/sys/kernel/random/boot_id");
  if (numbers.empty() || boot.empty()) return "";
  boot.erase(boot.find_last_not_of('\n') + 1);
  return fmt::format("{} {}", boot, numbers);
}

}  // namespace

ProcessIdentity ProcessIdentity::own() {
  const std::int64_t number = ::getpid();
  return {own_machine(), number, start_of(number)};
}

bool is_surely_gone(const ProcessIdentity& process, const ProcessIdentity& own) {
  if (own.machine.empty() || process.machine != own.machine) return false;
  if (::kill(static_cast<pid_t>(process.number), 0) != 0 && errno == ESRCH) return true;
  const std::string start = start_of(process.number);
  return !start.empty() && start != process.start;  // /proc may hide processes of other users
}

}  // namespace tofsmith
