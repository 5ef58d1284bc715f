// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>

#include "session.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith::apps {

/// "3/8" as the third of eight parts; "" is the whole. @throws UsageError
inline SweepShard parse_shard(const std::string& text) {
  SweepShard shard;
  if (text.empty()) return shard;
  const std::size_t slash = text.find('/');
  try {
    if (slash == std::string::npos ||
        !CLI::detail::lexical_cast(text.substr(0, slash), shard.index) ||
        !CLI::detail::lexical_cast(text.substr(slash + 1), shard.count))
      throw std::invalid_argument("expected two numbers");
    shard.validate();
  } catch (const std::invalid_argument&) {
    throw UsageError(
        fmt::format("--shard: found {}; expected i/n with i in 1 .. n, such as 3/8", text));
  }
  return shard;
}

}  // namespace tofsmith::apps
