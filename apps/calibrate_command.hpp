// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session.hpp"

namespace tofsmith::apps {

void add_calibrate_command(CLI::App& app, Session& session);

}  // namespace tofsmith::apps
