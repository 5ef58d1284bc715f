// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace tofsmith {

/// The viewer as an HTML page with the marks @TITLE@ and @DOCUMENT@, as viewer/pack.py packs it.
std::string_view viewer_page();

}  // namespace tofsmith
