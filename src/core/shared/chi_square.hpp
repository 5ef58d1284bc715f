// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tofsmith {

/// Probability that a chi-square variable with `degrees` >= 1 exceeds `value` >= 0.
double chi_square_tail(double value, int degrees);

/// Inverse of chi_square_tail() for `rate` in (0, 1).
double chi_square_quantile_of_tail(double rate, int degrees);

}  // namespace tofsmith
