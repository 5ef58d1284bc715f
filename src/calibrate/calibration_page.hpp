// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/report/page.hpp"

namespace tofsmith {

/// Adds notes, the command unless it is empty, and the footer.
Page finished_calibration_page(Page page, const std::vector<std::string>& notes,
                               const std::string& command_line);

}  // namespace tofsmith
