// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "reference_curve.hpp"

namespace tofsmith::benchmarks {

/// Finds the lowest bins with scores within reference_tie of the best, by brute force in double.
/// @param pixels  finite
void bins_by_brute_force(const ReferenceCurve& curve, const ReferencePixel* pixels, int count,
                         std::int32_t* bin);

}  // namespace tofsmith::benchmarks
