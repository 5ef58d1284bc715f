// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sweep/item_batch.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {

/// What a message between rank 0 and another is about.
enum class RankTag : int {
  hello,        ///< to rank 0: who it is
  items,        ///< to a rank: compute these
  outcomes,     ///< to rank 0: what became of some
  trouble,      ///< to rank 0: it cannot go on, and why
  interrupted,  ///< to rank 0: its user asks to stop
  go_home,      ///< to a rank: drop what is unfinished
  goodbye,      ///< to rank 0: nothing more comes
};

/// Who a rank is.
struct RankHello {
  std::string host, version, target;
};

/// As bytes and back. @throws std::runtime_error for bytes of anything else
std::string bytes_of(const RankHello& hello);
std::string bytes_of(const std::vector<ClaimedItem>& items);
std::string bytes_of(const std::vector<ItemOutcome>& outcomes);
RankHello hello_of(const std::string& bytes);
std::vector<ClaimedItem> items_of(const std::string& bytes);
std::vector<ItemOutcome> outcomes_of(const std::string& bytes);

}  // namespace tofsmith
