// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/reproduce/context.hpp"
#include "tofsmith/reproduce/reproduction.hpp"

// One function per figure of the paper; each reads like the figure's caption.
namespace tofsmith {

/// Fig. 5: a Hann window as impulse response, and its transfer function, 1/5 at f_max.
Reproduction reproduce_fig5(const ReproduceContext& context, const Progress& progress);

/// Fig. 9: depth error of a single pixel on the bench, its depth range emulated by delays.
Reproduction reproduce_fig9(const ReproduceContext& context, const Progress& progress);

/// Table 1: the bench's parameters, and what its generators make of the codes.
Reproduction reproduce_table1(const ReproduceContext& context, const Progress& progress);

}  // namespace tofsmith
