// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/design/design.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith::apps {

/// Returns a heading and a row for each law of taps and error that the entries determine. Uses only
/// the best number of exposures of each camera.
std::vector<std::vector<std::string>> law_rows(const std::vector<AtlasEntry>& entries);

/// Returns a bandwidth such as "10", or the shortest pulse if the bandwidth is unlimited.
std::string bandwidth_text(const AtlasCamera& camera);

/// Returns the atlas as a page: figures of the error over bandwidth, peak factor and exposures for
/// each number of taps, the laws, and a table.
Page atlas_page(const std::vector<AtlasEntry>& entries, const std::string& command_line);

}  // namespace tofsmith::apps
