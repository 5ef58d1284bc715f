// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/reproduce/context.hpp"
#include "tofsmith/reproduce/reproduction.hpp"

// One function per figure of the paper; each reads like the figure's caption.
namespace tofsmith {

/// Fig. 4: depth error over signal and ambient light, of redesigned codes and baselines.
Reproduction reproduce_fig4(const ReproduceContext& context, const Progress& progress);

/// Fig. 5: a Hann window as impulse response, and its transfer function, 1/5 at f_max.
Reproduction reproduce_fig5(const ReproduceContext& context, const Progress& progress);

/// Fig. 8: depth error of two-bucket cameras.
Reproduction reproduce_fig8(const ReproduceContext& context, const Progress& progress);

}  // namespace tofsmith
