// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace tofsmith::html {

/// Text as it may stand between tags or in a quoted attribute.
std::string escape(std::string_view text);

/// JSON as it may stand in a <script> element: "<" becomes \u003c, so no string in it ends the
/// element. JSON has "<" only inside strings.
std::string escape_json_for_script(std::string_view json);

}  // namespace tofsmith::html
