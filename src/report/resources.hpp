// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace tofsmith::resources {

/// plotly.js, minified and packed by gzip.
std::string_view plotly_js();
/// Its licences and those of what is in it, as a comment of a script.
std::string_view plotly_licences();
/// Style sheet of the page (src/report/page.css).
std::string_view page_css();
/// Script of the page (src/report/page.js).
std::string_view page_js();

}  // namespace tofsmith::resources
