// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "decode/ambient_projection.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

enum class MultipathKind;

/// Checks that there are enough independent means for the unknowns (5; for a tail of known delay 4)
/// and one more to test the fit. Returns an error with a remedy; none if they suffice.
std::optional<BrokenRule> missing_support(const AmbientProjection& projection, MultipathKind later);

}  // namespace tofsmith
