// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tofsmith::apps {

inline constexpr int exit_interrupted = 130;

/// From now on Ctrl-C (SIGINT), SIGTERM and SIGHUP only set a flag, so that work can stop cleanly;
/// a second one ends the process at once. So does the first while nobody has asked for the flag
/// yet: input is being read then, and nothing is written.
void catch_interrupts();

/// Whether the user asked to stop.
bool interrupted();

}  // namespace tofsmith::apps
