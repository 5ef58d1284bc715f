// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/core/progress.hpp"

namespace tofsmith::apps {

/// A progress callback that tells on stderr what is done, what share, and the time left once that
/// is known: on a terminal in one line, which is drawn over and cleared when the work is done;
/// elsewhere in plain lines, now and then, and only of work that takes longer than some seconds.
/// It asks the work to stop after Ctrl-C.
Progress terminal_progress(std::string_view title);

/// From now on progress says nothing; Ctrl-C stops work all the same.
void silence_progress();
bool is_progress_silent();

}  // namespace tofsmith::apps
