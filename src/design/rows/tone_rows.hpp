// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tofsmith/core/error.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Two rows of one tone, and one for its ambiguity or, with a plain decoder, for the mean over
/// rows.
constexpr int min_designed_rows = 3;

inline std::vector<int> designable_rows(const DesignOptions& options) {
  return options.exposures.empty() ? std::vector<int>{8} : options.exposures;
}
inline std::string rows_name(int rows) { return "tones-k" + std::to_string(rows); }

std::optional<BrokenRule> why_no_row_design(const Camera& camera, int rows);

/// Designs rows and light jointly for a camera that reads rows; returns one code to be ranked.
///
/// Rows are cosines and sines of a few tones. Depth rotates them without changing their norm, so
/// all depths have similar errors. With an odd number, the lowest tone has a sine only. Sets of
/// tones are drawn around the most informative tone (largest n |H_n|) and improved by simulated
/// annealing. The predicted error is the Cramer-Rao bound at one depth, with the covariance of the
/// rows, plus the side-lobe error
///   sum_lobes 2 |u| R Q(sqrt(g(u) / 2)), g(u) = sum_n q_n (1 - cos 2 pi n u),
///   q_n = (S |M_n|)^2 / variance of a row in constant light.
/// The predicted root mean square error is the square root of the squared bound plus the same sum
/// with (u R)^2 in place of |u| R. Light is on where the sum of the tones, weighted by information,
/// is largest (fixed-point iteration).
///
/// For RowDecoder::plain, K rows are K - 1 cosines and sines, multiplied by orthonormal columns
/// whose sums are 0: centring then loses nothing. Averaged over depth, the noise of tones is white.
///
/// Side lobes can be mistaken for the main lobe, above all in dim light. Among the sets within 5 %
/// of the smallest error e, the smallest e d^0.02 r^0.1 wins, where d is the error at a tenth of
/// the light and r the root mean square error. e and r are geometric means of predictions and Monte
/// Carlo errors; r is circular, and is omitted for operating.statistic = "rmse".
std::vector<Candidate> row_candidates(const Camera& camera, int rows, const DesignOptions& options,
                                      const Progress& progress);

}  // namespace tofsmith
