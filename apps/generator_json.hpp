// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "tofsmith/camera/generator_report.hpp"

namespace tofsmith::apps {

/// What generators make of each waveform, as `codes --json` and `export --json` print it.
nlohmann::ordered_json generators_json(const std::vector<GeneratorReport>& reports);

}  // namespace tofsmith::apps
