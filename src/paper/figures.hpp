// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "paper/context.hpp"
#include "paper/reproduction.hpp"

// One function per figure of the paper; each reads like the figure's caption.
namespace tofsmith {

/// Fig. 2: a target, its trivial factorization, designed input and smoothed output; with the
/// ablation of Sec. 5.1.
Reproduction reproduce_fig2(const ReproduceContext& context, const Progress& progress);

/// Fig. 3: K = 3 factorized at falling peak without a band limit; K = 4 and 5 of the supplement.
Reproduction reproduce_fig3(const ReproduceContext& context, const Progress& progress);

/// Fig. 4: depth error over signal and ambient light, of redesigned codes and baselines.
Reproduction reproduce_fig4(const ReproduceContext& context, const Progress& progress);

/// Fig. 5: a Hann window as impulse response, and its transfer function, 1/5 at f_max.
Reproduction reproduce_fig5(const ReproduceContext& context, const Progress& progress);

/// Fig. 6: two K = 5 codes at 10 f0, inputs binary, outputs smooth.
Reproduction reproduce_fig6(const ReproduceContext& context, const Progress& progress);

/// Fig. 7: a hand, decoded under loose and tight limits in high and low light.
Reproduction reproduce_fig7(const ReproduceContext& context, const Progress& progress);

/// Fig. 8: depth error of two-bucket cameras.
Reproduction reproduce_fig8(const ReproduceContext& context, const Progress& progress);

/// Fig. 9: depth error of a single pixel on the bench, its depth range emulated by delays.
Reproduction reproduce_fig9(const ReproduceContext& context, const Progress& progress);

/// Fig. 10: books and a volleyball, scanned by the prototype behind three filters.
Reproduction reproduce_fig10(const ReproduceContext& context, const Progress& progress);

/// Fig. 11: a flat wall, scanned by the prototype, against its mean depth.
Reproduction reproduce_fig11(const ReproduceContext& context, const Progress& progress);

/// Table 1: the bench's parameters, and what its generators make of the codes.
Reproduction reproduce_table1(const ReproduceContext& context, const Progress& progress);

/// Statements of the text that have no figure: iterations, sinusoids of any K, bounds kept, zero
/// error at p = 30.
Reproduction reproduce_text(const ReproduceContext& context, const Progress& progress);

}  // namespace tofsmith
