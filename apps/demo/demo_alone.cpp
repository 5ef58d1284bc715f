// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Commands of the program that scripts/demo.sh builds.
#include "commands.hpp"

namespace tofsmith::apps {

void add_commands(CLI::App& app, Session& session) { add_demo_command(app, session); }

}  // namespace tofsmith::apps
