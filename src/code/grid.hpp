// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tofsmith/code/sinusoid.hpp"

namespace tofsmith {

/// @throws std::invalid_argument with the nearest usable N unless `cells` divides the samples
///         (or the caller does not ask for an exact grid)
void require_grid(const std::string& family, int cells, const FamilyOptions& options);

}  // namespace tofsmith
