// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/code/families.hpp"

namespace tofsmith {

/// Gated ramp: the sensor's gain rises over the period; a second exposure with the gain fully
/// open measures the signal, a third with the light off measures ambient. K = 3.
CodeSet single_ramp_code(const FamilyOptions& options);

/// A rising and a falling ramp, whose ratio gives depth, and one exposure with the light off that
/// measures ambient. K = 3.
CodeSet double_ramp_code(const FamilyOptions& options);

}  // namespace tofsmith
