// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <string>

namespace tofsmith {

/// A message of another rank.
struct RankMessage {
  int rank;
  int tag;
  std::string bytes;
};

/// How many processes the launcher (mpirun, or srun with PMIx) says it started with this one; 1
/// where there is none. Needs no MPI.
int launched_processes();

/// All processes of a job, by MPI. Every member is called from the thread that made it, and none
/// of them waits, but the constructor and the destructor for all others.
/// @throws std::runtime_error from the constructor, if this was built without MPI
class MpiWorld {
 public:
  MpiWorld();
  ~MpiWorld();
  MpiWorld(const MpiWorld&) = delete;
  MpiWorld& operator=(const MpiWorld&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }

  void send(int rank, int tag, std::string bytes);
  /// The next message that is there; those of one rank come in the order they were sent.
  std::optional<RankMessage> receive();
  /// Whether all that was sent has left.
  bool all_sent();
  /// Ends every process of the job, now.
  [[noreturn]] void end_all(int exit_code);

 private:
  struct Sending;  // keeps the bytes until they have left
  int rank_ = 0, size_ = 1;
  std::list<std::unique_ptr<Sending>> sending_;
};

}  // namespace tofsmith
