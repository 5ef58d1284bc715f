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

/// Two of one tone and one that tells the period.
constexpr int min_designed_rows = 3;

/// Numbers of rows to design for: DesignOptions::exposures, or 8.
std::vector<int> designable_rows(const DesignOptions& options);
std::string rows_name(int rows);

/// Why rows cannot be designed for a camera that reads rows; none: row_candidates() does.
std::optional<BrokenRule> why_no_row_design(const Camera& camera, int rows);

/// Rows and light together, of a camera that reads rows: one code, for the judge.
///
/// Rows are cosines and sines at a few tones, which any number of shifts leaves alike, so that no
/// depth is worse than another; light is what is strongest at these tones within its peak. Sets of
/// tones are drawn around the one that carries most information (largest n |H_n|), and bettered by
/// single steps, by the error foreseen at the operating points: the Cramer-Rao bound at one depth,
/// with the covariance of the rows, and beside it
///   sum_lobes 2 |u| R Q(sqrt(g(u) / 2)), g(u) = sum_n q_n (1 - cos 2 pi n u),
///   q_n = (S |M_n|)^2 / variance of a row in constant light.
/// The light of a set is the fixed point of: on where the sum of its tones, in the phases it has
/// now and weighed by their share in the information, is largest.
///
/// In a tenth of the light lobes may be taken for the right one that no longer count in the light
/// asked for, and of two sets that err alike in that one may collapse. So sets are bettered for
/// both as well; of those within 3 % of the least error by Monte Carlo that is taken whose error
/// times the 0.02nd power of the error in a tenth of the light is least.
std::vector<Candidate> row_candidates(const Camera& camera, int rows, const DesignOptions& options,
                                      const Progress& progress);

}  // namespace tofsmith
