// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace tofsmith {

/// A process, distinguished from all others that may share its files.
struct ProcessIdentity {
  /// This boot of the machine and the namespace of its process numbers; "" if unknown. Containers
  /// differ in it even if they share a host name.
  std::string machine;
  std::int64_t number = 0;
  std::string start;  ///< distinguishes it from a later process of the same number; "" if unknown

  /// This process.
  static ProcessIdentity own();
};

/// Whether a process has surely ended. Nothing is known of processes of other machines, boots and
/// namespaces.
bool is_surely_gone(const ProcessIdentity& process, const ProcessIdentity& own);

}  // namespace tofsmith
