// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace tofsmith {

/// Unique among all processes that may share files.
struct ProcessIdentity {
  /// Boot of the machine and namespace of its process numbers (differs between containers); "" if
  /// unknown.
  std::string machine;
  std::int64_t number = 0;
  std::string start;  ///< in case a number is reused; "" if unknown

  static ProcessIdentity own();
};

/// False for processes of other machines, boots and namespaces.
bool is_surely_gone(const ProcessIdentity& process, const ProcessIdentity& own);

}  // namespace tofsmith
