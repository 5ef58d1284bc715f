// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/design/design.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith::apps {

/// A heading and a row for each law of taps and error that entries suffice for; with their best
/// numbers of exposures alone, where they have several.
std::vector<std::vector<std::string>> law_rows(const std::vector<AtlasEntry>& entries);

/// "10", or what the shortest pulse is where there is no limit.
std::string bandwidth_text(const AtlasCamera& camera);

/// Entries of the atlas as a page: what bandwidth, peak and exposures do to the error for each
/// number of taps, the laws, and a table.
Page atlas_page(const std::vector<AtlasEntry>& entries, const std::string& command_line);

}  // namespace tofsmith::apps
