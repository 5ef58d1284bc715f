// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "design/chip_light.hpp"

namespace tofsmith {

/// Fisher matrix over (depth in chips, log S, ambient light in electrons per open chip) at one
/// depth. Matrices of several exposures add.
struct FisherMatrix {
  double zz = 0.0, zs = 0.0, ss = 0.0, za = 0.0, sa = 0.0, aa = 0.0;

  FisherMatrix& operator+=(const FisherMatrix& other);
  /// [inverse]_zz; infinite where depth cannot be told from the other two.
  double depth_variance() const;
};

/// Nodes of the quadrature within a chip.
inline constexpr int nodes_per_chip = 4;

/// Fisher matrices of one exposure at all nodes, chip by chip (4 n), added to `nodes`.
void add_exposure(ChipWord modulation, const ChipWord* taps, int tap_count, const ChipLight& light,
                  FisherMatrix* nodes);

/// gamma [chips^2]: the mean over depth of depth_variance(). Stops at a value above `limit`.
double mean_depth_variance(const FisherMatrix* nodes, int chips,
                           double limit = std::numeric_limits<double>::infinity());

/// gamma of a code [chips^2]; stops at a value above `limit`.
double chip_gamma(const ChipCode& code, const ChipLight& light,
                  double limit = std::numeric_limits<double>::infinity());

/// Fisher matrix of one tap with its depth at the first of two neighbouring depths, but with the
/// largest weight, 1 / variance, it has anywhere between them: at the darker end.
FisherMatrix largest_tap_fisher(int correlation, int next, int open_chips,
                                double electrons_per_chip, const ChipLight& light);

}  // namespace tofsmith
