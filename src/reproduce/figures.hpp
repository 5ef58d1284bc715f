// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/reproduce/context.hpp"
#include "tofsmith/reproduce/reproduction.hpp"

// One function per figure of the paper; each reads like the figure's caption.
namespace tofsmith {

/// Fig. 5: a Hann window as impulse response, and its transfer function, 1/5 at f_max.
Reproduction reproduce_fig5(const ReproduceContext& context, const Progress& progress);

/// Fig. 7: a hand, decoded under loose and tight limits in high and low light.
Reproduction reproduce_fig7(const ReproduceContext& context, const Progress& progress);

/// Fig. 10: books and a volleyball, scanned by the prototype behind three filters.
Reproduction reproduce_fig10(const ReproduceContext& context, const Progress& progress);

/// Fig. 11: a flat wall, scanned by the prototype, against its mean depth.
Reproduction reproduce_fig11(const ReproduceContext& context, const Progress& progress);

}  // namespace tofsmith
