// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "paper/error_surface_figures.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith {

/// The redesigned codes of Fig. 4.
inline const std::vector<std::string> redesigned_names = {
    "hamiltonian-k3-redesigned", "hamiltonian-k4-redesigned", "hamiltonian-k5-redesigned"};

/// The redesigned code with the least linear error, geometric mean over the grid.
const ErrorSurface& best_redesigned(const ErrorSurfaceGroup& group);

/// How often one code is better than another, and by what factor.
struct Comparison {
  int better = 0, even = 0, worse = 0;  ///< light levels; even: within two standard errors
  double min = 0, max = 0, mean = 0;    ///< theirs / ours; the mean is geometric

  int levels() const { return better + even + worse; }
};
Comparison compare(const ErrorSurface& ours, const ErrorSurface& theirs);

/// holds if ours is better at every light level, fails if it is so at half of them or fewer.
Verdict verdict_of(const Comparison& comparison);

/// What the paper says about Fig. 4, beside the surfaces of a, b and c.
std::vector<CheckedStatement> fig4_findings(const std::vector<ErrorSurfaceGroup>& panels);

}  // namespace tofsmith
