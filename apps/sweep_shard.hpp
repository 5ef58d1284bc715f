// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "number_checks.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith::apps {

/// Parses "3/8" as the third of eight parts; "" is the whole sweep.
/// @throws UsageError
inline SweepShard parse_shard(const std::string& text) {
  SweepShard shard;
  if (text.empty()) return shard;
  if (!read_number_pair(text, '/', shard.index, shard.count) || shard.broken_rule())
    throw UsageError(
        fmt::format("--shard: found {}; expected i/n with i in 1 to n, such as 3/8", text));
  return shard;
}

}  // namespace tofsmith::apps
