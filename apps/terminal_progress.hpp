// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/core/progress.hpp"

namespace tofsmith::apps {

inline constexpr int exit_interrupted = 130;

/// Makes Ctrl-C (SIGINT), SIGTERM and SIGHUP set a flag, so that work can stop cleanly. A second
/// signal terminates the process immediately, as does the first one before interrupted() has been
/// called (while reading input, before anything is written).
void catch_interrupts();

bool interrupted();

/// Returns a progress callback that prints the step, the finished share and the remaining time on
/// stderr. In a terminal it overwrites one line and clears it at the end. Otherwise it prints a
/// line occasionally, if the work takes longer than some seconds. The callback stops the work after
/// Ctrl-C.
Progress terminal_progress(std::string_view title);

/// Disables the output of progress; Ctrl-C still stops the work.
void silence_progress();
bool is_progress_silent();

}  // namespace tofsmith::apps
