// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace tofsmith {

/// Who works on a store.
struct WorkerIdentity {
  std::string id;       ///< unlike any other worker's
  std::string host;     ///< the machine's name, for people
  std::string machine;  ///< names this boot of this machine and its process numbers; "" if unknown
  std::int64_t process = 0;
  std::string process_start;  ///< distinguishes it from a later process of the same number

  /// This process. Each call makes another worker.
  static WorkerIdentity own();
};

/// Whether a worker surely runs no more: its process was on this machine and is gone. Of other
/// machines nothing is known.
bool is_surely_gone(const WorkerIdentity& worker, const WorkerIdentity& own);

}  // namespace tofsmith
