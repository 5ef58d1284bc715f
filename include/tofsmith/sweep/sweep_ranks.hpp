// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "tofsmith/core/progress.hpp"
#include "tofsmith/sweep/work_list.hpp"

namespace tofsmith {

/// The processes (ranks) that one `mpirun` started to finish a sweep together, as one of them sees
/// them. Rank 0 runs the sweep: it alone opens the store, and gives items to the others, which call
/// work_for_sweep().
/// @note at most one in the life of a process; use it from one thread
class SweepRanks {
 public:
  /// Finds the others; waits for them all. Without mpirun, there are none.
  /// @throws std::runtime_error if there are others, but no MPI was there to build with; or on rank
  ///         0, if another rank has another version or instruction set, see dispatch_target()
  static SweepRanks join(const Progress& progress = {});
  /// Leaves: rank 0 sends the others home first.
  ~SweepRanks();
  SweepRanks(SweepRanks&&) noexcept;

  int rank() const;
  int count() const;

  struct State;
  State& state() { return *state_; }

 private:
  explicit SweepRanks(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Computes what rank 0 asks for, until it sends us home. What goes wrong here is told by rank 0.
/// @param list      reads the sweep that rank 0 runs; called once there is work
/// @param progress  when it asks to stop, so does the whole job
void work_for_sweep(SweepRanks& ranks, const std::function<WorkList()>& list,
                    const Progress& progress = {});

}  // namespace tofsmith
