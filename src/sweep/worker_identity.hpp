// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "io/shared/process_identity.hpp"

namespace tofsmith {

/// Who works on a store.
struct WorkerIdentity {
  std::string id;    ///< unlike any other worker's
  std::string host;  ///< the machine's name, for people
  ProcessIdentity process;

  /// This process. Each call makes another worker.
  static WorkerIdentity own();
};

}  // namespace tofsmith
