// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/code/families.hpp"

namespace tofsmith {

/// Gated ramp: a rising gain in the first exposure, a constant gain in the second to measure the
/// signal, and no light in the third to measure ambient light. K = 3.
CodeSet single_ramp_code(const FamilyOptions& options);

/// A rising and a falling ramp, whose ratio determines depth, and an exposure without light. K = 3.
CodeSet double_ramp_code(const FamilyOptions& options);

}  // namespace tofsmith
