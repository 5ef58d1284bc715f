// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/worker_identity.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>

namespace tofsmith {

namespace {

/// Files of /proc have no size; "" where there is none.
std::string content_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// When a process started, in ticks since boot (the 22nd field); "" if there is none.
std::string start_of(std::int64_t process) {
  const std::string stat = content_of(fmt::format("/proc/{}/stat", process));
  const std::size_t after_name = stat.rfind(')');  // a name may hold anything
  if (after_name == std::string::npos) return "";
  std::istringstream fields(stat.substr(after_name + 1));
  std::string field;
  for (int i = 3; i <= 22; ++i)
    if (!(fields >> field)) return "";
  return field;
}

std::string own_machine() {
  std::error_code error;
  const auto numbers = std::filesystem::read_symlink("/proc/self/ns/pid", error);
  std::string boot = content_of("/proc/sys/kernel/random/boot_id");
  if (error || boot.empty()) return "";
  boot.erase(boot.find_last_not_of('\n') + 1);
  return fmt::format("{} {}", boot, numbers.string());
}

std::string random_id() {
  std::random_device source;
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", source(), source(), source(), source());
}

}  // namespace

WorkerIdentity WorkerIdentity::own() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  const std::int64_t process = ::getpid();
  return {random_id(), host.data(), own_machine(), process, start_of(process)};
}

bool is_surely_gone(const WorkerIdentity& worker, const WorkerIdentity& own) {
  if (own.machine.empty() || worker.machine != own.machine) return false;
  return start_of(worker.process) != worker.process_start;
}

}  // namespace tofsmith
