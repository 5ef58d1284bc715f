// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tofsmith::apps {

/// From now on Ctrl-C (SIGINT) and SIGTERM only set a flag, so that work can stop cleanly; a second
/// one ends the process at once.
void catch_interrupts();

/// Whether the user asked to stop.
bool interrupted();

}  // namespace tofsmith::apps
