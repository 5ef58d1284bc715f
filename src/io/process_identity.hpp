// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace tofsmith {

/// Identity of a process among all processes that may share its files.
struct ProcessIdentity {
  /// Boot of the machine and namespace of its process numbers; "" if unknown. It differs between
  /// containers even if they have the same host name.
  std::string machine;
  std::int64_t number = 0;
  std::string start;  ///< distinguishes processes that reuse a number; "" if unknown

  static ProcessIdentity own();
};

/// Returns true if a process has certainly ended. Processes of other machines, boots and namespaces
/// are unknown.
bool is_surely_gone(const ProcessIdentity& process, const ProcessIdentity& own);

}  // namespace tofsmith
