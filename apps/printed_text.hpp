// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tofsmith::apps {

/// A message for a terminal: control bytes, which could steer it, and what is no UTF-8 are shown as
/// \xNN; what is longer than anybody reads is cut.
std::string printed(std::string_view message, std::size_t longest = 4000);

}  // namespace tofsmith::apps
