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

/// Two rows of one tone, and one to resolve its ambiguity.
constexpr int min_designed_rows = 3;

/// DesignOptions::exposures, or 8.
std::vector<int> designable_rows(const DesignOptions& options);
std::string rows_name(int rows);

/// Returns why row_candidates() cannot design rows, or nothing.
std::optional<BrokenRule> why_no_row_design(const Camera& camera, int rows);

/// Designs rows and light jointly for a camera that reads rows; returns one code to be ranked.
///
/// Rows are cosines and sines of a few tones. Depth rotates them without changing their norm, so
/// all depths have similar errors. Sets of tones are drawn around the most informative tone
/// (largest n |H_n|) and improved by single steps. The predicted error is the Cramer-Rao bound at
/// one depth, with the covariance of the rows, plus the side-lobe error
///   sum_lobes 2 |u| R Q(sqrt(g(u) / 2)), g(u) = sum_n q_n (1 - cos 2 pi n u),
///   q_n = (S |M_n|)^2 / variance of a row in constant light.
/// For operating.statistic = "rmse", the predicted error is the square root of the sum of the
/// squared Cramer-Rao bound and the same sum over lobes with (u R)^2 in place of |u| R.
/// Light is computed by fixed-point iteration: it is on where the sum of the tones, with their
/// current phases and weighted by information, is largest.
///
/// At a tenth of the light, side lobes can be mistaken for the main lobe, so sets with equal errors
/// may differ greatly there. Sets are optimized for both light levels. Among those within 3 % of
/// the smallest Monte Carlo error e, the smallest e d^0.02 wins, where d is the error at a tenth of
/// the light.
std::vector<Candidate> row_candidates(const Camera& camera, int rows, const DesignOptions& options,
                                      const Progress& progress);

}  // namespace tofsmith
