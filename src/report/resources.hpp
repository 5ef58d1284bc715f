// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace tofsmith::resources {

/// plotly.js, minified and packed by gzip.
std::string_view plotly_js();
/// Its licence.
std::string_view plotly_licence();
/// Style sheet of the page (src/report/page.css).
std::string_view page_css();
/// Script of the page (src/report/page.js).
std::string_view page_js();

}  // namespace tofsmith::resources
