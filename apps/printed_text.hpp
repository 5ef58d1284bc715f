// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tofsmith::apps {

/// Makes a message safe for a terminal: control bytes and invalid UTF-8 are shown as \xNN, and text
/// beyond `longest` is cut.
std::string printed(std::string_view message, std::size_t longest = 4000);

}  // namespace tofsmith::apps
