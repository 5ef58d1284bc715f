// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/core/progress.hpp"

namespace tofsmith::apps {

/// A progress callback that draws one line on stderr (only on a terminal): what is done, share,
/// time left. It asks the work to stop after Ctrl-C, terminal or not. The line is cleared when the
/// work is done.
Progress terminal_progress(std::string_view title);

}  // namespace tofsmith::apps
