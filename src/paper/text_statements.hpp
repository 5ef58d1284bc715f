// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "paper/context.hpp"
#include "paper/reproduction.hpp"

// Statements of the paper's text that have no figure of their own. Each function adds findings, a
// section and data.
namespace tofsmith {

/// Sec. 4 and 5: the alternation converges in 5-50 iterations without, 3-20 with a band limit.
void add_convergence(Reproduction& result, const ReproduceContext& context,
                     const Progress& progress);

/// Footnote 3: at a fixed total time, sinusoids perform alike for every K.
void add_sinusoids_of_any_k(Reproduction& result, const ReproduceContext& context,
                            const Progress& progress);

/// Sec. 6.1: the output functions keep the bounds of the input functions.
void add_kept_bounds(Reproduction& result, const ReproduceContext& context,
                     const Progress& progress);

/// Fig. 4a: at p = 30 and without a band limit every scheme factorizes with zero error.
void add_zero_error_at_p30(Reproduction& result, const ReproduceContext& context,
                           const Progress& progress);

}  // namespace tofsmith
