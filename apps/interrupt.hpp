// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tofsmith::apps {

inline constexpr int exit_interrupted = 130;

/// Makes Ctrl-C (SIGINT), SIGTERM and SIGHUP set a flag, so that work can stop cleanly. A second
/// signal terminates the process immediately, as does the first one before interrupted() has been
/// called (while reading input, before anything is written).
void catch_interrupts();

bool interrupted();

}  // namespace tofsmith::apps
