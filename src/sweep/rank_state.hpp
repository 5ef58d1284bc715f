// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sweep/mpi_world.hpp"
#include "sweep/rank_messages.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {

struct SweepRanks::State {
  std::optional<MpiWorld> world;  ///< none if there are no others
  std::vector<RankHello> hellos;  ///< on rank 0: of every rank
  bool are_home = false;          ///< on rank 0: whether the others were sent home
  bool is_lost = false;           ///< on rank 0: whether one of them said no goodbye

  void send(int rank, RankTag tag, std::string bytes = "") {
    world->send(rank, static_cast<int>(tag), std::move(bytes));
  }
  /// On rank 0: "rank 3 on node7".
  std::string name_of(int rank) const;
  /// On rank 0: sends the others home. @return what they had finished
  std::vector<ItemOutcome> send_home();
};

}  // namespace tofsmith
