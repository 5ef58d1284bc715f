// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace tofsmith {

/// HTML page with the placeholders @TITLE@ and @DOCUMENT@, made by viewer/pack.py.
std::string_view viewer_page();

}  // namespace tofsmith
