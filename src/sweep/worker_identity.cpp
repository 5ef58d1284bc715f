// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/worker_identity.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <random>

namespace tofsmith {

namespace {

std::string random_id() {
  std::random_device source;
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", source(), source(), source(), source());
}

}  // namespace

WorkerIdentity WorkerIdentity::own() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  return {random_id(), host.data(), ProcessIdentity::own()};
}

}  // namespace tofsmith
