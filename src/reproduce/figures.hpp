// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/reproduce/context.hpp"
#include "tofsmith/reproduce/reproduction.hpp"

// One function per figure of the paper; each reads like the figure's caption.
namespace tofsmith {

/// Fig. 5: a Hann window as impulse response, and its transfer function, 1/5 at f_max.
Reproduction reproduce_fig5(const ReproduceContext& context, const Progress& progress);

}  // namespace tofsmith
