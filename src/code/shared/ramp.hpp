// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/code/families.hpp"

namespace tofsmith {

/// Gated ramp: the gain rises over the period in the first exposure, is constant in the second to
/// measure the signal, and the light is off in the third to measure ambient light. K = 3.
CodeSet single_ramp_code(const FamilyOptions& options);

/// A rising and a falling ramp, whose ratio determines depth, and an exposure with the light off to
/// measure ambient light. K = 3.
CodeSet double_ramp_code(const FamilyOptions& options);

}  // namespace tofsmith
