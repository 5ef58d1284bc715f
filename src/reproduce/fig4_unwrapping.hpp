// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/core/progress.hpp"
#include "tofsmith/reproduce/context.hpp"
#include "tofsmith/reproduce/reproduction.hpp"

namespace tofsmith {

/// What phase unwrapping costs: the multi-frequency code of Fig. 4 decoded by unwrapping, with the
/// classical weights and with those of the phases' own variances, beside correlation with the whole
/// code, on the cameras of a, b and c. Adds findings, a section and arrays.
void add_unwrapping(Reproduction& result, const ReproduceContext& context,
                    const Progress& progress);

}  // namespace tofsmith
