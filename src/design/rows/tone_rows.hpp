// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/core/error.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Two rows for one tone, and one more to resolve its ambiguity.
constexpr int min_designed_rows = 3;

/// Returns the numbers of rows to design: DesignOptions::exposures, or 8.
std::vector<int> designable_rows(const DesignOptions& options);
std::string rows_name(int rows);

/// Returns why rows cannot be designed for a camera that reads rows; none if row_candidates() can.
std::optional<BrokenRule> why_no_row_design(const Camera& camera, int rows);

/// Designs rows and modulation jointly for a camera that reads rows; returns one code to be ranked.
///
/// Rows are cosines and sines of a few tones. A shift of depth rotates them without changing their
/// norm, so all depths have similar errors. The modulation has the largest power at these tones
/// within its peak. Sets of tones are drawn around the most informative tone (largest n |H_n|) and
/// improved by single steps. The predicted error at the operating points is the sum of the
/// Cramer-Rao bound at one depth, with the covariance of the rows, and of the side-lobe error
///   sum_lobes 2 |u| R Q(sqrt(g(u) / 2)), g(u) = sum_n q_n (1 - cos 2 pi n u),
///   q_n = (S |M_n|)^2 / variance of a row in constant light.
/// The modulation of a set is computed by fixed-point iteration: it is on where the sum of the
/// tones, with their current phases and weighted by information, is largest.
///
/// At a tenth of the light, side lobes can be mistaken for the main lobe, so sets with equal errors
/// may differ greatly. Sets are therefore optimized for both light levels. Among the sets within
/// 3 % of the smallest Monte Carlo error e, the one with the smallest e d^0.02 is selected, where d
/// is the error at a tenth of the light.
std::vector<Candidate> row_candidates(const Camera& camera, int rows, const DesignOptions& options,
                                      const Progress& progress);

}  // namespace tofsmith
